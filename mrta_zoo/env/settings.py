"""The options of the environment, checked when it is made."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict, TypeVar, cast, get_args, get_type_hints

import numpy as np

from mrta_zoo.env.rewards import Reward, RewardName, make_reward
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import GENERATORS, DrawFunction, TaptcGenerator, draw_scenario, make_generator
from mrta_zoo.rules import MaskRule, check_mask_rule
from mrta_zoo.scenario import Scenario

ObservationForm = Literal["dict", "masked", "flat"]
RenderMode = Literal["ansi", "human", "rgb_array"]
Illegal = Literal["terminate", "raise", "replace"]
Absent = Literal["omit", "noop"]

DEFAULT_MAX_TASKS, DEFAULT_MAX_ROBOTS = 100, 7

Maker = TypeVar("Maker", bound=Callable[..., Any])


class Options(TypedDict, total=False):
    """The keyword arguments of the environment, for type checkers; `Settings` says what they mean."""

    scenario: Scenario | None
    generator: DrawFunction | str | None
    max_tasks: int | None
    max_robots: int | None
    mask_rule: MaskRule
    reward: RewardName | Reward
    observation: ObservationForm
    render_mode: RenderMode | None


class TeamOptions(Options, total=False):
    """The keyword arguments of the forms in which each robot is an agent."""

    staggered: bool
    absent: Absent


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """How to make an environment; the same for the AEC and the parallel form.

    Attributes:
        scenario: the scenario of every episode, unless `reset` is given another; None to draw one each time.
        generator: draws the scenario of an episode with the environment's random generator, if `scenario` is None:
            a callable or a name from `generators.GENERATORS`. Default: ``TaptcGenerator()``.
        max_tasks: room for tasks, >= 1: the number of actions and of task rows. Default: as many as the scenario
            has, or as the generator can draw if it says so (an attribute ``tasks = (least, most)``), else 100.
        max_robots: room for robots, >= 1: the number of possible agents. Default likewise, else 7.
        mask_rule: which untaken tasks a robot may choose, see `rules.MaskRule`.
        reward: what the robots are rewarded for, a name or a function, see `rewards`.
        observation: ``"dict"`` of tables with the mask, ``"masked"``: one vector with the mask, or ``"flat"``: the
            vector alone, the mask in ``infos``.
        render_mode: what `render` gives: None, ``"ansi"`` (text), ``"rgb_array"`` (a picture), or ``"human"`` (shows
            the picture in a window at each step); the last two need ``mrta_zoo[render]``.
        staggered: whether a robot terminates as soon as it retires, instead of all together at the end.
        absent: what to do with possible agents that the scenario has no robot for: ``"omit"`` them, or ``"noop"``: keep
            them to the end with nothing to choose and reward 0, for libraries that want the same agents in every
            episode.

    Raises:
        ConfigError: if an option cannot be used.
    """

    scenario: Scenario | None = None
    generator: DrawFunction | str | None = None
    max_tasks: int | None = None
    max_robots: int | None = None
    mask_rule: MaskRule = "feasible"
    reward: RewardName | Reward = "terminal"
    observation: ObservationForm = "dict"
    render_mode: RenderMode | None = None
    staggered: bool = False
    absent: Absent = "omit"

    def __post_init__(self) -> None:
        if self.scenario is not None and not isinstance(self.scenario, Scenario):
            raise ConfigError(f"scenario is {_short(self.scenario)}; expected a mrta_zoo.Scenario or None")
        if self.scenario is not None and self.generator is not None:
            raise ConfigError("both a scenario and a generator are given; expected one of them")
        object.__setattr__(self, "generator", _make_generator(self.generator))
        for field, default in (("max_tasks", DEFAULT_MAX_TASKS), ("max_robots", DEFAULT_MAX_ROBOTS)):
            given = getattr(self, field)
            room = self._natural_room(field, default) if given is None else _count(field, given)
            object.__setattr__(self, field, room)
        check_mask_rule(self.mask_rule)
        object.__setattr__(self, "reward", make_reward(self.reward))
        one_of("observation", self.observation, get_args(ObservationForm))
        one_of("absent", self.absent, get_args(Absent))
        if self.render_mode is not None:
            one_of("render_mode", self.render_mode, get_args(RenderMode))
        if not isinstance(self.staggered, bool):
            raise ConfigError(f"staggered is {_short(self.staggered)}; expected True or False")
        if self.scenario is not None:
            self.check_fits(self.scenario)

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Settings:
        """Settings from keyword arguments.

        Raises:
            ConfigError: if one is misspelt or cannot be used.
        """
        check_options(options, [field.name for field in dataclasses.fields(cls)])
        return cls(**options)

    def draw(self, rng: np.random.Generator) -> Scenario:
        """The fixed scenario, or one from the generator.

        Raises:
            ConfigError: if the generator returns anything but a scenario, or may draw one that does not fit.
        """
        if self.scenario is not None:
            return self.scenario
        for what, room in (("tasks", self.max_tasks), ("robots", self.max_robots)):
            most = _most(self.generator, what)
            if most is not None and room is not None and most > room:  # now, not in some later episode
                raise ConfigError(
                    f"the generator draws up to {most} {what}, but this environment has room for {room}; "
                    f"make it with max_{what}={most} or more, or pass another generator"
                )
        assert callable(self.generator)  # a name was replaced at construction
        return self.check_fits(draw_scenario(self.generator, rng))

    def check_fits(self, scenario: Scenario) -> Scenario:
        """The scenario, if there is room for it.

        Raises:
            ConfigError: if it has more tasks or robots than there is room for.
        """
        for what, has, room in (
            ("tasks", scenario.num_tasks, self.max_tasks),
            ("robots", scenario.num_robots, self.max_robots),
        ):
            if room is not None and has > room:
                raise ConfigError(
                    f"scenario {scenario.name!r} has {has} {what}, but this environment has room for {room}; "
                    f"make it with max_{what}={has} or more"
                )
        return scenario

    def _natural_room(self, field: str, default: int) -> int:
        what = field.removeprefix("max_")
        if self.scenario is not None:
            return self.scenario.num_tasks if what == "tasks" else self.scenario.num_robots
        return _most(self.generator, what) or default


def with_options(make: Maker) -> Maker:
    """Show `help`, notebooks and editors what `make` takes as ``**options: Unpack[Options]``, and check the names.

    Their names and types are those of `Options` (or `TeamOptions`), their defaults those of `Settings`.
    """
    signature = inspect.signature(make, eval_str=True)
    *own, options = signature.parameters.values()
    defaults = inspect.signature(Settings).parameters
    shared = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=defaults[name].default, annotation=kind)
        for name, kind in get_type_hints(get_args(options.annotation)[0]).items()
    ]
    parameters = sorted(shared + own, key=lambda parameter: parameter.kind)  # `self` first, the form's own last
    names = [parameter.name for parameter in parameters if parameter.kind is inspect.Parameter.KEYWORD_ONLY]

    @functools.wraps(make)
    def made(*arguments: Any, **options: Any) -> Any:
        check_options(options.keys() - defaults.keys(), names)  # the form itself says why it lacks some of these
        return make(*arguments, **options)

    made.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    return cast(Maker, made)


def check_options(options: Iterable[str], names: Sequence[str]) -> None:
    """Check the names of options.

    Raises:
        ConfigError: if there is no option of a name.
    """
    for option in options:
        if option not in names:
            raise ConfigError(f"there is no option {option!r}; the environment has {', '.join(names)}")


def one_of(field: str, value: object, allowed: tuple[str, ...]) -> None:
    """Check an option that is one of a few words.

    Raises:
        ConfigError: if it is not.
    """
    if not isinstance(value, str) or value not in allowed:
        raise ConfigError(f"{field} is {_short(value)}; expected one of {', '.join(allowed)}")


def _make_generator(generator: DrawFunction | str | None) -> DrawFunction:
    if generator is None:
        return TaptcGenerator()
    if isinstance(generator, str):
        return make_generator(generator)
    if not callable(generator) or isinstance(generator, type):
        raise ConfigError(
            f"generator is {_short(generator)}; expected a function of a NumPy generator, or one of "
            f"{', '.join(GENERATORS)}"
        )
    return generator


def _most(generator: object, what: str) -> int | None:
    """The most tasks or robots that a generator can draw, if it says so."""
    parts = getattr(generator, "generators", None)
    if isinstance(parts, tuple) and parts:
        most = [_most(part, what) for part in parts]
        return None if None in most else max(number for number in most if number is not None)
    bounds = getattr(generator, what, None)
    if isinstance(bounds, tuple) and len(bounds) == 2 and isinstance(bounds[1], int):
        return bounds[1]
    return None


def _count(field: str, value: object) -> int:
    try:
        count = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        count = 0
    if count < 1 or isinstance(value, bool):
        raise ConfigError(f"{field} is {_short(value)}; expected a whole number >= 1")
    return count


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."
