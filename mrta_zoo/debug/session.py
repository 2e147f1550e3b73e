"""A session of the stepper: commands, one per line, typed by a person or read from a script."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

from mrta_zoo.debug.advisors import Advisor, PolicyAdvisor
from mrta_zoo.debug.naming import DIGITS, find, identify, numbers_count
from mrta_zoo.debug.outlook import SortKey
from mrta_zoo.debug.pages import Listing, Subject, TableView, listing
from mrta_zoo.debug.stepper import Stepper
from mrta_zoo.errors import ConfigError
from mrta_zoo.io import read_trace
from mrta_zoo.io.json_format import json_kind
from mrta_zoo.show.view import Digits
from mrta_zoo.trace import Choice
from mrta_zoo.wording import counted

_Run = Callable[["Session", str], str]


@dataclass(frozen=True, slots=True)
class SessionCommand:
    """One command.

    Attributes:
        name: its name.
        short: its abbreviation, one letter; empty if there is none.
        argument: its argument, in capitals; in brackets and lower case if it is optional; empty if there is none.
        summary: what it does.
        run: does it, given the session and the argument ("" if absent), and returns a line that says what happened.
    """

    name: str
    short: str
    argument: str
    summary: str
    run: _Run

    @property
    def names_one(self) -> bool:
        """Whether the argument is a task or a robot, whose name may contain blanks."""
        return self.argument.strip("[]").lower() in ("task", "robot")

    @property
    def usage(self) -> str:
        """How it is typed."""
        return ", ".join(filter(None, (self.short, self.name))) + (f" {self.argument}" if self.argument else "")


SESSION_COMMANDS: list[SessionCommand] = []
"""All commands, in the order in which help lists them."""


def _command(summary: str, *, short: str = "", argument: str = "") -> Callable[[_Run], _Run]:
    """Make a method of `Session` the command of its name."""

    def add(run: _Run) -> _Run:
        SESSION_COMMANDS.append(SessionCommand(run.__name__, short, argument, summary, run))
        return run

    return add


class Session:
    """A stepper, the table that its user looks at, and the commands that change them.

    Args:
        stepper: where to begin.
        advisor: the advisor for sessions loaded later.
        path: the file for `save` without an argument; None for the first file that the session is saved to.

    Attributes:
        stepper: the episode, and where the user is in it.
        view: the table that the user looks at.
        over: whether the user has left.
        unsaved: number of the user's own choices since the last `save`.
    """

    # Not the standard library's `cmd`: it reads and prints by itself, splits lines at the first character that cannot
    # be in an identifier, and has no arguments. Here a task's name is a command, too, and terminal, scripts and tests
    # decide where lines come from and where answers go. Nor `shlex`: names may hold quotes and #.

    def __init__(self, stepper: Stepper, advisor: Advisor | None = None, path: Path | None = None) -> None:
        self.stepper, self._advisor, self.path = stepper, advisor, path
        self.view = TableView()
        self.over = False
        self.unsaved = 0

    def do(self, line: str) -> str:
        """Carry out a command. An empty line is `follow`, and a task's name or number alone is `take`.

        Returns:
            A line that says what happened.

        Raises:
            MrtaError: if it cannot be carried out; then nothing has changed.
        """
        command, argument = self._understood(line.strip())
        before = self.stepper.position
        said = command.run(self, argument)
        if self.stepper.position != before or command.name == "load":
            self.view = TableView(order=self.view.order)
        return said

    def listing(self) -> Listing:
        """The table that the user looks at."""
        return listing(self.stepper, self.view, [(each.usage, each.summary) for each in SESSION_COMMANDS])

    def _understood(self, line: str) -> tuple[SessionCommand, str]:
        """The command and its argument."""
        if not line:
            return _BY_NAME["follow"], ""
        names = self.stepper.scenario.task_names
        name, argument = [*line.split(maxsplit=1), ""][:2]
        command = _BY_NAME.get(name.lower())
        if find(line, "task", names) is not None:
            if command is not None:
                other = next((each for each in (command.short, command.name) if each and each not in names), "")
                expected = f"take {line} for the task" + (f", or {other} for the command" if other else "")
                raise ConfigError(f"{line!r} is a task and a command; expected {expected}")
            return _BY_NAME["take"], line
        if command is None:
            known = ", ".join(each.name for each in SESSION_COMMANDS)
            task = "a number of a task" if not names else "a task's name" + " or number" * numbers_count(names)
            raise ConfigError(f"there is no command {name!r}; expected {task}, or one of {known}")
        several = len(argument.split()) > 1 and not command.names_one
        if several or (argument and not command.argument) or (not argument and command.argument.isupper()):
            expected = f"{command.name} {command.argument}".strip()
            raise ConfigError(f"the command is {line!r}; expected {expected}")
        return command, argument

    @_command("take the policy's choice (> in the table), as Enter alone does")
    def follow(self, _: str) -> str:
        return self._chosen(self.stepper.follow)

    @_command("take this task, as its name or number alone does", argument="TASK")
    def take(self, task: str) -> str:
        number = identify(task, "task", self.stepper.scenario.task_names)
        return self._chosen(lambda: self.stepper.take(number), own=True)

    @_command("make the robot stay for good, as plans can (agents cannot)")
    def stay(self, _: str) -> str:
        return self._chosen(self.stepper.stay, own=True)

    @_command("take back the last decision, or n of them", short="b", argument="[n]")
    def back(self, decisions: str) -> str:
        self.stepper.back(_number(decisions or "1", "decisions"))
        return self.where()

    @_command("go on by 1 or n: as before (*), then as the policy chooses", short="f", argument="[n]")
    def forward(self, decisions: str) -> str:
        self.stepper.forward(_number(decisions or "1", "decisions"))
        return self.where()

    @_command("go to this decision; goto 0 is the start", short="g", argument="DECISION")
    def goto(self, decision: str) -> str:
        self.stepper.go_to(_number(decision, "decision"))
        return self.where()

    @_command("go on to this robot's next turn", short="j", argument="ROBOT")
    def jump(self, robot: str) -> str:
        self.stepper.jump(identify(robot, "robot", self.stepper.scenario.robot_names))
        return self.where()

    @_command("go on to the end", short="e")
    def end(self, _: str) -> str:
        self.stepper.finish()
        return self.where()

    @_command("next page of the table", short="n")
    def next(self, _: str) -> str:
        self.view.page += 1
        return ""

    @_command("previous page of the table", short="p")
    def previous(self, _: str) -> str:
        self.view.page = max(self.view.page - 1, 0)
        return ""

    @_command("the tasks, or those of this robot when it is next free", short="t", argument="[robot]")
    def tasks(self, robot: str) -> str:
        number = identify(robot, "robot", self.stepper.scenario.robot_names) if robot else None
        if number is not None:
            self.stepper.outlook(number)  # there must be such a robot
        return self._show("tasks", number)

    @_command(f"the tasks sorted by {', '.join(get_args(SortKey))}", short="s", argument="ORDER")
    def sort(self, order: str) -> str:
        for known in get_args(SortKey):
            if order == known:
                self.view = TableView("tasks", robot=self.view.robot, order=known)
                return f"tasks by {order}"
        raise ConfigError(f"there is no order {order!r}; expected one of {', '.join(get_args(SortKey))}")

    @_command("what every robot is doing", short="r")
    def robots(self, _: str) -> str:
        return self._show("robots")

    @_command("the decisions so far", short="l")
    def log(self, _: str) -> str:
        return self._show("log")

    @_command("save all decisions and this place as JSON", argument="[file]")
    def save(self, file: str) -> str:
        path = Path(file) if file else self.path
        if path is None:
            raise ConfigError("there is no file to save to yet; expected save FILE")
        if path.is_file() and json_kind(path) != "mrta_zoo.trace":
            raise ConfigError(f"{path} already exists and is not a session; expected a new file, or a session's")
        self.stepper.save(path)
        self.path, self.unsaved = self.path or path, 0  # a copy does not move the session
        return f"{counted(len(self.stepper), 'decision')} saved to {path}"

    @_command("go on with a saved session, or any trace", argument="FILE")
    def load(self, file: str) -> str:
        trace = read_trace(file)
        same = trace.scenario == self.stepper.scenario
        # A policy advises on any mission, a plan only on its own.
        advisor = self._advisor if same or isinstance(self._advisor, PolicyAdvisor) else None
        self.stepper = Stepper.resume(trace, advisor)
        self.path, self.unsaved = Path(file), 0
        return f"{counted(len(self.stepper), 'decision')} loaded; {self.where()}"

    @_command("this list; also ?", short="h")
    def help(self, _: str) -> str:
        return self._show("help")

    @_command("leave", short="q")
    def quit(self, _: str) -> str:
        self.over = True
        return ""

    def where(self) -> str:
        """Where the session is, in one line."""
        stepper, time = self.stepper, Digits.of(self.stepper.scenario).time
        if stepper.done:
            mission = stepper.mission
            return (
                f"the mission is over: completed {mission.completed()} of "
                f"{counted(stepper.scenario.num_tasks, 'task')}, cost {mission.cost():.3f}, "
                f"makespan {time(mission.time)}"
            )
        robot = stepper.scenario.robot_name(stepper.robot)
        return f"decision {stepper.position}: {robot} chooses at {time(stepper.mission.time)}"

    def _show(self, subject: Subject, robot: int | None = None) -> str:
        self.view = TableView(subject, robot=robot, order=self.view.order)
        return ""

    def _chosen(self, choose: Callable[[], Choice], own: bool = False) -> str:
        robot, index = self.stepper.robot, self.stepper.position
        choice, scenario = choose(), self.stepper.scenario
        self.unsaved += own
        if choice.task is None:
            what = "stays for good"
        else:
            finish = float(self.stepper.mission.finish[choice.task])
            late = "" if finish <= scenario.deadline[choice.task] else ", late"
            what = f"takes task {scenario.task_name(choice.task)}, until {Digits.of(scenario).time(finish)}{late}"
        if choice.advice is not None:
            what += f" (the policy's choice: task {scenario.task_name(choice.advice)})"
        return f"decision {index}: {scenario.robot_name(robot)} {what}"


_BY_NAME = {name: command for command in SESSION_COMMANDS for name in (command.name, command.short) if name}
_BY_NAME["?"] = _BY_NAME["help"]


def _number(text: str, what: str) -> int:
    if not text.isdecimal() or not text.isascii() or len(text) > DIGITS:
        raise ConfigError(f"{what} is {text!r}; expected a whole number >= 0")
    return int(text)
