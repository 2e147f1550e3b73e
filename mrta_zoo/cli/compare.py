"""The command ``mrta-zoo compare``: its flags, and what it prints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated, Any

from rich.console import Group
from rich.text import Text
from tyro.conf import Positional, arg

from mrta_zoo.cli.commands import TRAINED_HELP, PlanningFlags, agent_file, policy_files
from mrta_zoo.cli.flags import names, optional, parse
from mrta_zoo.cli.plan_files import is_episode, read_any_plan
from mrta_zoo.debug.advisors import Advisor, make_advisor
from mrta_zoo.debug.called import called
from mrta_zoo.debug.comparison import Comparison, Fate, compare
from mrta_zoo.debug.parting import Alternative, Parting
from mrta_zoo.debug.percent import percent
from mrta_zoo.digits import rounded
from mrta_zoo.errors import ConfigError
from mrta_zoo.io import read_scenario
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.io.strict_json import write_document
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.registry import method_names
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.console import preparing, results_console, say
from mrta_zoo.show.terminal.sheet import Sheet
from mrta_zoo.show.view import Digits
from mrta_zoo.verify import COST, Score
from mrta_zoo.wording import counted


@dataclass(frozen=True, slots=True, kw_only=True)
class Compare:
    """Find where two methods part on a mission, and what that costs.

    Prints what each completes; the first decision at which they choose differently, and what would come of it if each
    took the other's choice there and then went on by itself; where the second would choose otherwise in the first
    one's place; and the tasks that only one of them completes.

    For example:
      mrta-zoo compare group1/r11a7i00.txt --methods capam-plus,nearest
      mrta-zoo compare mission.json --methods capam-plus,exact --out comparison.json
      mrta-zoo compare mission.json --methods plan.json,other.json
    """

    scenario: Annotated[Positional[Path], arg(metavar="SCENARIO")]
    """The mission: a TAPTC task file, or a scenario in .json or .csv."""
    agents: Annotated[Path | None, optional("AGENTFILE")] = None
    """The robots: a TAPTC agent file, or .csv. Without it they are in SCENARIO or, for TAPTC, in agent/ beside it."""
    methods: Annotated[
        str,
        arg(
            metavar="FIRST,SECOND",
            help=f"The two: a .json plan or trace, {', '.join(method_names())}, {TRAINED_HELP}. A method that is no "
            "policy plans once; once its plan has been left, its robots do what they still can of their routes.",
        ),
    ] = "capam-plus,nearest"
    out: Annotated[Path | None, optional("COMPARISON.json")] = None
    """Write everything here, as JSON."""
    rows: int = 10
    """How many rows of a table to print at most."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


