"""The world behind the AEC and the parallel environment: the mission under way, what robots see, and their masks.

Knows robots by index and nothing of turns; `aec.AecMrtaEnv` and `parallel.ParallelMrtaEnv` add PettingZoo's interface.
"""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from mrta_zoo.env.observation import FloatTable, Observer, flat_space, observation_space, state_space
from mrta_zoo.env.rewards import as_rewards
from mrta_zoo.env.settings import Settings
from mrta_zoo.errors import ActionError, ConfigError
from mrta_zoo.mission import Finished, Mission
from mrta_zoo.rules import MaskReason
from mrta_zoo.scenario import Scenario

Info = dict[str, Any]

_CHOOSABLE = np.array(MaskReason.CHOOSABLE, np.int8)  # without dimensions, it is compared fastest


class World:
    """The scenario of an episode and the mission on it.

    Attributes:
        settings: the environment's options, all filled in.
        names: names of the possible agents, ``robot_0`` to ``robot_{max_robots-1}``.
        agents: names of the agents in the current episode: one per robot of the scenario; all with ``absent="noop"``.
        index: robot index of each name.
        action_spaces: for each name ``Discrete(num_actions)``, separate objects so that each has its own seed.
        observation_space: the space of every agent's observations.
        state_space: the space of `state`.
        completed_by_now: number of tasks completed by the clock; `Mission.completed` counts those still under way, too.
    """

    def __init__(self, settings: Settings, num_actions: int) -> None:
        assert settings.max_tasks is not None
        assert settings.max_robots is not None
        n, m = settings.max_tasks, settings.max_robots
        self.settings = settings
        self.max_tasks = n
        self.names = [f"robot_{robot}" for robot in range(m)]
        self.index = {name: robot for robot, name in enumerate(self.names)}
        self.action_spaces = {name: spaces.Discrete(num_actions) for name in self.names}
        self.observation_space = self._space(num_actions)
        self.state_space = state_space(n, m)
        self.agents: list[str] = []
        self.completed_by_now = 0
        self._rng: np.random.Generator | None = None
        self._mission: Mission | None = None
        self._looked_at: Mission | None = None  # since it last changed

    @property
    def mission(self) -> Mission:
        """The mission under way."""
        if self._mission is None:
            raise ActionError("there is no mission yet; call reset() first")
        return self._mission

    def reset(self, seed: int | None, options: dict[str, Any] | None) -> list[float]:
        """Start the next episode and return each agent's reward for it, which is not 0 if it ends at once."""
        scenario = _scenario_option(options)
        if seed is not None:
            self._rng = _seeded(seed)
        elif self._rng is None:
            self._rng = np.random.default_rng()
        if scenario is None:
            scenario = self.settings.draw(self._rng)
        else:
            self.settings.check_fits(scenario)
        self._mission = Mission(scenario, self.settings.mask_rule)
        self._observer = Observer(scenario, self.max_tasks, len(self.names), self.settings.mask_rule)
        self._looked_at = None
        self.agents = self.names[: scenario.num_robots] if self.settings.absent == "omit" else list(self.names)
        self.completed_by_now = 0
        self._decided = [0.0] * len(self.agents)
        self._reasons = np.full((len(self.agents), self.max_tasks), MaskReason.NO_TASK, dtype=np.int8)
        return self._reward([])

    def take(self, robot: int, task: int) -> None:
        """Let a free robot take a task; `advance` moves the clock.

        Raises:
            ActionError: if it may not.
        """
        mission = self.mission
        mission.take(robot, task)
        self._decided[robot] = mission.time

    def advance(self) -> list[float]:
        """Move the clock to the next robot to act and return each agent's reward."""
        finished = self.mission.advance()
        self._looked_at = None
        for event in finished:
            self.completed_by_now += event.completed
        return self._reward(finished)

    def infos(self) -> dict[str, Info]:
        """Fresh infos of every agent, see `mrta_v0`."""
        mission = self.mission
        robots, tasks = mission.reasons.shape
        self._reasons[:robots, :tasks] = mission.reasons
        for robot in range(robots):
            if (known := mission.known(robot)) is not mission:
                self._reasons[robot, :tasks] = known.reasons[robot]
        reasons = self._reasons.copy()
        masks = (reasons == _CHOOSABLE).view(np.int8)
        time, completed = mission.time, self.completed_by_now
        return {
            name: {
                "time": time,
                "elapsed": time - decided,
                "completed": completed,
                "action_mask": mask,
                "mask_reason": reason,
            }
            for name, decided, mask, reason in zip(self.agents, self._decided, masks, reasons, strict=True)
        }

    def retired(self, agent: str) -> bool:
        """Whether an agent's robot is retired; one that the scenario does not have never is."""
        robot, retired = self.index[agent], self.mission.retired
        return robot < len(retired) and retired[robot]

    def mask(self, robot: int) -> npt.NDArray[np.int8]:
        """(max_tasks,) what `robot` may choose when next free; all 0 for one the scenario does not have."""
        mission = self.mission
        if robot >= len(mission.ready):
            return np.zeros(self.max_tasks, dtype=np.int8)
        own = mission.mask(robot).view(np.int8)
        if len(own) == self.max_tasks:
            return own
        mask = np.zeros(self.max_tasks, dtype=np.int8)
        mask[: len(own)] = own
        return mask

    def seen_by(self, robot: int, mask: npt.NDArray[np.int8]) -> Any:
        """What `robot` sees now, in the form that the settings ask for; `mask` goes with it in all but the flat one."""
        known = self.mission.known(robot)
        if known is not self._looked_at:
            self._look(known)
        form = self.settings.observation
        seen = self._observer.tables(robot) if form == "dict" else self._observer.flat(robot)
        return seen if form == "flat" else {"observation": seen, "action_mask": mask}

    def state(self) -> FloatTable:
        """(S,) the global state, made from the whole mission rather than from what one robot knows."""
        self._look(self.mission)
        return self._observer.state()

    def robot(self, agent: str) -> int:
        """Robot index of an agent.

        Raises:
            ActionError: if there can be no agent of that name.
        """
        try:
            return self.index[agent]
        except (KeyError, TypeError):
            raise ActionError(f"there is no agent {agent!r}; they are {self.names[0]} to {self.names[-1]}") from None

    def _space(self, num_actions: int) -> spaces.Space[Any]:
        n, m = self.max_tasks, len(self.names)
        tables, flat = observation_space(n, m, num_actions), flat_space(n, m)
        if self.settings.observation == "masked":
            return spaces.Dict([("observation", flat), ("action_mask", tables["action_mask"])])
        return flat if self.settings.observation == "flat" else tables

    def _look(self, mission: Mission) -> None:
        self._observer.look(mission)
        self._looked_at = mission

    def _reward(self, finished: Sequence[Finished]) -> list[float]:
        reward, robots = self.settings.reward, self.mission.scenario.num_robots
        assert callable(reward)  # a name was replaced at construction
        return as_rewards(reward(self.mission, finished), robots) + [0.0] * (len(self.agents) - robots)


def _scenario_option(options: dict[str, Any] | None) -> Scenario | None:
    """The scenario in the options of `reset`, if there is one."""
    if options is None:
        return None
    if not isinstance(options, Mapping):
        raise ConfigError(f"reset's options is {options!r}; expected a dictionary such as {{'scenario': scenario}}")
    for option in options:
        # PettingZoo's contract tests pass {"options": 1} to every environment, so this key must be let through.
        if option not in ("scenario", "options"):
            raise ConfigError(f"reset has no option {option!r}; it has 'scenario'")
    scenario = options.get("scenario")
    if scenario is not None and not isinstance(scenario, Scenario):
        raise ConfigError(f"reset's option 'scenario' is {scenario!r}; expected a mrta_zoo.Scenario")
    return scenario


def _seeded(seed: int) -> np.random.Generator:
    try:
        number = operator.index(seed)
    except TypeError:
        number = -1
    if number < 0:
        raise ConfigError(f"seed is {seed!r}; expected a whole number >= 0 or None")
    return np.random.default_rng(number)
