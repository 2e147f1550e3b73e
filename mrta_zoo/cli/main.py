"""The command line, ``mrta-zoo``: the table of commands, and how it ends. Each command has a module of its own.

Exit codes: 0, 2 for what the user can put right (one sentence on standard error, no traceback), 130 after Ctrl-C.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from typing import NamedTuple

from mrta_zoo import __version__
from mrta_zoo.cli.streams import fit_streams
from mrta_zoo.errors import ConfigError, MrtaError
from mrta_zoo.extras import require
from mrta_zoo.io.paths import check_no_url
from mrta_zoo.show.terminal.fold import fold, help_width, spelt_out
from mrta_zoo.wording import is_utf8

NO_MEMORY = "not enough memory for this command; expected a smaller mission, or lower numbers in its options"
USER_ERROR, INTERRUPTED, BROKEN_PIPE = 2, 130, 141

Need = tuple[str, str] | tuple[str, str, Sequence[str]]
"""What a command needs to be installed, as `require` takes it."""


class Command(NamedTuple):
    """A command NAME, which is the function ``NAME_command`` of the module ``mrta_zoo.cli.NAME``.

    Attributes:
        summary: what `mrta-zoo --help` says about it.
        needs: the extras that it cannot do without.
    """

    summary: str
    needs: Sequence[Need] = ()

    def run(self, name: str, argv: list[str]) -> None:
        """Run it with the arguments that follow its name."""
        for need in self.needs:
            require(*need)
        # Imported here, so that `mrta-zoo --help` is instant and heuristics need no torch.
        getattr(import_module(f"mrta_zoo.cli.{name}"), f"{name}_command")(argv)


TRAINING: Need = ("torch", "training", ("scipy", "filelock"))
REPORT: Need = ("report", "the report")
COMMANDS = {
    "solve": Command("plan one mission: who does which task when"),
    "eval": Command("compare methods on a folder of cases, or on a built-in suite"),
    "step": Command("go through an episode one decision at a time, and choose differently"),
    "compare": Command("find where two methods part on a mission, and what that costs"),
    "generate": Command("draw random scenarios into a folder of cases"),
    "replay": Command("make a page that replays an episode in a browser, or two side by side"),
    "train": Command("train a policy by REINFORCE", [TRAINING]),
    "reproduce": Command("run the experiments of the CapAM paper and write a report", [REPORT]),
    "converge": Command("measure plan quality against planning time, and draw it", [REPORT]),
    "ablate": Command("train variants that differ in one thing each, and compare them", [TRAINING, REPORT]),
    "sharing": Command(
        "train one policy for all robots, one per kind, and one per robot, and compare them", [TRAINING, REPORT]
    ),
    "demo": Command("see everything at work, in a few minutes"),
}
"""The commands. To add one: a row here, and a module of its name."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code. Streams, signals and torch's threads are left as they were.

    Args:
        argv: the arguments; by default those of the process, which then ends, so that standard output may be given up.
    """
    with fit_streams():
        return _run(sys.argv[1:] if argv is None else argv, ends=argv is None)


def _run(arguments: Sequence[str], ends: bool) -> int:
    try:
        return _exit_code(arguments)
    finally:
        if ends:
            _drop_stuck_output()


def _exit_code(arguments: Sequence[str]) -> int:
    try:
        try:
            code = _dispatch(list(arguments))
        except SystemExit:
            sys.stdout.flush()
            raise
        sys.stdout.flush()  # a full disk, or a reader that has gone away, shows here, not at exit
        return code
    except MrtaError as error:
        return _complain(str(error))
    except KeyboardInterrupt:
        _tell("interrupted")
        return INTERRUPTED
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        return BROKEN_PIPE
    except OSError as error:
        where = "the output" if error.filename is None else os.fsdecode(error.filename)
        return _complain(f"{where}: {(error.strerror or str(error)).lower()}")
    except MemoryError:
        return _complain(NO_MEMORY)
    except RecursionError:
        return _complain(
            "this command's input is nested too deeply; expected a scenario, plan or policy of this package"
        )
    except RuntimeError as error:  # which is what torch says, on a CPU and on a GPU
        if "can't allocate memory" in str(error) or "out of memory" in str(error):
            return _complain(NO_MEMORY)
        raise


def _dispatch(arguments: list[str]) -> int:
    if not arguments:
        print(_help(), file=sys.stderr)
        return USER_ERROR
    _check_current_folder()
    for argument in arguments:
        _check(argument)
    name, *rest = arguments
    if name in ("-h", "--help"):
        print(_help())
    elif name == "--version":
        print(f"mrta-zoo {__version__}")
    elif name in COMMANDS:
        COMMANDS[name].run(name, rest)
    else:
        kind = "option" if name.startswith("-") else "command"
        print(f"error: there is no {kind} {name!r}; expected one of {', '.join(COMMANDS)}", file=sys.stderr)
        return USER_ERROR
    return 0


def _check_current_folder() -> None:
    try:
        os.getcwd()
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ConfigError(f"the current folder cannot be used ({reason}); expected to be in one that exists") from None


def _check(argument: str) -> None:
    """Refuse at once what no command can use: what is written or printed later would fail, or go astray."""
    if not is_utf8(argument):
        raise ConfigError(f"{argument!r} is not UTF-8; expected names of files and folders in UTF-8")
    for part in re.split("^--[a-z-]+=|,", argument):
        check_no_url(part, ConfigError)


def _help() -> str:
    column = max(map(len, COMMANDS)) + 2
    commands = "\n".join(f"  {name:<{column}}{command.summary}" for name, command in COMMANDS.items())
    text = (
        "usage: mrta-zoo COMMAND [options]\n\n"
        "Multi-robot task allocation: robots share tasks that have places, workloads and deadlines.\n\n"
        f"commands:\n{commands}\n\n"
        "options:\n"
        "  --version   print the version\n"
        "  -h, --help  print this; `mrta-zoo COMMAND --help` explains a command\n\n"
        "example:\n"
        "  mrta-zoo generate --count 3 --out cases\n"
        "  mrta-zoo solve cases/group1/taptc0.txt --method nearest --plot plan.png"
    )
    indent = " " * (column + 2)
    return "\n".join(each for line in text.split("\n") for each in fold(line, help_width(), indent * (line[:1] == " ")))


def _complain(sentence: str) -> int:
    """Print an error as one line in which nothing steers the terminal, and give the exit code."""
    _tell(f"error: {spelt_out(' '.join(sentence.split()))}")
    return USER_ERROR


def _tell(line: str) -> None:
    with suppress(OSError):  # if nobody reads it, the exit code must do
        print(line, file=sys.stderr)


def _drop_stuck_output() -> None:
    """Keep what cannot be written to standard output from being tried again, and complained about, at exit."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
