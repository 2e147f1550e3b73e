"""Optional dependencies: what is missing or broken, and which extra of the package brings it."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
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


def require(extra: str, what: str, also: Sequence[str] = ()) -> None:
    """Make sure that an extra is installed, and that what it brings can be imported.

    Args:
        extra: one of `EXTRAS`.
        what: what needs it; begins the message.
        also: modules needed besides those that `EXTRAS` lists.

    Raises:
        MissingExtraError: if it is not; the message names it.
    """
    modules = (*EXTRAS[extra], *also)
    missing = [module for module in modules if find_spec(module) is None]
    if missing:
        raise MissingExtraError(
            f'{what} needs {", ".join(missing)}, not installed here; install it with: pip install "mrta_zoo[{extra}]"'
        )
    for module in modules:
        try:
            import_module(module)
        except Exception as error:  # whatever a broken installation raises: ImportError, OSError, ValueError, ...
            why = next(iter(str(error).strip().splitlines()), type(error).__name__).rstrip(".")
            raise MissingExtraError(
                f"{what} needs {module}, which is installed here but cannot be imported ({why}); install what fits "
                f'with: pip install --upgrade "mrta_zoo[{extra}]"'
            ) from None
