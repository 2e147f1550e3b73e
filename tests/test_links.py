"""Links, paths and names of modules in our Markdown pages lead somewhere; not in CHANGELOG.md, which is history."""

from __future__ import annotations

import re
from itertools import chain
from pathlib import Path

import pytest
from layers import MODULES, PACKAGES, ROOT

PATTERNS = ("README.md", "CONTRIBUTING.md", "docs/*.md", "policies/pretrained/*.md", "eval/results/*/report.md")
PAGES = sorted(chain.from_iterable(ROOT.glob(pattern) for pattern in PATTERNS))
LINK = re.compile(r"\]\(<?(?!\w+:|#)([^)>#]+)[^)]*\)")
CODE = re.compile(r"`([^`\s]+)`")
OURS = re.compile(rf"(?:{'|'.join((*PACKAGES, 'tests', 'docs'))})/[\w./-]*|[\w/-]+\.py")
MODULE = re.compile(r"mrta_zoo(?:\.\w+)+")


def broken(text: str, page: Path) -> list[str]:
    """What the text of a page links to or names in backticks, though there is no such thing."""
    words = CODE.findall(re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE))
    return [
        *(target for target in LINK.findall(text) if not (page.parent / target).exists()),
        *(word for word in words if OURS.fullmatch(word) and not _is_path(word)),
        *(word for word in words if MODULE.fullmatch(word) and not _is_name(word)),
    ]


def _is_path(word: str) -> bool:
    """Whether it is a path from the root or from the core, perhaps without `.py`, or the name of a module's file."""
    places = (ROOT / start / (word + suffix) for start in ("", "mrta_zoo") for suffix in ("", ".py"))
    return any(place.exists() for place in places) or word in {path.name for path in MODULES.values()}


def _is_name(word: str) -> bool:
    """Whether it is a module of ours, or something that one of them defines."""
    module, _, name = word.rpartition(".")
    return word in MODULES or (module in MODULES and name in MODULES[module].read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_all_leads_somewhere(page: Path) -> None:
    assert broken(page.read_text(encoding="utf-8"), page) == []


def test_what_leads_nowhere_is_found() -> None:
    text = (
        "[a](docs/lost.md) [b](docs/architecture.md#the-map) [c](https://example.org/lost.md) [d](#lost)\n"
        "`policies/lost.py` `policies/registry.py` `io/atomic.py` `atomic.py` `lost.py` `eval/lost` `runs/mine`\n"
        "`mrta_zoo.lost` `mrta_zoo.policies.registry` `mrta_zoo.policies.registry.METHODS`\n"
        "```sh\nmake `eval/lost/too`\n```\n"
    )
    lost = ["docs/lost.md", "policies/lost.py", "lost.py", "eval/lost", "mrta_zoo.lost"]
    assert broken(text, ROOT / "page.md") == lost
