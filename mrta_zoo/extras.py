"""Optional dependencies: which are missing or broken, and which extra of the package installs them."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
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
"""The modules that we import from each extra."""
BACKEND = "MPLBACKEND"
"""The environment variable that names matplotlib's backend."""


def require(extra: str, what: str, also: Sequence[str] = ()) -> None:
    """Make sure that an extra is installed and that its modules can be imported.

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
            _import(module)
        except Exception as error:  # whatever a broken installation raises: ImportError, OSError, ValueError, ...
            why = next(iter(str(error).strip().splitlines()), type(error).__name__).rstrip(".")
            raise MissingExtraError(
                f"{what} needs {module}, which is installed here but cannot be imported ({why}); install what fits "
                f'with: pip install --upgrade "mrta_zoo[{extra}]"'
            ) from None


@contextmanager
def importing(extra: str, what: str) -> Iterator[None]:
    """Context in which to import the modules of an extra; matplotlib even if `MPLBACKEND` names an unknown backend.

    Args:
        extra: one of `EXTRAS`.
        what: what needs it; begins the message.

    Raises:
        MissingExtraError: if it is not installed, or cannot be imported.
    """
    require(extra, what)
    yield


def _import(module: str) -> None:
    if module != "matplotlib" or module in sys.modules:
        import_module(module)
        return
    # It fails if the environment names a backend that it does not know. We open no windows and need none.
    backend = os.environ.pop(BACKEND, None)
    try:
        matplotlib = import_module(module)
    finally:
        if backend is not None:
            os.environ[BACKEND] = backend
    if backend:
        with suppress(ValueError):
            matplotlib.rcParams["backend"] = backend
