"""Registration of the environments with Gymnasium and, where it has a registry (1.27 and later), PettingZoo."""

from __future__ import annotations

NAME = "mrta_zoo/mrta-v0"
PETTINGZOO = {"aec": "mrta_zoo.mrta_v0:env", "parallel": "mrta_zoo.mrta_v0:parallel_env"}
GYMNASIUM = "mrta_zoo.env.gym_view:ActingRobotEnv"


def register() -> None:
    """Register what is not registered yet: registering twice would warn. Environments are imported when made."""
    try:
        import gymnasium
        import pettingzoo
    except OSError:  # PettingZoo asks for the current folder, which may have been deleted
        return
    if NAME not in gymnasium.registry:
        gymnasium.register(NAME, entry_point=GYMNASIUM)
    if not hasattr(pettingzoo, "register"):
        return
    for form, entry_point in PETTINGZOO.items():
        if NAME not in getattr(pettingzoo, f"{form}_registry"):
            pettingzoo.register(form, NAME, entry_point=entry_point)
