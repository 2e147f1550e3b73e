"""Optional dependencies: what is missing, and which extra of the package brings it."""

from __future__ import annotations

from importlib.util import find_spec

from mrta_zoo.errors import MissingExtraError

EXTRAS: dict[str, tuple[str, ...]] = {
    "torch": ("torch", "safetensors"),
    "plot": ("matplotlib",),
    "render": ("pygame",),
    "solvers": ("scipy", "numba"),
    "pyvrp": ("pyvrp",),
    "report": ("filelock", "scipy", "statsmodels", "pandas", "jinja2", "matplotlib"),
}
"""Each extra with the modules it brings, in so far as we import them."""


def require(extra: str, what: str) -> None:
    """Make sure that an extra is installed.

    Args:
        extra: one of `EXTRAS`.
        what: what needs it; begins the message.

    Raises:
        MissingExtraError: if it is not; the message names it.
    """
    missing = [module for module in EXTRAS[extra] if find_spec(module) is None]
    if missing:
        raise MissingExtraError(
            f'{what} needs {", ".join(missing)}, not installed here; install it with: pip install "mrta_zoo[{extra}]"'
        )
