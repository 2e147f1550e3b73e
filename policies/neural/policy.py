"""A trained network as a policy in the AEC loop, and as a solver of whole missions."""

from __future__ import annotations

import copy
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
import numpy.typing as npt
import torch

from mrta_zoo.actions import must_wait, noop, split_mask
from mrta_zoo.env.observation import MISSION_FEATURES, TASK_FEATURES, Observation
from mrta_zoo.errors import ConfigError
from mrta_zoo.io.paths import check_no_url, suffix_of
from mrta_zoo.io.text_files import check_name
from mrta_zoo.plan import Plan
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.decoding import Decoding, best_plan
from mrta_zoo.policies.neural.policy_files import SUFFIX, weights_file
from mrta_zoo.policies.neural.rollout import NOT_FINITE, roll_out
from mrta_zoo.policies.neural.sharing import IndependentNetworks, Network
from mrta_zoo.policies.neural.weights import PolicyInfo, load_weights
from mrta_zoo.policies.options import Decode, SolverOptions
from mrta_zoo.policies.pretrained import pretrained_names, pretrained_path
from mrta_zoo.policies.stop import OutOfTimeError, TimeLimit
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.scenario_batch import ScenarioBatch

UNCHANGING_TASK = [TASK_FEATURES.index(name) for name in ("x", "y", "deadline", "workload")]
UNCHANGING_MISSION = [MISSION_FEATURES.index(name) for name in ("crossing_ratio", "work_ratio")]


@dataclass(frozen=True, slots=True)
class Preferences:
    """What a policy would do at one observation, and how likely each task is."""

    action: int
    """The task that it takes."""
    log_prob: float
    """Log-probability of that action."""
    probabilities: npt.NDArray[np.float32]
    """(max_tasks,) probability of each task; 0 where masked."""


