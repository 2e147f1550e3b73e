"""Where the two files of a trained policy are: its weights, and the JSON beside them that says what they belong to."""

from __future__ import annotations

import os
from pathlib import Path

from mrta_zoo.io.paths import as_spelt, suffix_of

SUFFIX = ".safetensors"
"""Of weights, in small or capital letters."""


def weights_file(place: Path) -> Path:
    """The weights of a policy.

    Args:
        place: the file itself, or the folder of a training run.
    """
    return place if suffix_of(place) == SUFFIX and not os.path.isdir(place) else as_spelt(place / f"policy{SUFFIX}")


def info_file(weights: Path) -> Path:
    """The JSON that belongs to weights, which need not be there."""
    return as_spelt(weights.with_suffix(".json"))
