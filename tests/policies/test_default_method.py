"""Which method plans if none is named."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest
from command_line import Captured, fails
from valid_files import TABLE

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


BROKEN = {
    "numba": ImportError("Numba needs NumPy 2.2 or less. Got NumPy 2.4."),
    "pyvrp": ImportError(""),
    "torch": OSError("libcudart.so.12: cannot open shared object file\n  in a second line"),
    "matplotlib": ValueError("numpy.dtype size changed"),
}


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Modules that are installed, but cannot be imported: their names go in here."""
    names: set[str] = set()

    def import_broken(name: str) -> ModuleType:
        if name in names:
            raise BROKEN[name]
        return import_module(name)

    monkeypatch.setattr(extras, "import_module", import_broken)
    return names


@pytest.mark.parametrize(
    ("names", "method"),
    [({"numba"}, "pyvrp"), ({"numba", "pyvrp"}, "capam-plus"), ({"numba", "pyvrp", "torch"}, "nearest")],
)
def test_what_is_broken_counts_as_missing(names: set[str], method: str, broken: set[str]) -> None:
    broken |= names
    assert default_method() == (
        method,
        "method 'eils' needs numba, which is installed here but cannot be imported (Numba needs NumPy 2.2 or less. "
        'Got NumPy 2.4); install what fits with: pip install --upgrade "mrta_zoo[solvers]"',
    )


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("solve m.csv --method eils", "method 'eils' needs numba, which is installed here but cannot be imported"),
        ("solve m.csv --method edf+polish", "method 'edf+polish' needs numba, which is installed here but"),
        ("solve m.csv --method pyvrp", "needs pyvrp, which is installed here but cannot be imported (ImportError)"),
        ("solve m.csv --method capam", "imported (libcudart.so.12: cannot open shared object file); install what fits"),
        (
            "eval --cases builtin --methods nearest,capam",
            "method 'capam' needs torch, which is installed here but cannot be imported",
        ),
        ("train --preset smoke --out x", "training needs torch, which is installed here but cannot be imported"),
        ("reproduce --out x", "the report needs matplotlib, which is installed here but cannot be imported (numpy"),
    ],
)
def test_what_is_broken_is_told_in_a_sentence(
    line: str, says: str, broken: set[str], capsys: Captured, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken |= set(BROKEN)
    monkeypatch.chdir(tmp_path)
    Path("m.csv").write_text(TABLE)
    assert says in fails(capsys, line.split())


def test_they_are_all_methods() -> None:
    assert set(BEST_FIRST) <= set(method_names())
