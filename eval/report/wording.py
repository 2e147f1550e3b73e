"""Numbers and lists as text."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.digits import percentage as percent
from mrta_zoo.eval.significance import LEAST_OF_STRATUM, LEVEL, TOO_FEW, Estimate

INTERVAL = f"{100 * LEVEL:.0f} % interval"
BOOTSTRAP = (
    f"BCa bootstrap over cases, within each number of robots if it has at least {LEAST_OF_STRATUM} cases everywhere"
)
DASH = "–"


def estimate(value: Estimate, digits: int = 1, signed: bool = False) -> str:
    """A mean with its interval in brackets, if there is one."""
    mean = number(value.mean, digits, signed)
    if value.low is None or value.high is None:
        return f"{mean} ({TOO_FEW})"
    return f"{mean} [{number(value.low, digits, signed)}, {number(value.high, digits, signed)}]"


def percentage(value: Estimate) -> str:
    """A mean of percentages with its interval in brackets, if there is one; see `digits.percentage`."""
    mean, *ends = (None if each is None else percent(each).replace("-", "−")
                   for each in (value.mean, value.low, value.high))  # fmt: skip
    return f"{mean} ({TOO_FEW})" if None in ends else f"{mean} [{', '.join(map(str, ends))}]"


def number(value: float, digits: int = 1, signed: bool = False) -> str:
    """A number with a true minus sign; zero has no sign."""
    text = f"{value:+.{digits}f}" if signed else f"{value:.{digits}f}"
    if not text.strip("+-0."):
        text = text.lstrip("+-")
    return text.replace("-", "−")


def p_value(p: float | None) -> str:
    """A p-value to two significant digits, down to 0.0001."""
    if p is None:
        return DASH
    return "< 0.0001" if p < 1e-4 else f"{p:.2g}" if p < 0.995 else "1"


def equals(p: str) -> str:
    """A p-value as text, behind its sign."""
    return p if p.startswith("<") else f"= {p}"


def seconds(value: float) -> str:
    """A time in the unit that suits it."""
    if value < 0.001:
        return f"{1e6 * value:.3g} µs"
    return f"{1000 * value:.3g} ms" if value < 1 else f"{value:.3g} s"


def listed(items: Sequence[str]) -> str:
    """a, b and c."""
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}"
