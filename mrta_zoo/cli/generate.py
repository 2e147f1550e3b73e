"""The command ``mrta-zoo generate``."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from tyro.conf import arg

from mrta_zoo.bounds import check_seed
from mrta_zoo.cli.flags import optional, takes_flags
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import make_generator
from mrta_zoo.io.case_folder import write_case_folder
from mrta_zoo.io.formats import FormatName
from mrta_zoo.show.terminal.console import results_console, say
from mrta_zoo.wording import counted

Bounds = Annotated[str | None, optional("LOW-HIGH")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Generate:
    """Draw random scenarios into a new folder that `mrta-zoo eval --cases` reads.

    Bounds are LOW-HIGH, both included, or one number. Bounds that are not given are the generator's own.

    For example:
      mrta-zoo generate --count 20 --robots 2-7 --out cases
      mrta-zoo generate --generator uniform --tasks 50-200 --format json --out cases
    """

    out: Annotated[Path, arg(metavar="DIR")]
    """The folder to write, new or empty."""
    generator: Literal["taptc", "uniform"] = "taptc"
    """taptc: like the published TAPTC cases; uniform: everything uniform within its bounds, as in the paper (§IV-A)."""
    count: int = 10
    """Number of scenarios."""
    seed: int = 0
    """Random seed. The same seed and bounds give the same scenarios, and a higher --count only adds to them."""
    format: FormatName = "taptc"
    """Format of the files. TAPTC files hold no speeds."""
    tasks: Bounds = None
    """Number of tasks; 100 by default."""
    robots: Bounds = None
    """Number of robots; 2-7 by default."""
    map: Annotated[str | None, optional("WIDTH-HEIGHT")] = None
    """Sides of the map in distance units; 100 by default."""
    workload: Bounds = None
    """Work that a task takes, in work units; 20 by default, 10-30 for uniform. One number for taptc."""
    capacity: Annotated[str | None, optional("LOW-HIGH|half|random")] = None
    """Work a robot does per time unit: for uniform bounds, 1-3 by default; for taptc half (the first half of the
    robots has 2, the others 1; the default) or random (1 or 2)."""
    deadline: Bounds = None
    """Only uniform: deadlines in time units; 50-600 by default."""
    speed: Bounds = None
    """Only uniform: distance a robot travels per time unit; 1 by default."""
    group: Annotated[str | None, optional("{tight,slack,mixed}")] = None
    """Only taptc: latest deadline 250-300 (tight), twice that (slack), or either (mixed, the default)."""


@takes_flags
def generate_command(command: Generate) -> None:
    """Draw the scenarios into the folder.

    Raises:
        MrtaError: if an option cannot be used, or the folder cannot be written.
    """
    if command.count < 1:
        raise ConfigError(f"count is {command.count}; expected a whole number >= 1")
    check_seed(command.seed)
    given: dict[str, Any] = {"group": command.group, "map_size": _bounds(command.map)}
    for name in ("tasks", "robots", "workload", "capacity", "deadline", "speed"):
        given[name] = _bounds(getattr(command, name))
    fields = {name: value for name, value in given.items() if value is not None}
    generator = make_generator(command.generator, **fields)
    digits = len(str(command.count - 1))
    # A stream of its own for each scenario, so that none depends on how many there are.
    scenarios = (
        generator(np.random.default_rng((command.seed, index)), f"{command.generator}{index:0{digits}d}")
        for index in range(command.count)
    )
    write_case_folder(scenarios, command.out, command.format)
    say(results_console(), f"{counted(command.count, 'scenario')} written to {command.out}")


def _bounds(text: str | None) -> tuple[float, float] | float | str | None:
    """Numbers written as ``2`` or ``2-7``; anything else as it is, for the generator to accept or refuse."""
    if text is None:
        return None
    number = r"([0-9]*\.?[0-9]+)"
    if pair := re.fullmatch(f"{number}-{number}", text):
        return float(pair[1]), float(pair[2])
    return float(text) if re.fullmatch(number, text) else text
