"""Trained weights that ship with the package, each with its configuration and model card."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from mrta_zoo.errors import ConfigError


def pretrained_names() -> list[str]:
    """Names of the policies that ship with the package."""
    folder = resources.files(__name__)
    return sorted(Path(file.name).stem for file in folder.iterdir() if file.name.endswith(".safetensors"))


def pretrained_path(name: str) -> Path:
    """The file of a policy that ships with the package.

    Raises:
        ConfigError: if there is none of that name.
    """
    if name not in pretrained_names():
        raise ConfigError(
            f"no policy {name!r} ships with the package; there are {', '.join(pretrained_names()) or 'none'}"
        )
    return Path(str(resources.files(__name__) / f"{name}.safetensors"))
