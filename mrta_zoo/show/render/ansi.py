"""A mission as text: a small table."""

from __future__ import annotations

import numpy as np
from rich.cells import cell_len

from mrta_zoo.mission import Mission
from mrta_zoo.rules import Status
from mrta_zoo.show.render.whereabouts import whereabouts
from mrta_zoo.show.view import Digits
from mrta_zoo.wording import counted, listed

_MOST_DUE, _LONGEST_TRAIL = 6, 3


def headline(mission: Mission) -> str:
    """Name, time and number of tasks by status, on one line."""
    counts = np.bincount(mission.status, minlength=len(Status))
    tasks = ", ".join(f"{counts[status]} {status.name.lower()}" for status in Status)
    over = "   mission over" if mission.done else ""
    number = counted(mission.scenario.num_tasks, "task")
    return f"{mission.scenario.name}   time {Digits.of(mission.scenario).time(mission.time)}   {number}: {tasks}{over}"


def describe(mission: Mission) -> str:
    """The state of a mission: one line on the tasks, one on those due next, and one per robot with its last tasks."""
    scenario = mission.scenario
    robots = scenario.robot_names or [f"robot_{robot}" for robot in range(scenario.num_robots)]
    trails = [_trail(mission, robot) for robot in range(scenario.num_robots)]
    width, trail_width = max(5, *map(cell_len, robots)), max(14, *map(cell_len, trails))
    lines = [headline(mission)]
    if due := _due_next(mission):
        lines.append(f"due next: {due}")
    here = [whereabouts(mission, robot) for robot in range(scenario.num_robots)]
    digits = max(2, Digits.of(scenario).of_distances)
    places = [(f"{now.x:.{digits}f}", f"{now.y:.{digits}f}") for now in here]
    wide = max(8, *(len(each) for place in places for each in place))
    lines.append(
        f"{_filled('robot', width)}  {'x':>{wide}}  {'y':>{wide}}  taken  {_filled('last tasks', trail_width)}  doing"
    )
    for robot, (now, (x, y)) in enumerate(zip(here, places, strict=True)):
        lines.append(
            f"{_filled(robots[robot], width)}  {x:>{wide}}  {y:>{wide}}  {len(mission.routes[robot]):5d}  "
            f"{_filled(trails[robot], trail_width)}  {_doing(mission, robot, now.doing)}"
        )
    return "\n".join(lines)


def _due_next(mission: Mission) -> str:
    """The active tasks with the earliest deadlines."""
    deadline, name, time = mission.scenario.deadline, mission.scenario.task_name, Digits.of(mission.scenario).time
    active = np.flatnonzero(mission.status == Status.ACTIVE)
    first = active[np.argsort(deadline[active], kind="stable")]
    more = ", …" if len(first) > _MOST_DUE else ""
    return ", ".join(f"task {name(task)} at {time(deadline[task])}" for task in first[:_MOST_DUE].tolist()) + more


def _trail(mission: Mission, robot: int) -> str:
    """The last tasks that a robot has finished, the latest last."""
    route = mission.routes[robot]
    behind = route[:-1] if mission.heading[robot] >= 0 else route
    earlier = "… " if len(behind) > _LONGEST_TRAIL else ""
    trail = [mission.scenario.task_name(task) for task in behind[-_LONGEST_TRAIL:]]
    return earlier + (listed(trail) if mission.scenario.task_names else " ".join(trail)) or "-"


def _doing(mission: Mission, robot: int, doing: str) -> str:
    task, time = mission.heading[robot], Digits.of(mission.scenario).time
    name = mission.scenario.task_name(task)  # without a task under way, that of the last task, which is not shown
    when = f"until {time(mission.ready[robot])}, deadline {time(mission.scenario.deadline[task])}"
    return {
        "acting": "chooses now",
        "waiting": "is free",
        "retired": "is retired",
        "travelling": f"on its way to task {name}, {when}",
        "working": f"at work on task {name}, {when}",
    }[doing]


def _filled(text: str, width: int) -> str:
    """Text padded with blanks: characters of some scripts are two columns wide."""
    return text + " " * (width - cell_len(text))
