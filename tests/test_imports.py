"""Imports flow one way, and importing the package is cheap."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent

# From the bottom up. A module may import its own layer and those before it; a package stands for its modules.
LAYERS = (
    (
        "what needs nothing of ours",
        (
            "mrta_zoo.errors",
            "mrta_zoo.wording",
            "mrta_zoo.actions",
            "mrta_zoo.digits",
            "mrta_zoo.bounds",
            "mrta_zoo.extras",
            "mrta_zoo.registration",
            "mrta_zoo.program",
        ),
    ),
    (
        "the problem and its rules",
        (
            "mrta_zoo.quantities",
            "mrta_zoo.map",
            "mrta_zoo.names",
            "mrta_zoo.scenario",
            "mrta_zoo.plan",
            "mrta_zoo.rules",
            "mrta_zoo.reach",
            "mrta_zoo.scales",
            "mrta_zoo.scenario_batch",
        ),
    ),
    ("dynamics and scores", ("mrta_zoo.mission", "mrta_zoo.batch", "mrta_zoo.verify", "mrta_zoo.left_out")),
    ("episodes and where missions come from", ("mrta_zoo.trace", "mrta_zoo.generators", "mrta_zoo.suite")),
    ("files", ("mrta_zoo.io",)),
    ("presentation", ("mrta_zoo.show",)),
    ("the package, and how its objects show themselves", ("mrta_zoo",)),
    ("the environment", ("mrta_zoo.env",)),
    ("its public face", ("mrta_zoo.mrta_v0",)),
    ("policies and solvers", ("mrta_zoo.policies",)),
    ("looking into episodes", ("mrta_zoo.debug",)),
    ("replay pages", ("mrta_zoo.show.replay",)),
    ("training", ("mrta_zoo.train",)),
    ("evaluation", ("mrta_zoo.eval",)),
    ("the command line", ("mrta_zoo.cli", "mrta_zoo.__main__")),
)
PACKAGES = {
    "mrta_zoo": "mrta_zoo",
    "policies": "mrta_zoo.policies",
    "train": "mrta_zoo.train",
    "eval": "mrta_zoo.eval",
}
VERIFY_MAY_IMPORT = {"mrta_zoo.scenario", "mrta_zoo.plan", "mrta_zoo.errors", "mrta_zoo.wording"}
HEAVY = ("torch", "matplotlib", "scipy", "tyro", "rich", "pygame")


def modules() -> dict[str, Path]:
    """Every module of the package by its imported name."""
    found = {}
    for folder, package in PACKAGES.items():
        for path in sorted((ROOT / folder).rglob("*.py")):
            parts = path.relative_to(ROOT / folder).with_suffix("").parts
            found[".".join([package, *(part for part in parts if part != "__init__")])] = path
    return found


MODULES = modules()


def imports(source: str) -> Iterator[str]:
    """What a module of ours imports from us, at the top, inside functions, or for types only."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports are not used here: write `from mrta_zoo...`"
            inner = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name if name in MODULES else str(node.module) for name in inner]
        else:
            continue
        yield from (name for name in names if name == "mrta_zoo" or name.startswith("mrta_zoo."))


def layer(module: str) -> int | None:
    """The layer of the longest listed name that is `module` or holds it; "mrta_zoo" holds only itself."""
    name = module
    while True:
        for index, (_, members) in enumerate(LAYERS):
            if name in members and (name != "mrta_zoo" or module == "mrta_zoo"):
                return index
        if "." not in name:
            return None
        name = name.rpartition(".")[0]


def violations(module: str, source: str) -> list[str]:
    """The imports of `module` that go up, as sentences."""
    mine = layer(module)
    assert mine is not None
    found = []
    for name in imports(source):
        theirs = layer(name)
        if theirs is None or theirs > mine:
            where = "no layer" if theirs is None else f"layer {theirs} ({LAYERS[theirs][0]})"
            found.append(f"{module} of layer {mine} ({LAYERS[mine][0]}) imports {name} of {where}")
    return found


@pytest.mark.parametrize("module", MODULES)
def test_imports_flow_one_way(module: str) -> None:
    assert layer(module) is not None, (
        f"{module} is in no layer: add it to LAYERS in {Path(__file__).name}, in the lowest layer that "
        "lets it import what it needs from its own layer and those below"
    )
    assert violations(module, MODULES[module].read_text(encoding="utf-8")) == []


def test_the_verifier_stands_alone() -> None:
    assert set(imports(MODULES["mrta_zoo.verify"].read_text(encoding="utf-8"))) <= VERIFY_MAY_IMPORT


def test_upward_imports_are_found() -> None:
    assert violations("mrta_zoo.rules", "from mrta_zoo.mission import Mission") != []
    assert violations("mrta_zoo.rules", "import mrta_zoo.policies.protocol") != []
    assert violations("mrta_zoo.batch", "def f():\n    from mrta_zoo.env import observation") != []
    assert violations("mrta_zoo.policies.x", "from mrta_zoo.train.config import Config") != []
    assert violations("mrta_zoo.eval.runner", "from mrta_zoo.cli.main import main") != []
    assert violations("mrta_zoo.policies.x", "from mrta_zoo.unheard_of import y") != []
    assert violations("mrta_zoo.train.x", "import torch\nfrom mrta_zoo import Plan, rules\nimport mrta_zoo") == []
    assert layer("mrta_zoo.unheard_of") is None


def test_importing_the_package_is_cheap() -> None:
    code = f"import sys, mrta_zoo; print(*[name for name in {HEAVY} if name in sys.modules])"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT.parent)
    assert loaded.stdout.split() == []


def test_a_checkout_that_is_not_installed_is_whole() -> None:
    libraries = Path(np.__file__).parent.parent
    code = (
        f"import sys; sys.path.append({str(libraries)!r});"
        "import mrta_zoo.policies.options, mrta_zoo.train, mrta_zoo.eval;"
        "from mrta_zoo.policies.pretrained import pretrained_path;"
        "print(mrta_zoo.policies.options.__file__, pretrained_path('capam').is_file())"
    )
    found = subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, check=False, cwd=ROOT)
    assert (found.stdout.split(), found.stderr) == ([str(ROOT / "policies" / "options.py"), "True"], "")
