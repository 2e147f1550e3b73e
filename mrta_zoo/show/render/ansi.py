"""A mission as a small table of text."""

from __future__ import annotations

import numpy as np
from rich.cells import cell_len

from mrta_zoo.mission import Mission
from mrta_zoo.rules import Status
from mrta_zoo.show.render.whereabouts import whereabouts
from mrta_zoo.wording import counted, listed

_MOST_DUE, _LONGEST_TRAIL = 6, 3


def headline(mission: Mission) -> str:
    """Name, time and number of tasks by status, on one line."""
    counts = np.bincount(mission.status, minlength=len(Status))
    tasks = ", ".join(f"{counts[status]} {status.name.lower()}" for status in Status)
    over = "   mission over" if mission.done else ""
    number = counted(mission.scenario.num_tasks, "task")
    return f"{mission.scenario.name}   time {mission.time:.1f}   {number}: {tasks}{over}"


def describe(mission: Mission) -> str:
    """The state of a mission: a line on the tasks, one on those due next, one for each robot with its last tasks."""
    scenario = mission.scenario
    robots = scenario.robot_names or [f"robot_{robot}" for robot in range(scenario.num_robots)]
    trails = [_trail(mission, robot) for robot in range(scenario.num_robots)]
    width, trail_width = max(5, *map(cell_len, robots)), max(14, *map(cell_len, trails))
    lines = [headline(mission)]
    if due := _due_next(mission):
        lines.append(f"due next: {due}")
    places = f"{'x':>8}  {'y':>8}  {'taken':>5}"
    lines.append(f"{_filled('robot', width)}  {places}  {_filled('last tasks', trail_width)}  doing")
    for robot, route in enumerate(mission.routes):
        now = whereabouts(mission, robot)
        lines.append(
            f"{_filled(robots[robot], width)}  {now.x:8.2f}  {now.y:8.2f}  {len(route):5d}  "
            f"{_filled(trails[robot], trail_width)}  {_doing(mission, robot, now.doing)}"
        )
    return "\n".join(lines)


def _due_next(mission: Mission) -> str:
    """The active tasks with the earliest deadlines."""
    deadline, name = mission.scenario.deadline, mission.scenario.task_name
    active = np.flatnonzero(mission.status == Status.ACTIVE)
    first = active[np.argsort(deadline[active], kind="stable")]
    more = ", …" if len(first) > _MOST_DUE else ""
    return ", ".join(f"task {name(task)} at {deadline[task]:.1f}" for task in first[:_MOST_DUE].tolist()) + more


def _trail(mission: Mission, robot: int) -> str:
    """The tasks a robot has behind it, the latest last."""
    route = mission.routes[robot]
    behind = route[:-1] if mission.heading[robot] >= 0 else route
    earlier = "… " if len(behind) > _LONGEST_TRAIL else ""
    trail = [mission.scenario.task_name(task) for task in behind[-_LONGEST_TRAIL:]]
    return earlier + (listed(trail) if mission.scenario.task_names else " ".join(trail)) or "-"


def _doing(mission: Mission, robot: int, doing: str) -> str:
    task, until = mission.heading[robot], mission.ready[robot]
    name = mission.scenario.task_name(task)  # of the last task where there is none, and not shown
    when = f"until {until:.1f}, deadline {mission.scenario.deadline[task]:.1f}"
    return {
        "acting": "chooses now",
        "waiting": "is free",
        "retired": "is retired",
        "travelling": f"on its way to task {name}, {when}",
        "working": f"at work on task {name}, {when}",
    }[doing]


def _filled(text: str, width: int) -> str:
    """Text with blanks behind it: characters of some scripts are two columns wide."""
    return text + " " * (width - cell_len(text))
