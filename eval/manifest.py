"""What the numbers of an experiment depend on, kept beside its rows so that nothing else is mixed with them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from mrta_zoo import __version__
from mrta_zoo.errors import ConfigError
from mrta_zoo.io import Case
from mrta_zoo.policies.neural.policy_files import info_file, weights_file
from mrta_zoo.policies.pretrained import pretrained_names, pretrained_path
from mrta_zoo.policies.registry import METHODS, POLISH
from mrta_zoo.scenario import QUANTITIES
from mrta_zoo.wording import composed


@dataclass(frozen=True, slots=True, kw_only=True)
class Manifest:
    """Everything that the numbers of an experiment depend on, except the machine.

    Attributes:
        command: the command of `mrta-zoo` that made it.
        settings: its flags, as JSON values.
        cases: digest of the cases, see `digest_of_cases`.
        weights: digest of the weights of each trained method.
        version: of this package.
        format: always "mrta_zoo.experiment".
    """

    command: str
    settings: dict[str, Any]
    cases: str
    weights: dict[str, str]
    version: str = __version__
    format: Literal["mrta_zoo.experiment"] = "mrta_zoo.experiment"

    @property
    def text(self) -> str:
        """As written to disk; names are composed, so that one name has one spelling."""
        return composed(json.dumps(asdict(self), indent=2, ensure_ascii=False)) + "\n"

    def difference_from(self, earlier: Manifest) -> str:
        """What has changed since an earlier manifest, in words; empty if nothing has."""
        if earlier.command != self.command:
            return f"the command was {earlier.command}, now it is {self.command}"
        if earlier.version != self.version:
            return f"it was made by version {earlier.version}, this is {self.version}"
        for name in dict.fromkeys((*earlier.settings, *self.settings)):
            before, after = earlier.settings.get(name), self.settings.get(name)
            if before != after:
                return f"{name} was {_shown(before)}, now it is {_shown(after)}"
        if earlier.cases != self.cases:
            return "the cases have changed"
        for name in dict.fromkeys((*earlier.weights, *self.weights)):
            if earlier.weights.get(name) != self.weights.get(name):
                return f"the weights of {name} have changed"
        return ""


def make_manifest(
    command: str, settings: Mapping[str, Any], cases: Iterable[Case], methods: Iterable[str] = ()
) -> Manifest:
    """The manifest of an experiment that is about to begin or to be resumed."""
    bases = dict.fromkeys(method.removesuffix(POLISH) for method in methods)
    weights = {method: digest_of_weights(method) for method in bases if method not in METHODS}
    return Manifest(command=command, settings=dict(settings), cases=digest_of_cases(cases), weights=weights)


def digest_of_cases(cases: Iterable[Case]) -> str:
    """SHA-256 of names, scenarios and best known results, in order."""
    digest = hashlib.sha256()
    for case in cases:
        scenario = case.scenario
        tasks, robots = scenario.said("task"), scenario.said("robot")
        optional = [each.name for each in QUANTITIES if each.default == 0 and each.name in {**tasks, **robots}]
        head = [composed(case.name), scenario.num_tasks, scenario.num_robots, case.best_known, *optional]
        digest.update(json.dumps(head).encode())
        size = np.array(scenario.map_size)
        for array in (scenario.task_xy, *tasks.values(), scenario.robot_xy, *robots.values(), size):
            digest.update(array.astype("<f8").tobytes())
        if any(scenario.map_origin):  # as in digests made before maps had an origin
            digest.update(np.array(scenario.map_origin).astype("<f8").tobytes())
    return digest.hexdigest()


def digest_of_weights(method: str) -> str:
    """SHA-256 of a trained policy's two files.

    Args:
        method: the name of a policy that ships with the package, a ``.safetensors`` file, or the folder of a run.

    Raises:
        ConfigError: if they cannot be read.
    """
    path = pretrained_path(method) if method in pretrained_names() else weights_file(Path(method))
    digest = hashlib.sha256()
    for file in (path, info_file(path)):
        try:
            digest.update(file.read_bytes())
        except OSError as error:
            raise ConfigError(f"{file} cannot be read: {(error.strerror or str(error)).lower()}") from None
    return digest.hexdigest()


def _shown(value: object) -> str:
    if isinstance(value, list):
        return ",".join(map(str, value))
    return "not given" if value is None else str(value)