def compare_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo compare` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    command = parse(Compare, argv, "compare")
    both = names(command.methods, example="capam-plus,nearest")
    if len(both) != 2:
        raise ConfigError(f"methods is {command.methods!r}; expected two, such as capam-plus,nearest")
    if command.rows < 1:
        raise ConfigError(f"rows is {command.rows}; expected a whole number >= 1")
    if command.out:
        files = {name: Path(name) for name in both if is_episode(name)}
        for name in both:
            files |= policy_files(name)
        read = {"the scenario": command.scenario, "the agent file": agent_file(command.scenario, command.agents)}
        check_outputs({"--out": command.out}, {**read, **files})
    scenario = read_scenario(command.scenario, command.agents)
    with (
        preparing(f"plans {command.scenario} by {' and '.join(both)}, and again from where they part"),
        cpu_threads(command.planning.threads),
    ):
        first, second = (_advisor(scenario, name, command.planning) for name in both)
        found = compare(scenario, first, second)
    command.planning.warn_unused(both, "mask_rule")
    with Outputs() as outputs:
        if command.out:
            outputs.write("comparison", command.out, lambda path: write_comparison(found, both, path))
        console = results_console()
        for part in report(found, (both[0], both[1]), command.rows):
            if isinstance(part, str):
                say(console, part)
            else:
                console.print(part, crop=False)
        for line in outputs.written:
            say(console, line)


def _advisor(scenario: Scenario, name: str, planning: PlanningFlags) -> Advisor:
    plan = read_any_plan(Path(name), scenario)
    if plan is not None:
        return make_advisor(scenario, plan, mask_rule=planning.mask_rule)
    return make_advisor(scenario, name, **asdict(planning))


def write_comparison(found: Comparison, methods: Sequence[str], path: Path) -> None:
    """Write a comparison as JSON; the episodes themselves are left out.

    Raises:
        ConfigError: if the file cannot be written.
    """
    parting = found.parting
    document: dict[str, Any] = {
        "format": "mrta_zoo.comparison",
        "version": 1,
        "scenario": found.scenario,
        "tasks": found.tasks,
        "methods": list(methods),
        "outcomes": _outcomes_json(found.scores),
        "parting": parting and asdict(parting) | {"otherwise": _outcomes_json(parting.otherwise)},
        "disagreements": list(map(asdict, found.disagreements)),
        "turns": list(map(asdict, found.turns)),
        "fates": list(map(asdict, found.fates)),
    }
    scenario = found.traces[0].scenario
    names = {"task_names": list(scenario.task_names), "robot_names": list(scenario.robot_names)}
    document |= {field: each for field, each in names.items() if each}
    write_document(document, path, ConfigError)


def _outcomes_json(scores: Sequence[Score | None]) -> tuple[dict[str, Any] | None, ...]:
    figures = ("completed", "cost", "distance", "makespan")
    return tuple(None if score is None else {name: getattr(score, name) for name in figures} for score in scores)


def report(found: Comparison, methods: tuple[str, str], rows: int) -> list[str | Group]:
    """What there is to say, as lines and tables with at most so many rows."""
    first, second = methods
    scenario = found.traces[0].scenario
    robots, tasks, digits = scenario.robot_names, scenario.task_names, Digits.of(scenario)
    parts: list[str | Group] = [_outcomes(found, methods)]
    if found.parting is None:
        return [*parts, f"{first} and {second} do the same throughout"]
    parts += [_parted(found.parting, methods, scenario), *_costs(found, found.parting, methods)]
    parts.append(
        _listed(
            f"In the place of {first}, {second} would choose otherwise at {len(found.disagreements)} of "
            f"{counted(len(found.traces[0].choices), 'decision')}",
            ("decision", "time", "robot", f"{first}", f"{second}"),
            [
                (
                    each.index,
                    digits.time(each.time),
                    called(each.robot, robots),
                    _task(each.chosen, scenario),
                    _task(each.advised, scenario),
                )
                for each in found.disagreements
            ],
            rows,
        )
    )
    parts.append(
        _listed(
            f"Turns in which a robot takes different tasks: {len(found.turns)}",
            ("robot", "turn", first, "until", second, "until"),
            [
                (
                    called(each.robot, robots),
                    each.turn,
                    _named(each.tasks[0], tasks),
                    _time(each.finish[0], digits),
                    _named(each.tasks[1], tasks),
                    _time(each.finish[1], digits),
                )
                for each in found.turns
            ],
            rows,
        )
    )
    for index, method in enumerate(methods):
        fates = [each for each in found.fates if each.completed[index]]
        parts.append(
            _listed(
                f"Completed only by {method}: {len(fates)}",
                ("task", "deadline", "robot", "finish", f"by {methods[1 - index]}"),
                [
                    (
                        called(each.task, tasks), digits.time(each.deadline), _named(each.robots[index], robots),
                        _time(each.finish[index], digits), _fate(each, 1 - index, scenario),
                    )
                    for each in fates
                ],
                rows,
            )
        )  # fmt: skip
    return parts


def _outcomes(found: Comparison, methods: tuple[str, str]) -> Group:
    return _listed(
        f"{found.scenario}: {counted(found.tasks, 'task')} (cost by {COST})",
        ("method", "completed", "cost", "distance", "makespan"),
        [(name, *_figures(score)) for name, score in zip(methods, found.scores, strict=True)],
        2,
    )


def _figures(score: Score) -> tuple[object, ...]:
    return score.completed, f"{score.cost:.3f}", rounded(score.distance), rounded(score.makespan)


def _fate(fate: Fate, index: int, scenario: Scenario) -> str:
    """What one of the two makes of a task that it doesn't complete."""
    robot, late = fate.robots[index], fate.finish[index]
    if robot is None or late is None:
        return "not taken"
    return f"late, by {scenario.robot_name(robot)} at {Digits.of(scenario).time(late)}"


def _parted(parting: Parting, methods: tuple[str, str], scenario: Scenario) -> Group:
    digits = Digits.of(scenario)
    probable = [
        index for index in range(2) if any(choice.probabilities[index] is not None for choice in parting.choices)
    ]  # plans have none

    def row(method: str, choice: Alternative) -> tuple[object, ...]:
        likely = [None if each is None else percent(each) for each in (choice.probabilities[i] for i in probable)]
        distance = None if choice.distance is None else digits.distance(choice.distance)
        times = (_time(each, digits) for each in (choice.finish, choice.slack))
        return method, _task(choice.task, scenario), distance, *times, *likely

    return _listed(
        f"They part at decision {parting.index}, at {digits.time(parting.time)}, when "
        f"{scenario.robot_name(parting.robot)} chooses",
        ("method", "task", "distance", "finish", "slack", *(f"% {methods[index]}" for index in probable)),
        [row(method, choice) for method, choice in zip(methods, parting.choices, strict=True)],
        2,
    )


def _costs(found: Comparison, parting: Parting, methods: tuple[str, str]) -> list[str]:
    """What each method makes of the other's choice, a line each."""
    lines = []
    for index, method in enumerate(methods):
        task = parting.choices[1 - index].task
        instead, score = parting.otherwise[index], found.scores[index]
        choice = "staying there" if task is None else f"task {found.traces[0].scenario.task_name(task)} there"
        if instead is None:
            lines.append(f"{method} may not have {choice}, by its mask rule")
            continue
        lines.append(
            f"{method} with {choice} and then by itself: completed {instead.completed} "
            f"({instead.completed - score.completed:+d}), "
            f"cost {instead.cost:.3f} ({instead.cost - score.cost:+.3f})"
        )
    return [*lines, ""]


def _listed(title: str, columns: Sequence[str], rows: Sequence[Sequence[object]], most: int) -> Group:
    shown = [tuple(map(_cell, row)) for row in rows[:most]]
    more = [Text(f"and {len(rows) - most} more (--rows)")] if len(rows) > most else []
    return Group(Sheet(title, columns, shown, left=("method",)), *more)


def _cell(value: object) -> str:
    return "-" if value is None else str(value)


def _time(value: float | None, digits: Digits) -> str | None:
    return None if value is None else digits.time(value)


def _task(task: int | None, scenario: Scenario) -> str:
    return "stays" if task is None else scenario.task_name(task)


def _named(index: int | None, names: Sequence[str]) -> str | None:
    return None if index is None else called(index, names)
