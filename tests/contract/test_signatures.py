"""Every form shows its options by name, type and default."""

from __future__ import annotations

import dataclasses
import inspect
import pydoc
from typing import Any, Literal, get_type_hints

import pytest
from factories import small_scenario

from mrta_zoo import mrta_v0
from mrta_zoo.env import settings
from mrta_zoo.env.gym_view import ActingRobotEnv
from mrta_zoo.env.settings import Options, Settings, TeamOptions
from mrta_zoo.errors import ConfigError

SHARED = [
    "scenario", "generator", "max_tasks", "max_robots", "mask_rule", "reward", "observation", "render_mode",
]  # fmt: skip
TEAM = [*SHARED, "staggered", "absent"]
SIGNATURES = [
    (mrta_v0.raw_env, TEAM),
    (mrta_v0.env, [*TEAM, "illegal_reward"]),
    (mrta_v0.parallel_env, [*TEAM, "on_illegal", "illegal_reward"]),
    (ActingRobotEnv, [*SHARED, "on_illegal", "illegal_reward"]),
]


@pytest.mark.parametrize(("make", "names"), SIGNATURES)
def test_signature(make: Any, names: list[str]) -> None:
    parameters = inspect.signature(make).parameters
    assert list(parameters) == names
    assert {parameter.kind for parameter in parameters.values()} == {inspect.Parameter.KEYWORD_ONLY}
    assert parameters["mask_rule"].annotation == Literal["feasible", "active", "unvisited"]
    assert parameters["mask_rule"].default == "feasible"
    assert parameters["max_tasks"].annotation == int | None
    assert parameters["reward"].default == "terminal"
    if "illegal_reward" in parameters:
        assert (parameters["illegal_reward"].annotation, parameters["illegal_reward"].default) == (float, -1.0)
    if "on_illegal" in parameters:
        assert parameters["on_illegal"].annotation == Literal["terminate", "raise", "replace"]


@pytest.mark.parametrize(("make", "names"), SIGNATURES)
def test_help(make: Any, names: list[str]) -> None:
    page = pydoc.plain(pydoc.render_doc(make))
    for name in names:
        assert f"{name}: " in page
    assert "observation: Literal['dict', 'masked', 'flat'] = 'dict'" in page


@pytest.mark.parametrize(("make", "names"), SIGNATURES)
def test_every_option_can_be_given_and_the_defaults_are_those_shown(make: Any, names: list[str]) -> None:
    given = {name: parameter.default for name, parameter in inspect.signature(make).parameters.items()}
    given |= {"scenario": small_scenario(0)}
    env, expected = make(**given), make(scenario=small_scenario(0))
    inner, other = (getattr(one, "_aec", one).unwrapped.settings for one in (env, expected))
    assert dataclasses.replace(inner, scenario=None, generator=None) == dataclasses.replace(
        other, scenario=None, generator=None
    )
    assert given.keys() == set(names)


def test_what_type_checkers_read_are_the_settings() -> None:
    assert get_type_hints(TeamOptions) == get_type_hints(Settings)
    assert list(get_type_hints(Options)) == SHARED
    assert all(field.default is not dataclasses.MISSING for field in dataclasses.fields(Settings))
    assert all(f"\n        {name}: " in str(settings.Settings.__doc__) for name in TEAM)


@pytest.mark.parametrize(
    ("make", "named", "unnamed"),
    [
        (mrta_v0.env, "illegal_reward", "on_illegal"),
        (mrta_v0.raw_env, "staggered", "illegal_reward"),
        (mrta_v0.parallel_env, "on_illegal", "nothing"),
        (ActingRobotEnv, "on_illegal", "staggered"),
    ],
)
def test_a_misspelt_option_is_answered_by_those_of_this_form(make: Any, named: str, unnamed: str) -> None:
    with pytest.raises(ConfigError, match=f"there is no option 'rewards'; the environment has .*{named}") as caught:
        make(rewards="completion")
    assert unnamed not in str(caught.value)