class NeuralPolicy:
    """Decides for every robot, with one network or several (`neural.sharing`). Implements `Policy` and `Solver`.

    Args:
        network: scores the tasks.
        info: description of the network.
        name: method name stored in plans.
        decode: how `act` chooses: drawn from the probabilities ("sample"), or the likeliest task (anything else).
        seed: seeds the draws.
    """

    def __init__(
        self,
        network: Network,
        info: PolicyInfo,
        name: str = "capam",
        decode: Decode = "greedy",
        seed: int = 0,
    ) -> None:
        _check_decode(decode)
        self.network = network.eval()
        self.info = info
        self.name = name
        self.decode = decode
        self._generator = torch.Generator().manual_seed(seed)
        self._encoded_for: object = None
        self._encoding: Any = None
        self._of_agent: dict[str, NeuralPolicy] = {}

    def for_agent(self, agent: str) -> NeuralPolicy:
        """The policy that decides for one robot, the same object at each call.

        Independent networks give a policy with that robot's network alone, whichever robot observes. A
        shared policy is this one; so is one by capacity, which reads in each observation what kind of robot acts.

        Raises:
            ConfigError: if `agent` is no robot's name, or there is no network for it.
        """
        number = str(agent).removeprefix("robot_")
        if number == agent or not re.fullmatch("0|[1-9][0-9]{0,8}", number):
            raise ConfigError(f"there is no agent {agent!r}; expected robot_0, robot_1, …")
        if not isinstance(self.network, IndependentNetworks):
            return self
        if agent not in self._of_agent:
            alone = replace(self.info, sharing="shared", robots=1)
            policy = NeuralPolicy(self.network.of_robot(int(number)), alone, self.name, self.decode)
            policy._generator = self._generator  # one stream of draws, however many robots
            self._of_agent[agent] = policy
        return self._of_agent[agent]

    @property
    def memoryless(self) -> bool:
        """Whether its choices depend on the observation alone, and not on earlier calls."""
        return self.decode != "sample"

    def fork(self) -> NeuralPolicy:
        """A copy that goes on as this policy would, with random draws of its own, on the same network."""
        twin = copy.copy(self)
        twin._of_agent = {}
        twin._generator = torch.Generator()
        twin._generator.set_state(self._generator.get_state())
        return twin

    def act(self, observation: Observation, agent: str = "") -> int:
        """The task to take. `agent` is not needed: the observation says whose it is."""
        return self.decide(observation).action

    @few_threads()
    @torch.inference_mode()
    def decide(self, observation: Observation) -> Preferences:
        """The task to take, with probabilities. The encoder runs only when the tasks differ from the last call's.

        In the parallel form a robot that is not free takes the no-op.

        Raises:
            ConfigError: if the observation leaves nothing to choose, or is a vector.
        """
        if not (isinstance(observation, dict) and isinstance(observation["observation"], dict)):
            raise ConfigError('a policy reads Dict observations; make the environment with observation="dict"')
        seen, mask = observation["observation"], observation["action_mask"]
        tasks = len(seen["tasks"])
        if must_wait(mask, tasks):
            return Preferences(noop(tasks), 0.0, np.zeros(tasks, dtype=np.float32))
        mask, _ = split_mask(mask, tasks)
        observation = {**observation, "action_mask": mask}
        if not mask.any():
            raise ConfigError("this robot has nothing to choose; a policy acts only when its robot's turn comes")
        unchanging = (
            seen["tasks"][:, UNCHANGING_TASK].tobytes(),
            seen["mission"][UNCHANGING_MISSION].tobytes(),
            sum(parameter._version for parameter in self.network.parameters()),  # the network may be in training
        )
        if unchanging != self._encoded_for:
            self._encoding = self.network.encode(Tasks.of_observations([observation]))
            self._encoded_for = unchanging
        log_probs = self.network(self._encoding, DecisionStates.of_observations([observation]))[0, 0]
        if torch.isnan(log_probs).any():
            raise ConfigError(NOT_FINITE)
        if self.decode == "sample":
            action = int(torch.multinomial(log_probs.exp(), 1, generator=self._generator))
        else:
            action = int(log_probs.argmax())
        return Preferences(action, float(log_probs[action]), log_probs.exp().numpy())

    def solve(
        self,
        scenario: Scenario,
        *,
        decode: Decode = "greedy",
        samples: int | None = None,
        budget: float | None = None,
        mask_rule: MaskRule | None = None,
        seed: int = 0,
    ) -> Plan:
        """A plan for the whole mission.

        Args:
            scenario: what to plan.
            decode: "greedy", one pass; "sample", the best of `samples` drawn missions and the greedy one; "augment",
                the best of 8 greedy ones, the map seen in each of its symmetries; "beam", the best that a beam search
                of width `samples` finishes, and the greedy one.
            samples: missions drawn in one go, or the width of the beam; by default `options.DEFAULT_SAMPLES`.
            budget: seconds to search for instead of stopping after one go: "sample" goes on drawing, "augment" draws
                missions with the map seen in each symmetry, "beam" starts again with twice the width. The first
                greedy mission is finished even if it takes longer.
            mask_rule: what robots may choose; by default what the policy was trained under.
            seed: seeds the draws.

        Raises:
            ConfigError: if an option is out of range.
        """
        options = SolverOptions(decode=decode, samples=samples, budget=budget, mask_rule=mask_rule, seed=seed)
        return self.solve_with(scenario, options)

    def solve_with(self, scenario: Scenario, options: SolverOptions) -> Plan:
        """As `solve`, with the options in one object."""
        limit = None if options.budget is None else TimeLimit.of(options.budget)
        return self._plan(scenario, options, limit, must_plan=True)

    def solve_within(self, scenario: Scenario, limit: TimeLimit, options: SolverOptions | None = None) -> Plan | None:
        """As `solve`, but None if not even the greedy mission is finished in time.

        Args:
            scenario: what to plan.
            limit: counts instead of the budget of `options`.
            options: how to plan; by default greedily.
        """
        try:
            return self._plan(scenario, options or SolverOptions(), limit, must_plan=False)
        except OutOfTimeError:
            return None

    @few_threads()
    def _plan(self, scenario: Scenario, options: SolverOptions, limit: TimeLimit | None, must_plan: bool) -> Plan:
        how = Decoding(
            decode=options.decode or "greedy",
            samples=options.samples,
            limit=limit,
            must_plan=must_plan,
            mask_rule=options.mask_rule or self.info.mask_rule,
            seed=options.seed,
        )
        return Plan(best_plan(self.network, scenario, how).routes, scenario.name, self.name)

    @few_threads()
    def solve_batch(self, scenarios: Sequence[Scenario], mask_rule: MaskRule | None = None) -> list[Plan]:
        """Greedy plans for many missions at once, faster than one by one."""
        rule: MaskRule = mask_rule or self.info.mask_rule
        rollout = roll_out(self.network, ScenarioBatch.of(scenarios, mask_rule=rule), mask_rule=rule, keep_plans=True)
        return [
            Plan(plan.routes, scenario.name, self.name) for plan, scenario in zip(rollout.plans, scenarios, strict=True)
        ]


def load_policy(name_or_path: str | Path, decode: Decode = "greedy", seed: int = 0) -> NeuralPolicy:
    """A policy that ships with the package, by name, or one from a file or a training run's folder.

    Args:
        name_or_path: such as "capam", "runs/mine" or "runs/mine/policy.safetensors".
        decode: how `NeuralPolicy.act` chooses.
        seed: seeds its draws.

    Raises:
        ConfigError: if there is no such policy, or its files are damaged.
    """
    check_no_url(name_or_path, ConfigError)
    path = Path(name_or_path)
    if str(name_or_path) in pretrained_names():
        path, name = pretrained_path(str(name_or_path)), str(name_or_path)
    elif os.path.isdir(path):  # unlike Path.is_dir it is also False for a name that no folder can have
        path, name = weights_file(path), path.name
    elif suffix_of(path) == SUFFIX:
        name = path.stem
    else:
        raise ConfigError(
            f"there is no policy {str(name_or_path)!r}; expected one of {', '.join(pretrained_names())}, "
            "a .safetensors file, or the folder of a training run"
        )
    check_name(name, str(path), "the policy's name", ConfigError)  # stored in its plans as their method
    network, info = load_weights(path)
    return NeuralPolicy(network, info, name, decode, seed)


def _check_decode(decode: str) -> None:
    if decode not in get_args(Decode):
        raise ConfigError(f"decode is {decode!r}; expected one of {', '.join(get_args(Decode))}")
