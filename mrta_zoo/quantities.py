"""Quantities: the numbers that every task, or every robot, of a scenario has; rows of the field table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import ScenarioError

FloatArray = npt.NDArray[np.float64]
Who = Literal["task", "robot"]

SMALLEST, LARGEST = 1e-12, 1e12
"""The range of positive numbers: times and distances computed from them neither overflow nor vanish."""
BOUNDS = f", from {SMALLEST:g} to {LARGEST:g}"
COORDINATE = f"a number from {-LARGEST:g} to {LARGEST:g}"


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number that every task, or every robot, of a scenario has.

    Validation, files, batches, digests and notebooks are derived from these, so that a new one is a line in `Scenario`.

    Attributes:
        who: who has it.
        unit: its unit; units are free but must agree.
        positive: whether it must be > 0, and so from `SMALLEST` to `LARGEST`; otherwise it is from 0 to `LARGEST`.
        default: its value where none is given; None if one must be given. A quantity whose default is 0, and which is 0
            for everyone, is left out of files and digests.
        name: the attribute of `Scenario`, the field or column in files, and the word in messages.
    """

    who: Who
    unit: str
    positive: bool = False
    default: float | None = None
    name: str = ""

    @property
    def expected(self) -> str:
        """What its values must be, for messages."""
        return f"a number > 0{BOUNDS}" if self.positive else f"a number from 0 to {LARGEST:g}"

    @property
    def padding(self) -> float:
        """Its value in a batch where there is no task or robot."""
        return 1.0 if self.positive else 0.0

    def allows(self, values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Where values are in range; NaN is not."""
        values = np.asarray(values)
        return np.asarray((values >= (SMALLEST if self.positive else 0.0)) & (values <= LARGEST))

    def is_neutral(self, values: FloatArray) -> bool:
        """Whether files and digests leave it out."""
        return self.default == 0 and not values.any()

    def check(self, values: FloatArray) -> None:
        """Make sure that all values are in range.

        Raises:
            RowError: for the first that is not.
        """
        sign = values > 0 if self.positive else values >= 0
        check_values(values, self.who, self.name, sign, f"a finite number {'>' if self.positive else '>='} 0")
        check_values(values, self.who, self.name, self.allows(values), self.expected)


def check_values(values: FloatArray, who: Who, what: str, ok: npt.NDArray[np.bool_], expected: str) -> None:
    """Make sure that all values are finite and ok.

    Raises:
        RowError: for the first that is not.
    """
    bad = ~(ok & np.isfinite(values))
    if bad.any():
        index = int(bad.argmax())
        raise RowError.of(who, index, what, float(values[index]), expected)


class RowError(ScenarioError):
    """A number of one task or robot is out of range.

    Attributes:
        who: whose number it is.
        index: which of them.
        complaint: what is wrong, without saying where: "deadline is 0.0; expected a number > 0".
    """

    who: Who
    index: int
    complaint: str

    @classmethod
    def of(cls, who: Who, index: int, what: str, value: float, expected: str) -> RowError:
        """The error about a value."""
        error = cls(f"{who} {index} has {what} {value:g}; expected {expected}")
        error.who, error.index = who, index
        error.complaint = f"{what} is {value!r}; expected {expected}"
        return error
