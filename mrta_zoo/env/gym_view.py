"""The mission as a single-agent Gymnasium environment: whichever robot is to act, one agent acts for it.

For single-agent libraries (Stable-Baselines3, sb3-contrib's MaskablePPO, Tianshou, CleanRL): one policy shared by all
robots, which sees in each step what the acting robot sees.

>>> from mrta_zoo.env.gym_view import ActingRobotEnv
>>> env = ActingRobotEnv(reward="completion", observation="masked")  # or gymnasium.make("mrta_zoo/mrta-v0", …)
>>> observation, info = env.reset(seed=1)
>>> done = False
>>> while not done:
...     action = env.action_space.sample(env.action_masks().astype("int8"))
...     observation, reward, done, _, info = env.step(action)
"""

from __future__ import annotations

from typing import Any, Unpack, get_args

import gymnasium
import numpy as np
import numpy.typing as npt

from mrta_zoo.actions import next_legal
from mrta_zoo.bounds import as_finite
from mrta_zoo.env.aec import AecMrtaEnv
from mrta_zoo.env.settings import Illegal, Options, one_of, with_options
from mrta_zoo.errors import ActionError, ConfigError, OutOfBoundsError
from mrta_zoo.mission import Mission
from mrta_zoo.show.render import RENDER_FPS, RENDER_MODES

Step = tuple[Any, float, bool, bool, dict[str, Any]]


class ActingRobotEnv(gymnasium.Env[Any, Any]):
    """One agent that acts for each robot when its turn comes. Can be pickled and deep-copied at any moment.

    Observations, actions and infos are the acting robot's, as in `mrta_v0`; infos also hold its index, as ``robot``.
    The reward of a step is the mean of all robots' rewards: with a team reward, what each robot gets. After the last
    step the observation is that of ``robot_0``.

    Once the mission is over, the mask is all 1 in observations, infos and `action_masks` alike. So a masked policy
    always has an action: vector environments ask for one after an episode's end, too, ignore it, and reset.
    If no robot can do anything from the start, any action ends the episode, with the reward of a mission that has
    ended.

    Args:
        on_illegal: what happens on an action that the mask forbids: ``"terminate"`` the episode, ``"raise"`` an error,
            or ``"replace"`` the action by the next that the mask allows, for learners without masking.
        illegal_reward: reward of a step that ends the episode this way.
        **options: see `mrta_zoo.env.settings.Settings`; without ``staggered`` and ``absent``, as there is one agent.

    Raises:
        ConfigError: if an option cannot be used.
    """

    metadata = {"render_modes": list(RENDER_MODES), "render_fps": RENDER_FPS}  # noqa: RUF012  (as in Gymnasium's own class)

    @with_options
    def __init__(
        self, *, on_illegal: Illegal = "terminate", illegal_reward: float = -1.0, **options: Unpack[Options]
    ) -> None:
        one_of("on_illegal", on_illegal, get_args(Illegal))
        self._aec = AecMrtaEnv(**options)
        for option, only in (("staggered", False), ("absent", "omit")):
            if (given := getattr(self._aec.settings, option)) != only:
                raise ConfigError(
                    f"{option} is {given!r}; expected {only!r}, as one agent acts for all robots to the end"
                )
        self.on_illegal = on_illegal
        self.illegal_reward = as_finite("illegal_reward", illegal_reward)
        self.render_mode = self._aec.render_mode
        first = self._aec.possible_agents[0]
        self.observation_space = self._aec.observation_space(first)
        self.action_space = self._aec.action_space(first)
        self._over = True

    @property
    def mission(self) -> Mission:
        """The mission under way."""
        return self._aec.mission

    @property
    def robot(self) -> int:
        """Index of the robot to act; 0 once the mission is over.

        Raises:
            ActionError: before the first reset.
        """
        return max(self.mission.actor, 0)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Start an episode; arguments and errors as in the AEC form."""
        self._aec.reset(seed, options)  # which also checks the seed
        super().reset(seed=None if seed is None else int(seed))
        self._over = False
        return self._seen()

    def step(self, action: Any) -> Step:
        """Let the acting robot take a task.

        Raises:
            ActionError: if `action` is outside the action space, the episode is over, or the mask forbids it and
                `on_illegal` is "raise".
        """
        if self._over:
            raise ActionError(f"the episode is over and takes no action ({action!r}); call reset() first")
        if not self.mission.done:  # else nothing could be done from the start
            try:
                self._aec.step(action)
            except OutOfBoundsError:
                raise
            except ActionError:  # and nothing has changed
                if self.on_illegal == "raise":
                    raise
                if self.on_illegal == "terminate":
                    self._over = True
                    observation, info = self._seen()
                    return observation, self.illegal_reward, True, False, info
                self._aec.step(next_legal(self.action_masks(), int(action)))
        self._over = self.mission.done
        observation, info = self._seen()
        rewards = self._aec.rewards.values()
        return observation, sum(rewards) / len(rewards), self._over, False, info

    def action_masks(self) -> npt.NDArray[np.bool_]:
        """(max_tasks,) bool, true where the acting robot may choose; all true once the mission is over.

        sb3-contrib's MaskablePPO looks for a method of this name, also through vector environments. Observations and
        infos hold the same mask as int8.
        """
        if self.mission.done:
            return np.ones(self._aec.num_actions, dtype=np.bool_)
        return self._aec.mask(self._aec.agent_selection).astype(np.bool_)

    def render(self) -> Any:
        """The mission as text or a picture, by `render_mode`."""
        return self._aec.render()

    def _seen(self) -> tuple[Any, dict[str, Any]]:
        agent = self._aec.agent_selection
        info = {name: np.copy(of) if isinstance(of, np.ndarray) else of for name, of in self._aec.infos[agent].items()}
        observation = self._aec.observe(agent)
        if self.mission.done:
            info["action_mask"] = self.action_masks().astype(np.int8)
            if isinstance(observation, dict):
                observation["action_mask"] = self.action_masks().astype(np.int8)
        return observation, {**info, "robot": self.robot}
