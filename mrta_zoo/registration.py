"""Enters the environments into PettingZoo's registry, where its version has one (1.27 and later)."""

from __future__ import annotations

ENVIRONMENTS = {
    "aec": ("mrta_zoo/mrta-v0", "mrta_zoo.mrta_v0:env"),
    "parallel": ("mrta_zoo/mrta-v0", "mrta_zoo.mrta_v0:parallel_env"),
}


def register() -> None:
    """Register what is not registered yet: doing it twice would warn. Entry points are imported when made.

    Without PettingZoo, as on a machine that only trains, there is nothing to do.
    """
    try:
        import pettingzoo
    except ImportError:
        return
    if not hasattr(pettingzoo, "register"):
        return
    for form, (name, entry_point) in ENVIRONMENTS.items():
        if name not in getattr(pettingzoo, f"{form}_registry"):
            pettingzoo.register(form, name, entry_point=entry_point)
