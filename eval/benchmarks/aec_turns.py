"""AEC turns a second, beside PettingZoo's tic-tac-toe in the same run.

Protocol: both environments in their standard wrappers, Dict observations, random legal actions picked in the same
way, one process. Rounds of the two alternate and the best of each counts, so that other load on the machine hurts
both alike; the ratio is what to compare between machines.

    python -m mrta_zoo.eval.benchmarks.aec_turns
"""

from __future__ import annotations

import os
import time
from typing import Any

import numpy as np
import tyro

from mrta_zoo import mrta_v0
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import TaptcGenerator


def turns_per_second(env: Any, turns: int, rng: np.random.Generator) -> float:
    """Play whole episodes of random legal actions until `turns` live turns are done."""
    done = 0
    draws = rng.random(turns + 1000).tolist()
    start = time.perf_counter()
    while done < turns:
        env.reset(seed=done)
        for _ in env.agent_iter():
            observation, _, terminated, truncated, _ = env.last()
            if terminated or truncated:
                env.step(None)
                continue
            legal = observation["action_mask"].nonzero()[0]
            env.step(int(legal[int(draws[done] * len(legal))]))
            done += 1
    return done / (time.perf_counter() - start)


def measure(turns: int, rounds: int) -> dict[str, float]:
    """Best of some rounds for each environment, and their ratio."""
    scenario = TaptcGenerator(tasks=(100, 100), robots=(7, 7))(np.random.default_rng(0))
    envs: dict[str, Any] = {
        "mrta_v0": mrta_v0.env(scenario=scenario),
        "mrta_v0 raw": mrta_v0.raw_env(scenario=scenario),
    }
    try:
        from pettingzoo.classic import tictactoe_v3  # needs pygame

        envs["tictactoe_v3"] = tictactoe_v3.env()
    except ImportError:
        print("tictactoe_v3 is not there; for the comparison: pip install 'pettingzoo[classic]'")
    best = dict.fromkeys(envs, 0.0)
    rng = np.random.default_rng(1)
    for _ in range(rounds):
        for name, env in envs.items():
            best[name] = max(best[name], turns_per_second(env, turns, rng))
    if "tictactoe_v3" in best:
        best["ratio"] = best["mrta_v0"] / best["tictactoe_v3"]
    return best


def main(turns: int = 5000, rounds: int = 5) -> None:
    """AEC turns a second, beside PettingZoo's tic-tac-toe in the same run.

    Args:
        turns: in a round.
        rounds: of which the best counts.

    Raises:
        ConfigError: if there is not one of each.
    """
    for name, value in {"turns": turns, "rounds": rounds}.items():
        if value < 1:
            raise ConfigError(f"{name} is {value}; expected a whole number >= 1")
    load = os.getloadavg()[0]
    for name, best in measure(turns, rounds).items():
        print(f"{name:>14}  {best:10.2f}" + ("" if name == "ratio" else " turns/s"))
    print(f"100 tasks, 7 robots; load average at the start {load:.2f}")


if __name__ == "__main__":
    tyro.cli(main, prog="python -m mrta_zoo.eval.benchmarks.aec_turns")
