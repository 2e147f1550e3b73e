"""Stable-Baselines3: sb3-contrib's MaskablePPO, one agent that acts for each robot in its turn.

Run it with ``python -m mrta_zoo.train.integrations.sb3_ppo --seed 0``.
"""

from __future__ import annotations

from typing import Any

from sb3_contrib import MaskablePPO
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv

from mrta_zoo.env.gym_view import ActingRobotEnv
from mrta_zoo.env.settings import ObservationForm
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.train.integrations.problem import options, show


class MaskablePolicy:
    """A trained model in the AEC loop. Implements `Policy`."""

    observation: ObservationForm = "masked"

    def __init__(self, model: MaskablePPO) -> None:
        self.model = model

    @few_threads()
    def act(self, observation: dict[str, Any], agent: str = "") -> int:
        """The likeliest task."""
        action, _ = self.model.predict(observation, deterministic=True, action_masks=observation["action_mask"])
        return int(action)


@few_threads()
def train(seed: int = 0, steps: int = 15_000, copies: int = 8, processes: bool = False) -> MaskablePolicy:
    """Train on the small problem.

    Args:
        seed: seeds weights, scenarios and choices.
        steps: decisions.
        copies: environments side by side.
        processes: whether each has a process of its own.
    """
    envs = make_vec_env(
        ActingRobotEnv,
        n_envs=copies,
        seed=seed,
        env_kwargs=options("masked"),
        vec_env_cls=SubprocVecEnv if processes else DummyVecEnv,
    )
    model = MaskablePPO(
        "MultiInputPolicy", envs, n_steps=128, batch_size=256, gamma=1.0, learning_rate=2e-3, ent_coef=0.01, seed=seed
    )
    model.learn(steps)
    envs.close()
    return MaskablePolicy(model)


if __name__ == "__main__":
    show(train)
