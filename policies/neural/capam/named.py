"""Registries of what a configuration can name: the package's own entries, and those that users register."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

import torch
from torch import Tensor

from mrta_zoo.errors import ConfigError

T = TypeVar("T")


class Named(dict[str, T]):
    """A registry: entries by the names that a field of `NetworkConfig` takes.

    Configurations and saved policies hold names alone: whoever loads a policy has to register what it names first.

    Args:
        field: of the configuration, for messages.
        given: what ships with the package.
    """

    def __init__(self, field: str, given: Mapping[str, T]) -> None:
        super().__init__(given)
        self._field, self._given = field, tuple(given)

    def register(self, name: str) -> Callable[[T], T]:
        """A decorator that makes a function or class available by that name; replaces one registered before.

        Raises:
            ConfigError: if the name is empty or belongs to one that ships with the package, or if what is to be
                registered cannot be called.
        """
        if not isinstance(name, str) or not name or name in self._given:
            raise ConfigError(
                f"what is registered for {self._field} cannot be called {name!r}; expected a name that is none of the "
                f"package's own ({', '.join(self._given) or 'there are none'})"
            )

        def decorator(entry: T) -> T:
            if not callable(entry):
                raise ConfigError(
                    f"{name!r} of {self._field} is a {type(entry).__name__}; expected a function or class to call"
                )
            self[name] = entry
            return entry

        return decorator

    def find(self, name: str) -> T:
        """The entry of that name.

        Raises:
            ConfigError: if there is none.
        """
        if name not in self:
            raise ConfigError(
                f"{self._field} has {name!r}; expected {', '.join(self) or 'none'}, or one of your own, registered "
                "before the network is made or loaded"
            )
        return self[name]


def of_shape(kind: str, name: str, values: object, shape: tuple[int, ...], device: torch.device) -> Tensor:
    """Check what a feature or an encoder returned, and return it.

    Args:
        kind: "node feature" or the like, for messages.
        name: its name.
        values: what it returned.
        shape: the shape expected.
        device: the device expected.

    Raises:
        ConfigError: if it is not a dense tensor of real numbers, of that shape and on that device.
    """
    if not isinstance(values, Tensor) or values.shape != shape:
        gave = f"shape {tuple(values.shape)}" if isinstance(values, Tensor) else f"a {type(values).__name__}"
        raise ConfigError(f"{kind} {name!r} gave {gave}; expected a tensor of shape {tuple(shape)}")
    if values.layout is not torch.strided or values.is_complex() or values.device != device:
        gave = f"{values.layout} of {values.dtype} on {values.device}".replace("torch.", "")
        raise ConfigError(f"{kind} {name!r} gave {gave}; expected a dense tensor of real numbers on {device}")
    return values
