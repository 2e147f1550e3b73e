"""Initial weights that come from another policy."""

from __future__ import annotations

from pathlib import Path

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.policy import load_policy
from mrta_zoo.policies.neural.sharing import Network
from mrta_zoo.policies.neural.weights import load_state
from mrta_zoo.train.config import TrainConfig


def load_initial(network: Network, config: TrainConfig) -> None:
    """Put the weights of the policy `config.initial` into the run's network.

    Raises:
        ConfigError: if there is no such policy, or its architecture or sharing differs.
    """
    initial, policy = config.initial, load_policy(config.initial)
    info = policy.info
    differences = info.network.differences(config.network)
    if info.sharing != config.sharing:
        differences = {"sharing": (info.sharing, config.sharing), **differences}
    if differences:
        listed = ", ".join(f"{name} {theirs} (the run: {mine})" for name, (theirs, mine) in differences.items())
        raise ConfigError(f"initial is {initial!r}, which has {listed}; expected a policy like the run's")
    if info.sharing == "by-capacity" and info.kinds != config.kinds:
        raise ConfigError(f"initial is {initial!r}, for kinds {info.kinds}; the run is for kinds {config.kinds}")
    load_state(network, dict(policy.network.state_dict()), Path(initial))
