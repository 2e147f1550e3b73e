"""A mission as a small table of text."""

from __future__ import annotations

import numpy as np

from mrta_zoo.mission import Mission
from mrta_zoo.render.whereabouts import whereabouts
from mrta_zoo.rules import Status


def headline(mission: Mission) -> str:
    """Name, time and number of tasks by status, on one line."""
    counts = np.bincount(mission.status, minlength=len(Status))
    tasks = ", ".join(f"{counts[status]} {status.name.lower()}" for status in Status)
    over = "   mission over" if mission.done else ""
    return f"{mission.scenario.name}   time {mission.time:.1f}   {mission.scenario.num_tasks} tasks: {tasks}{over}"


def describe(mission: Mission) -> str:
    """The state of a mission: one line on the tasks, one for each robot."""
    width = len(f"robot_{mission.scenario.num_robots - 1}")
    lines = [headline(mission), f"{'robot':<{width}}  {'x':>8}  {'y':>8}  {'taken':>5}  doing"]
    for robot, route in enumerate(mission.routes):
        now = whereabouts(mission, robot)
        doing = {
            "acting": "chooses now",
            "waiting": "is free",
            "retired": "is retired",
            "travelling": f"on its way to task {mission.heading[robot]}, until {mission.ready[robot]:.1f}",
            "working": f"at work on task {mission.heading[robot]}, until {mission.ready[robot]:.1f}",
        }[now.doing]
        lines.append(f"{f'robot_{robot}':<{width}}  {now.x:8.2f}  {now.y:8.2f}  {len(route):5d}  {doing}")
    return "\n".join(lines)
