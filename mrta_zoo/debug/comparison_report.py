"""Report of a comparison: sentences and tables for people."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Group
from rich.text import Text

from mrta_zoo.debug.comparison import Comparison, Fate
from mrta_zoo.debug.naming import label
from mrta_zoo.debug.parting import Alternative, Parting
from mrta_zoo.debug.percent import percent
from mrta_zoo.digits import rounded
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.sheet import Sheet
from mrta_zoo.show.view import Digits
from mrta_zoo.verify import COST
from mrta_zoo.wording import counted


def report(found: Comparison, methods: tuple[str, str], rows: int) -> list[str | Group]:
    """The report, as sentences and tables.

    Args:
        found: the comparison.
        methods: the names of the two.
        rows: the most rows that a table has.
    """
    first, second = methods
    shown = _Shown(found.traces[0].scenario)
    outcomes = _table(
        f"{found.scenario}: {counted(found.tasks, 'task')} (cost by {COST})",
        ("method", "completed", "cost", "distance", "makespan"),
        [
            (name, each.completed, f"{each.cost:.3f}", rounded(each.distance), rounded(each.makespan))
            for name, each in zip(methods, found.scores, strict=True)
        ],
    )
    if found.parting is None:
        return [outcomes, f"{first} and {second} do the same throughout"]
    disagreements = _table(
        f"In the place of {first}, {second} would choose differently at {len(found.disagreements)} of "
        f"{counted(len(found.traces[0].choices), 'decision')}",
        ("decision", "time", "robot", first, second),
        [
            (each.index, shown.time(each.time), shown.robot(each.robot), shown.choice(each.chosen),
             shown.choice(each.advised))
            for each in found.disagreements
        ],
        rows,
    )  # fmt: skip
    turns = _table(
        f"Turns in which a robot takes different tasks: {len(found.turns)}",
        ("robot", "turn", first, "until", second, "until"),
        [
            (shown.robot(each.robot), each.turn, shown.task(each.tasks[0]), shown.time(each.finish[0]),
             shown.task(each.tasks[1]), shown.time(each.finish[1]))
            for each in found.turns
        ],
        rows,
    )  # fmt: skip
    return [
        outcomes,
        _parted(found.parting, methods, shown),
        *_costs(found, found.parting, methods),
        disagreements,
        turns,
        *(_completed_only_by(index, found.fates, methods, shown, rows) for index in range(2)),
    ]


class _Shown:
    """Numbers, tasks and robots as the report shows them; None where there is nothing to show."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario, self.digits = scenario, Digits.of(scenario)

    def time(self, value: float | None) -> str | None:
        return None if value is None else self.digits.time(value)

    def robot(self, index: int | None) -> str | None:
        return None if index is None else label(index, self.scenario.robot_names)

    def task(self, index: int | None) -> str | None:
        return None if index is None else self.scenario.task_name(index)

    def choice(self, task: int | None) -> str:
        return "stays" if task is None else self.scenario.task_name(task)


def _parted(parting: Parting, methods: tuple[str, str], shown: _Shown) -> Group:
    probable = [
        index for index in range(2) if any(choice.probabilities[index] is not None for choice in parting.choices)
    ]  # plans have none

    def row(method: str, choice: Alternative) -> tuple[object, ...]:
        likely = [None if each is None else percent(each) for each in (choice.probabilities[i] for i in probable)]
        distance = None if choice.distance is None else shown.digits.distance(choice.distance)
        return method, shown.choice(choice.task), distance, shown.time(choice.finish), shown.time(choice.slack), *likely

    return _table(
        f"They part at decision {parting.index}, at {shown.time(parting.time)}, when "
        f"{shown.scenario.robot_name(parting.robot)} chooses",
        ("method", "task", "distance", "finish", "slack", *(f"% {methods[index]}" for index in probable)),
        [row(method, choice) for method, choice in zip(methods, parting.choices, strict=True)],
    )


def _costs(found: Comparison, parting: Parting, methods: tuple[str, str]) -> list[str]:
    """What the other method's choice would lead to, one line per method."""
    lines = []
    for index, method in enumerate(methods):
        task = parting.choices[1 - index].task
        instead, score = parting.otherwise[index], found.scores[index]
        choice = "staying there" if task is None else f"task {found.traces[0].scenario.task_name(task)} there"
        if instead is None:
            lines.append(f"{method} with {choice}: its mask rule forbids that")
            continue
        lines.append(
            f"{method} with {choice} and then by itself: completed {instead.completed} "
            f"({instead.completed - score.completed:+d}), "
            f"cost {instead.cost:.3f} ({instead.cost - score.cost:+.3f})"
        )
    return [*lines, ""]


def _completed_only_by(index: int, fates: Sequence[Fate], methods: tuple[str, str], shown: _Shown, rows: int) -> Group:
    def otherwise(fate: Fate) -> str:
        robot, finish = fate.robots[1 - index], fate.finish[1 - index]
        if robot is None or finish is None:
            return "not taken"
        return f"late, by {shown.scenario.robot_name(robot)} at {shown.time(finish)}"

    only = [each for each in fates if each.completed[index]]
    return _table(
        f"Completed only by {methods[index]}: {len(only)}",
        ("task", "deadline", "robot", "finish", f"by {methods[1 - index]}"),
        [
            (shown.task(each.task), shown.time(each.deadline), shown.robot(each.robots[index]),
             shown.time(each.finish[index]), otherwise(each))
            for each in only
        ],
        rows,
    )  # fmt: skip


def _table(title: str, columns: Sequence[str], rows: Sequence[Sequence[object]], most: int = 2) -> Group:
    """A table of at most `most` rows; "-" stands for None."""
    cells = [tuple("-" if value is None else str(value) for value in row) for row in rows[:most]]
    more = [Text(f"and {len(rows) - most} more (--rows)")] if len(rows) > most else []
    return Group(Sheet(title, columns, cells, left=("method",)), *more)
