"""The command line, ``mrta-zoo``: which command, and what becomes of errors. Commands are in `eval`.

Exit codes: 0, 2 for what the user can put right (one sentence on standard error, no traceback), 130 after Ctrl-C.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress

from mrta_zoo import __version__
from mrta_zoo.cli.streams import fit_streams
from mrta_zoo.errors import ConfigError, MrtaError
from mrta_zoo.extras import require
from mrta_zoo.io.paths import check_no_url
from mrta_zoo.show.terminal.fold import fold, help_width, spelt_out
from mrta_zoo.wording import is_utf8

Command = Callable[[list[str]], None]
"""Runs a command with the arguments that follow its name."""

NO_MEMORY = "not enough memory for this command; expected a smaller mission, or lower numbers in its options"
USER_ERROR, INTERRUPTED, BROKEN_PIPE = 2, 130, 141


# Imports are inside, so that `mrta-zoo --help` is instant and heuristics need no torch.
def _solve(argv: list[str]) -> None:
    from mrta_zoo.cli.commands import solve_command

    solve_command(argv)


def _eval(argv: list[str]) -> None:
    from mrta_zoo.cli.commands import eval_command

    eval_command(argv)


def _generate(argv: list[str]) -> None:
    from mrta_zoo.cli.generate import generate_command

    generate_command(argv)


def _step(argv: list[str]) -> None:
    from mrta_zoo.cli.step import step_command

    step_command(argv)


def _compare(argv: list[str]) -> None:
    from mrta_zoo.cli.compare import compare_command

    compare_command(argv)


def _replay(argv: list[str]) -> None:
    from mrta_zoo.cli.replay import replay_command

    replay_command(argv)


def _train(argv: list[str]) -> None:
    require("torch", "training", ("scipy", "filelock"))
    from mrta_zoo.cli.train import train_command

    train_command(argv)


def _reproduce(argv: list[str]) -> None:
    require("report", "the report")
    from mrta_zoo.cli.reproduce import reproduce_command

    reproduce_command(argv)


def _converge(argv: list[str]) -> None:
    require("report", "the figure")
    from mrta_zoo.cli.converge import converge_command

    converge_command(argv)


def _ablate(argv: list[str]) -> None:
    require("torch", "training")
    require("report", "the report")
    from mrta_zoo.cli.ablate import ablate_command

    ablate_command(argv)


def _sharing(argv: list[str]) -> None:
    require("torch", "training")
    require("report", "the report")
    from mrta_zoo.cli.sharing import sharing_command

    sharing_command(argv)


def _demo(argv: list[str]) -> None:
    from mrta_zoo.cli.commands import demo_command

    demo_command(argv)


COMMANDS: dict[str, tuple[str, Command]] = {
    "solve": ("plan one mission: who does which task when", _solve),
    "eval": ("compare methods on a folder of cases, or on the built-in suite", _eval),
    "step": ("go through an episode one decision at a time, and choose otherwise", _step),
    "compare": ("find where two methods part on a mission, and what it costs", _compare),
    "generate": ("draw random scenarios into a folder of cases", _generate),
    "replay": ("make a page that replays an episode in a browser, or two side by side", _replay),
    "train": ("train a policy by REINFORCE", _train),
    "reproduce": ("run the experiments of the CapAM paper and write a report", _reproduce),
    "converge": ("measure plan quality against planning time, and draw it", _converge),
    "ablate": ("train variants that differ in one thing each, and compare them", _ablate),
    "sharing": ("train one policy for all robots, one by kind and one for each, and compare them", _sharing),
    "demo": ("see it all at work, in a few minutes", _demo),
}
"""Each command with what `mrta-zoo --help` says of it. To add one, give it an entry."""


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
        COMMANDS[name][1](rest)
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
    commands = "\n".join(f"  {name:<{column}}{summary}" for name, (summary, _) in COMMANDS.items())
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
