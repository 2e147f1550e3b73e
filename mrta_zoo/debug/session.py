"""Commands that step through an episode, one a line: what a person types, and what scripts hold."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn, get_args

from mrta_zoo.debug.advisors import Advisor, PolicyAdvisor
from mrta_zoo.debug.called import find, found, numbers_count
from mrta_zoo.debug.outlook import SortKey
from mrta_zoo.debug.pages import Listing, View, listing
from mrta_zoo.debug.stepper import Stepper
from mrta_zoo.errors import ConfigError
from mrta_zoo.io import read_trace
from mrta_zoo.io.json_format import json_kind
from mrta_zoo.show.view import Digits
from mrta_zoo.trace import Choice
from mrta_zoo.wording import counted


class Session:
    """A stepper under the commands of somebody who looks at it.

    Args:
        stepper: where to begin.
        advisor: whose advice a session that is loaded gets.
        path: where `save` writes without a file of its own: a session's file, or else the first that it was saved to.

    Attributes:
        stepper: where one stands.
        view: what one looks at.
        over: whether one has left.
        unsaved: choices of one's own since the last `save`.
    """

    def __init__(self, stepper: Stepper, advisor: Advisor | None = None, path: Path | None = None) -> None:
        self.stepper, self._advisor, self.path = stepper, advisor, path
        self.view = View()
        self.over = False
        self.unsaved = 0

    def do(self, line: str) -> str:
        """Carry out a command; an empty one is `follow`, and a task's name or number alone is `take`.

        Returns:
            What has come of it, in a line.

        Raises:
            MrtaError: if it cannot be done; nothing is changed then.
        """
        command, argument = self._understood(line.strip())
        before = self.stepper.position
        said = command.run(self, argument)
        if self.stepper.position != before or command.name == "load":
            self.view = View(order=self.view.order)
        return said

    def listing(self) -> Listing:
        """The table that is looked at."""
        return listing(self.stepper, self.view, [(each.usage, each.summary) for each in COMMANDS])

    def _understood(self, line: str) -> tuple[Command, str]:
        """The command, and what follows it."""
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
            known = ", ".join(each.name for each in COMMANDS)
            task = "a number of a task" if not names else "a task's name" + " or number" * numbers_count(names)
            raise ConfigError(f"there is no command {name!r}; expected {task}, or one of {known}")
        several = len(argument.split()) > 1 and not command.names_one
        if several or (argument and not command.argument) or (not argument and command.argument.isupper()):
            expected = f"{command.name} {command.argument}".strip()
            raise ConfigError(f"the command is {line!r}; expected {expected}")
        return command, argument

    # Each command is a function of the session and its argument, "" if there is none.
    def follow(self, _: str) -> str:
        return self._chosen(self.stepper.follow)

    def take(self, task: str) -> str:
        number = found(task, "task", self.stepper.scenario.task_names)
        return self._chosen(lambda: self.stepper.take(number), own=True)

    def stay(self, _: str) -> str:
        return self._chosen(self.stepper.stay, own=True)

    def back(self, decisions: str) -> str:
        self.stepper.back(_number(decisions or "1", "decisions"))
        return self.where()

    def forward(self, decisions: str) -> str:
        self.stepper.forward(_number(decisions or "1", "decisions"))
        return self.where()

    def goto(self, decision: str) -> str:
        self.stepper.go_to(_number(decision, "decision"))
        return self.where()

    def jump(self, robot: str) -> str:
        self.stepper.jump(found(robot, "robot", self.stepper.scenario.robot_names))
        return self.where()

    def end(self, _: str) -> str:
        self.stepper.finish()
        return self.where()

    def next_page(self, _: str) -> str:
        self.view.page += 1
        return ""

    def previous_page(self, _: str) -> str:
        self.view.page = max(self.view.page - 1, 0)
        return ""

    def tasks(self, robot: str) -> str:
        number = found(robot, "robot", self.stepper.scenario.robot_names) if robot else None
        if number is not None:
            self.stepper.outlook(number)  # there must be such a robot
        self.view = View("tasks", robot=number, order=self.view.order)
        return ""

    def sort(self, order: str) -> str:
        for known in get_args(SortKey):
            if order == known:
                self.view = View("tasks", robot=self.view.robot, order=known)
                return f"tasks by {order}"
        raise ConfigError(f"there is no order {order!r}; expected one of {', '.join(get_args(SortKey))}")

    def robots(self, _: str) -> str:
        self.view = View("robots", order=self.view.order)
        return ""

    def log(self, _: str) -> str:
        self.view = View("log", order=self.view.order)
        return ""

    def help(self, _: str) -> str:
        self.view = View("help", order=self.view.order)
        return ""

    def save(self, file: str) -> str:
        path = Path(file) if file else self.path
        if path is None:
            raise ConfigError("there is no file to save to yet; expected save FILE")
        if path.is_file() and json_kind(path) != "mrta_zoo.trace":
            raise ConfigError(f"{path} is there already and is no session; expected the name of a new file, or of one")
        self.stepper.save(path)
        self.path, self.unsaved = self.path or path, 0  # a copy does not move the session
        return f"{counted(len(self.stepper), 'decision')} saved to {path}"

    def load(self, file: str) -> str:
        trace = read_trace(file)
        same = trace.scenario == self.stepper.scenario
        # A policy advises on any mission, a plan only on its own.
        advisor = self._advisor if same or isinstance(self._advisor, PolicyAdvisor) else None
        self.stepper = Stepper.resume(trace, advisor)
        self.path, self.unsaved = Path(file), 0
        return f"{counted(len(self.stepper), 'decision')} loaded; {self.where()}"

    def quit(self, _: str) -> str:
        self.over = True
        return ""

    def where(self) -> str:
        """Where one stands, in a line."""
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


@dataclass(frozen=True, slots=True)
class Command:
    """One command.

    Attributes:
        name: its name.
        short: a letter for it, empty if there is none.
        argument: what may follow, lower-case in brackets if it need not; empty if nothing may.
        summary: what it does.
        run: does it, and says what came of it.
    """

    name: str
    short: str
    argument: str
    summary: str
    run: Callable[[Session, str], str]

    @property
    def names_one(self) -> bool:
        """Whether what follows is a task or a robot, whose name may hold blanks."""
        return self.argument.strip("[]").lower() in ("task", "robot")

    @property
    def usage(self) -> str:
        """How it is written."""
        return ", ".join(filter(None, (self.short, self.name))) + (f" {self.argument}" if self.argument else "")


COMMANDS: Sequence[Command] = (
    Command("follow", "", "", "take the policy's choice, > in the table; as Enter alone", Session.follow),
    Command("take", "", "TASK", "take this task; as its name or number alone", Session.take),
    Command("stay", "", "", "let the robot stay for good, as a plan may (agents cannot)", Session.stay),
    Command("back", "b", "[n]", "take back the last decision, or n of them", Session.back),
    Command("forward", "f", "[n]", "on by 1 or n: as before (*), then as the policy chooses", Session.forward),
    Command("goto", "g", "DECISION", "to this decision; goto 0 to the start", Session.goto),
    Command("jump", "j", "ROBOT", "on to this robot's next turn", Session.jump),
    Command("end", "e", "", "on to the end", Session.end),
    Command("next", "n", "", "next page of the table", Session.next_page),
    Command("previous", "p", "", "previous page of the table", Session.previous_page),
    Command("tasks", "t", "[robot]", "tasks, of this robot when it is next free", Session.tasks),
    Command("sort", "s", "ORDER", f"tasks by {', '.join(get_args(SortKey))}", Session.sort),
    Command("robots", "r", "", "what every robot does", Session.robots),
    Command("log", "l", "", "the decisions so far", Session.log),
    Command("save", "", "[file]", "save all decisions and this place as JSON", Session.save),
    Command("load", "", "FILE", "go on with a saved session, or any trace", Session.load),
    Command("help", "h", "", "this list; also ?", Session.help),
    Command("quit", "q", "", "leave", Session.quit),
)
_BY_NAME = {name: command for command in COMMANDS for name in (command.name, command.short) if name}
_BY_NAME["?"] = _BY_NAME["help"]


def _number(text: str, what: str) -> int:
    if not text.isdecimal() or not text.isascii() or len(text) > 9:
        _refuse(text, what)
    return int(text)


def _refuse(text: str, what: str) -> NoReturn:
    raise ConfigError(f"{what} is {text!r}; expected a whole number >= 0")
