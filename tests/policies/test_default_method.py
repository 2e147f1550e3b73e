"""Which method plans if none is named."""

from __future__ import annotations

import pytest

from mrta_zoo import extras
from mrta_zoo.policies.default_method import BEST_FIRST, default_method
from mrta_zoo.policies.registry import method_names


@pytest.mark.parametrize(
    ("hidden", "method", "missing"),
    [
        ((), "eils", ""),
        (("pyvrp", "torch"), "eils", ""),
        (("numba",), "pyvrp", "method 'eils' needs numba, not installed here; "),
        (("scipy", "numba", "pyvrp"), "capam-plus", "method 'eils' needs scipy, numba, not installed here; "),
        (("numba", "pyvrp", "torch"), "nearest", "method 'eils' needs numba, not installed here; "),
        (("numba", "pyvrp", "safetensors"), "nearest", "method 'eils' needs numba, not installed here; "),
    ],
)
def test_the_best_that_is_installed(
    hidden: tuple[str, ...], method: str, missing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None if name in hidden else object())
    found, sentence = default_method()
    assert found == method
    assert sentence == (missing and missing + 'install it with: pip install "mrta_zoo[solvers]"')


def test_they_are_all_methods() -> None:
    assert set(BEST_FIRST) <= set(method_names())
