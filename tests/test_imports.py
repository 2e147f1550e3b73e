"""Imports flow one way, and importing the package is cheap."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from layers import MAP, MODULES, ROOT, imports, layer, violations, with_map

VERIFY_MAY_IMPORT = {"mrta_zoo.scenario", "mrta_zoo.plan", "mrta_zoo.errors", "mrta_zoo.wording"}
HEAVY = ("torch", "matplotlib", "scipy", "tyro", "rich", "pygame")


@pytest.mark.parametrize("module", MODULES)
def test_imports_flow_one_way(module: str) -> None:
    assert layer(module) is not None, (
        f"{module} is in no layer: add it to LAYERS in tests/layers.py, in the lowest layer that "
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


def test_the_map_is_as_the_code() -> None:
    drawn = MAP.read_text(encoding="utf-8")
    assert drawn == with_map(drawn), "draw it anew: python tests/layers.py"


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
