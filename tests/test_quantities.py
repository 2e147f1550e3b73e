"""Rows of the field table: what is allowed, left out and padded with."""

import numpy as np
import pytest

from mrta_zoo.quantities import Quantity, RowError

DEADLINE = Quantity("task", "time", positive=True, name="deadline")
RELEASE = Quantity("task", "time", default=0.0, name="release")


@pytest.mark.parametrize(
    ("quantity", "good", "bad"),
    [(DEADLINE, (1e-12, 1, 1e12), (-1, 0, 1e-13, 2e12)), (RELEASE, (0, 1e-13, 1e12), (-1e-9, 2e12))],
)
def test_bounds(quantity: Quantity, good: tuple[float, ...], bad: tuple[float, ...]) -> None:
    quantity.check(np.array(good, dtype=float))
    for value in (*bad, np.nan, np.inf):
        with pytest.raises(RowError, match=rf"task 1 has {quantity.name} \S+; expected a (finite )?number"):
            quantity.check(np.array([1.0, value]))


def test_files_leave_out_what_is_0_for_all_by_default() -> None:
    assert RELEASE.is_neutral(np.zeros(2))
    assert not RELEASE.is_neutral(np.array([0.0, 1.0]))
    assert not Quantity("robot", "distance per time", positive=True, default=1.0).is_neutral(np.ones(2))
    assert not Quantity("task", "work").is_neutral(np.zeros(2))


def test_padding_is_in_range() -> None:
    for quantity in (DEADLINE, RELEASE):
        quantity.check(np.array([quantity.padding]))
