"""How a report was made: what it takes to make it again, and to judge its times."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from mrta_zoo import __version__
from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.manifest import Manifest

SCORES = (
    "Every plan was scored by the package’s verifier, which shares no code with the methods or the environment. A "
    "task counts as completed if its work is finished by its deadline."
)


def how_made(
    manifest: Manifest, flags: Mapping[str, Any], machines: Sequence[Machine], more: Iterable[tuple[str, str]] = ()
) -> tuple[tuple[str, str], ...]:
    """Command, version, digests, how plans were scored, what else there is to say, and the machines.

    Args:
        manifest: what the numbers depend on.
        flags: of the command; those that are None were not given.
        machines: on which it was measured.
        more: what is particular to the report.
    """
    given = [f"--{name.replace('_', '-')} {_shown(value)}" for name, value in flags.items() if value is not None]
    return (
        ("Command", " ".join((f"mrta-zoo {manifest.command} --out DIR", *given))),
        ("Version", f"mrta_zoo {__version__}"),
        ("Cases", f"SHA-256 {manifest.cases}"),
        *((f"Weights of {method}", f"SHA-256 {digest}") for method, digest in manifest.weights.items()),
        ("Scores", SCORES),
        *more,
        *((f"Measured {machine.started}", machine.description) for machine in machines),
    )


def busy_note(machines: Sequence[Machine]) -> tuple[str, ...]:
    """A warning if others were at work on the machine; nothing if not."""
    loads = ", ".join(f"{machine.load:g}" for machine in machines if machine.busy)
    if not loads:
        return ()
    return (
        f"Beware: the machine was busy with other work while this was measured (load {loads} at the beginning, "
        f"{machines[0].cores} CPU cores), so times are longer than they would be alone, and not equally so for all "
        "methods. Measure again on a quiet machine before quoting them.",
    )


def _shown(value: object) -> str:
    if isinstance(value, list | tuple):
        return ",".join(map(_shown, value))
    return f"{value:g}" if isinstance(value, float) else str(value)
