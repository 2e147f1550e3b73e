"""Methods by name."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from installed import skip_unless_installed
from strategies import seeded_scenarios

from mrta_zoo import extras
from mrta_zoo.errors import ConfigError, MissingExtraError
from mrta_zoo.policies import pretrained
from mrta_zoo.policies.options import SolverOptions
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import METHODS, make_solver, method_names
from mrta_zoo.verify import verify


@pytest.mark.parametrize("name", METHODS)
def test_every_method_plans_and_signs(name: str) -> None:
    skip_unless_installed(name)
    solver = make_solver(name, seed=3)
    assert isinstance(solver, Solver)
    for scenario in seeded_scenarios(1, 10, max_tasks=8):
        plan = solver.solve(scenario)
        assert (plan.scenario, plan.method) == (scenario.name, name)
        assert verify(scenario, plan) == verify(scenario, solver.solve(scenario))


@pytest.mark.parametrize("name", [name for name, method in METHODS.items() if method.extra])
def test_a_method_says_which_extra_it_needs(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(
        MissingExtraError, match=rf'method {name!r} needs .*pip install "mrta_zoo\[{METHODS[name].extra}\]"'
    ):
        make_solver(name)


def test_a_case_has_the_same_plan_in_any_company() -> None:
    first, second = seeded_scenarios(4, 2)
    in_company = make_solver("random", seed=5)
    in_company.solve(first)
    assert in_company.solve(second) == make_solver("random", seed=5).solve(second)


def test_the_mask_rule_reaches_the_environment() -> None:
    scenario = seeded_scenarios(2, 1)[0]
    everything = make_solver("nearest", mask_rule="unvisited").solve(scenario)
    assert sum(map(len, everything.routes)) == scenario.num_tasks


def test_an_unknown_name_lists_what_there_is() -> None:
    with pytest.raises(ConfigError, match=r"no method 'neerest'; expected one of random, nearest, edf"):
        make_solver("neerest")
    with pytest.raises(ConfigError, match="no method ''"):
        make_solver("")


def test_shipped_policies_are_methods() -> None:
    folder = Path(pretrained.__file__).parent.parent / "pretrained"
    shipped = sorted(path.stem for path in folder.glob("*.safetensors"))
    assert method_names() == [*METHODS, *shipped]


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({"seed": -1}, "seed is -1"),
        ({"decode": "beams"}, "decode is 'beams'; expected one of greedy, sample, augment, beam"),
        ({"samples": 0}, "samples is 0"),
        ({"budget": 0.0}, "budget is 0; expected a number of seconds > 0"),
        ({"budget": float("nan")}, "budget is nan"),
        ({"mask_rule": "any"}, "mask_rule is 'any'"),
        ({"threads": 0}, "threads is 0; expected a whole number from 1 to"),
    ],
)
def test_bad_options(options: dict[str, object], complaint: str) -> None:
    with pytest.raises(ConfigError, match=complaint):
        make_solver("nearest", **options)  # type: ignore[arg-type]


def test_decode_follows_the_budget_unless_given() -> None:
    assert SolverOptions().decode == "greedy"
    assert SolverOptions(budget=1.0).decode == "sample"
    assert SolverOptions(budget=1.0, decode="greedy").decode == "greedy"


def test_learned_methods_say_which_extra_they_need(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r'needs torch.*pip install "mrta_zoo\[torch\]"'):
        make_solver(str(tmp_path / "policy.safetensors"))


def test_a_trained_policy_by_file_and_by_folder(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    from mrta_zoo.policies.neural.capam.config import NetworkConfig
    from mrta_zoo.policies.neural.sharing import build_network
    from mrta_zoo.policies.neural.weights import PolicyInfo, save_policy

    config = NetworkConfig(embedding=16, heads=2)
    save_policy(tmp_path / "policy.safetensors", build_network(config, "shared", 1, seed=0), PolicyInfo(network=config))
    scenario = seeded_scenarios(6, 1)[0]
    by_folder = make_solver(str(tmp_path))
    plan = by_folder.solve(scenario)
    assert verify(scenario, plan) == verify(scenario, make_solver(str(tmp_path / "policy.safetensors")).solve(scenario))
    by_folder.warm_up(scenario)  # type: ignore[attr-defined]
    sampled = make_solver(str(tmp_path), decode="sample", samples=4).solve(scenario)
    assert verify(scenario, sampled).completed >= verify(scenario, plan).completed


def test_a_folder_without_a_policy_is_an_error(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    with pytest.raises(ConfigError, match="no such file"):
        make_solver(str(tmp_path))


def test_importing_it_imports_nothing_heavy() -> None:
    heavy = {"torch", *(module for modules in extras.EXTRAS.values() for module in modules)}
    code = f"import sys, mrta_zoo.policies.registry as r; r.make_solver('edf'); assert not {heavy} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_a_name_that_no_folder_can_have() -> None:
    with pytest.raises(ConfigError, match="there is no method 'xxx"):
        make_solver("x" * 300)


def test_seeds_have_a_greatest() -> None:
    SolverOptions(seed=2**63 - 1)
    with pytest.raises(
        ConfigError, match="seed is 9223372036854775808; expected a whole number from 0 to 9223372036854"
    ):
        SolverOptions(seed=2**63)


def test_any_method_can_be_polished() -> None:
    pytest.importorskip("numba")
    for scenario in seeded_scenarios(6, 10):
        plan, polished = (make_solver(name).solve(scenario) for name in ("edf", "edf+polish"))
        assert polished.method == "edf+polish"
        assert verify(scenario, polished).completed >= verify(scenario, plan).completed
    with pytest.raises(ConfigError, match="no method 'neerest'"):
        make_solver("neerest+polish")
