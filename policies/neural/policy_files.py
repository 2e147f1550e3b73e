"""Paths of the two files of a trained policy: the weights, and the JSON beside them that describes them."""

from __future__ import annotations

import os
from pathlib import Path

from mrta_zoo.io.paths import as_spelt, suffix_of

SUFFIX = ".safetensors"
"""The suffix of weights, in small or capital letters."""


def weights_file(place: Path) -> Path:
    """The file of a policy's weights.

    Args:
        place: the file itself, or the folder of a training run.
    """
    return place if suffix_of(place) == SUFFIX and not os.path.isdir(place) else as_spelt(place / f"policy{SUFFIX}")


def info_file(weights: Path) -> Path:
    """The JSON file that belongs to weights; it need not exist."""
    return as_spelt(weights.with_suffix(".json"))
