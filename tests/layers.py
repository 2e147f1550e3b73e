"""The layers of the package, the imports of each module, and the map of both in docs/architecture.md.

``python tests/layers.py`` draws the map anew.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MAP = ROOT / "docs" / "architecture.md"
BEGIN, END = "<!-- the map, by tests/layers.py -->\n", "<!-- the end of the map -->\n"

# From the bottom up. A module may import its own layer and those before it; a package stands for its modules.
LAYERS = (
    (
        "foundations",
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
    ("traces and generators", ("mrta_zoo.trace", "mrta_zoo.generators", "mrta_zoo.suite")),
    ("files", ("mrta_zoo.io",)),
    ("presentation", ("mrta_zoo.show",)),
    ("the package", ("mrta_zoo",)),
    ("the environment", ("mrta_zoo.env",)),
    ("the public environment", ("mrta_zoo.mrta_v0",)),
    ("policies and solvers", ("mrta_zoo.policies",)),
    ("debugging", ("mrta_zoo.debug",)),
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
    """The modules of ours that a source imports, at the top, inside functions, or for types only."""
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


def room(module: str) -> str:
    """The folder that a module lies in, as a path from the root; its own path, without a suffix, at the top level."""
    path = MODULES[module]
    home = path.parent.relative_to(ROOT).as_posix()
    return home if home != "mrta_zoo" or path.name == "__init__.py" else f"mrta_zoo/{path.stem}"


def needs() -> dict[str, set[str]]:
    """What each room imports from other rooms, the lowest rooms first."""
    found: dict[str, set[str]] = {}
    for module, path in sorted(MODULES.items(), key=lambda item: (layer(item[0]) or 0, item[0])):
        mine = found.setdefault(room(module), set())
        mine |= {room(name) for name in imports(path.read_text(encoding="utf-8")) if name in MODULES} - {room(module)}
    return found


def draw() -> str:
    """The map as a Markdown table: one row per room, layer by layer from the top down, with the rooms it uses."""
    uses = needs()
    lines = ["| layer | module or package | holds | uses directly |", "|---|---|---|---|"]
    for index in reversed(range(len(LAYERS))):
        members = [module for module in MODULES if layer(module) == index]
        for number, each in enumerate(dict.fromkeys(room(module) for module in members)):
            inside = [MODULES[module] for module in members if room(module) == each]
            first = next((path for path in inside if path.name == "__init__.py"), inside[0])
            holds = (ast.get_docstring(ast.parse(first.read_text(encoding="utf-8"))) or "").partition("\n")[0]
            used = ", ".join(f"`{name.removeprefix('mrta_zoo/')}`" for name in sorted(uses[each]))
            title = LAYERS[index][0] if number == 0 else ""
            lines.append(f"| {title} | [`{each}`](../{link(each)}) | {holds} | {used} |")
    return "\n".join(lines) + "\n"


def link(each: str) -> str:
    """The file or folder of a room."""
    return each if (ROOT / each).is_dir() else f"{each}.py"


def with_map(text: str) -> str:
    """The text with the map as it is now between its two marks."""
    before, _, rest = text.partition(BEGIN)
    return before + BEGIN + "\n" + draw() + "\n" + END + rest.partition(END)[2]


if __name__ == "__main__":
    MAP.write_text(with_map(MAP.read_text(encoding="utf-8")), encoding="utf-8")
