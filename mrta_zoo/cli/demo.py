"""The command ``mrta-zoo demo``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.flags import takes_flags


@dataclass(frozen=True, slots=True, kw_only=True)
class Demo:
    """See everything at work in a few minutes.

    Robots take turns in the environment under one shared, trained policy; methods are compared on the built-in suite; a
    small policy is trained from scratch; a plan is drawn.

    For example:
      mrta-zoo demo --out demo
    """

    out: Annotated[Path, arg(metavar="DIR")] = Path("mrta_zoo_demo")
    """The folder for the rows of the comparison, the training run and the picture; created if it does not exist."""
    policy: Annotated[str, arg(metavar="POLICY")] = "capam-plus"
    """The trained policy to show: the one that ships with the package, a .safetensors file, or the folder of a run."""


@takes_flags
def demo_command(command: Demo) -> None:
    """Run the demo.

    Raises:
        MrtaError: if an option cannot be used, or something is not installed.
    """
    from mrta_zoo.eval.demo import run_demo  # here, as `--help` needs nothing of it

    run_demo(command.out, command.policy)
