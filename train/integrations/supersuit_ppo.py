"""SuperSuit: its wrappers and its vector environment, with SB3's PPO, which cannot mask actions.

It takes the parallel form, flat, and makes each robot a row of a vector environment. An illegal action is replaced by
the next legal one, since PPO would take long to learn what is legal. Each wrapper, as in `wrapped`, makes it slower:
for them SuperSuit turns the environment into the AEC form and back.

Run it with ``python -m mrta_zoo.train.integrations.supersuit_ppo --seed 0``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import supersuit
from stable_baselines3 import PPO
from stable_baselines3.common.utils import set_random_seed

from mrta_zoo import mrta_v0
from mrta_zoo.plan import Plan
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.scenario import Scenario
from mrta_zoo.train.integrations.problem import options, show


def make_env() -> Any:
    """The parallel environment."""
    return mrta_v0.parallel_env(on_illegal="replace", **options("flat"))


def wrapped(steps: int = 2) -> Any:
    """The same environment, padded and flattened, with `steps` steps and the robot's number in each observation."""
    env = supersuit.flatten_v0(supersuit.pad_action_space_v0(supersuit.pad_observations_v0(make_env())))
    return supersuit.agent_indicator_v0(supersuit.frame_stack_v1(env, steps))


class Planner:
    """A trained model that plans in the parallel environment."""

    def __init__(self, model: PPO) -> None:
        self.model = model

    @few_threads()
    def plan(self, scenario: Scenario) -> Plan:
        """The plan that the likeliest actions make."""
        env = make_env()
        observations, _ = env.reset(options={"scenario": scenario})
        while env.agents:
            actions, _ = self.model.predict(np.stack([observations[agent] for agent in env.agents]), deterministic=True)
            observations, *_ = env.step(dict(zip(env.agents, actions.tolist(), strict=True)))
        return Plan(tuple(map(tuple, env.unwrapped.mission.routes)), scenario.name, "supersuit")


def vectorised(env: Any, count: int) -> Any:
    """`count` copies side by side, with a row for every robot of each, as SB3 expects them."""
    envs = supersuit.pettingzoo_env_to_vec_env_v1(env)
    return supersuit.concat_vec_envs_v1(envs, count, num_cpus=1, base_class="stable_baselines3")


@few_threads()
def learn(envs: Any, steps: int, seed: int = 0) -> PPO:
    """SB3's PPO on a vector environment."""
    set_random_seed(seed)  # `PPO(seed=…)` would also seed the environments, in a way that SuperSuit's do not know
    envs.venv.reset(seed=seed)
    model = PPO("MlpPolicy", envs, n_steps=64, batch_size=256, n_epochs=8, gamma=1.0, learning_rate=1e-3, ent_coef=0.01)
    return model.learn(steps)


def train(seed: int = 0, steps: int = 20_000) -> Planner:
    """Train on the small problem.

    Args:
        seed: seeds weights, scenarios and choices.
        steps: of the robots, including those in which they can only wait.
    """
    return Planner(learn(vectorised(make_env(), count=16), steps, seed))


if __name__ == "__main__":
    show(train)
