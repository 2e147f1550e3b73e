"""Numbers as reports write them."""

from __future__ import annotations

from collections.abc import Callable

from mrta_zoo.digits import percentage as percent
from mrta_zoo.eval.significance import LEVEL, TOO_FEW, Estimate

INTERVAL = f"{100 * LEVEL:.0f} % interval"
DASH = "–"


def estimate(value: Estimate, digits: int = 1) -> str:
    """A difference with its interval in brackets, if there is one; all numbers with their signs."""
    return _with_interval(value, lambda each: number(each, digits))


def percentage(value: Estimate) -> str:
    """A mean of percentages with its interval in brackets, if there is one; see `digits.percentage`."""
    return _with_interval(value, lambda each: percent(each).replace("-", "−"))


def number(value: float, digits: int = 1) -> str:
    """A number with its sign, a true minus among them; zero has none."""
    text = f"{value:+.{digits}f}"
    return text.replace("-", "−") if text.strip("+-0.") else text.lstrip("+-")


def contrast(name: str, value: Estimate, significant: bool, digits: int = 1) -> str:
    """What differs, by how much, and whether that is more than chance."""
    return f"{name} {estimate(value, digits)}, {'significant' if significant else 'not significant'}"


def p_value(p: float | None) -> str:
    """A p-value to two significant digits, down to 0.0001."""
    if p is None:
        return DASH
    return "< 0.0001" if p < 1e-4 else f"{p:.2g}" if p < 0.995 else "1"


def seconds(value: float) -> str:
    """A time in the unit that suits it."""
    if value < 0.001:
        return f"{1e6 * value:.3g} µs"
    return f"{1000 * value:.3g} ms" if value < 1 else f"{value:.3g} s"


def _with_interval(value: Estimate, write: Callable[[float], str]) -> str:
    if value.low is None or value.high is None:
        return f"{write(value.mean)} ({TOO_FEW})"
    return f"{write(value.mean)} [{write(value.low)}, {write(value.high)}]"
