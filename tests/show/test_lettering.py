"""Text in pictures lies where there is room for it, and numbers are never cut."""

from __future__ import annotations

import threading
import warnings

import numpy as np
import pytest

from mrta_zoo.show.lettering import any_letters, fitted, places_of_labels, text_width

NOTHING = np.empty((0, 4))


def test_widths_are_those_of_the_font() -> None:
    assert text_width("0", 10.0) == pytest.approx(6.36, abs=0.05)  # DejaVu Sans: digits are 0.636 of its size
    assert text_width("00", 20.0) == pytest.approx(25.4, abs=0.5)
    assert text_width("$0$", 10.0) > 2 * text_width("0", 10.0)  # no mathematics
    assert text_width("工场", 10.0) > 0.0  # which the font lacks: no warning


@pytest.mark.parametrize(("text", "room", "shown"), [
    ("valve-17", 40.0, "valve-17"), ("survey-point-17", 40.0, "surv…t-17"), ("survey-point-17", 18.0, ""),
    ("1234567", 33.0, "1234567"), ("1234567", 30.0, ""), ("", 5.0, ""), ("ab", 3.0, ""),
])  # fmt: skip
def test_names_are_shortened_in_the_middle_and_numbers_never(text: str, room: float, shown: str) -> None:
    assert fitted(text, room, 7.0) == shown


def test_labels_cover_neither_each_other_nor_marks() -> None:
    rng = np.random.default_rng(0)
    places = rng.random((120, 2)) * 300
    texts = [str(number) for number in range(120)]
    marks = np.hstack((places - 2.5, places + 2.5))
    found = places_of_labels(places, texts, 6.5, marks, (300.0, 300.0))
    assert len(found) > 90
    boxes = [(x, y, x + text_width(texts[index], 6.5), y + 5.2) for index, (x, y) in found.items()]
    for number, (left, bottom, right, top) in enumerate(boxes):
        assert 0 <= left < right <= 300
        assert 0 <= bottom < top <= 300
        for a, b, c, d in [*boxes[:number], *marks.tolist()]:
            assert c <= left or a >= right or d <= bottom or b >= top


def test_a_label_without_room_is_left_out() -> None:
    clear = np.array([[-50.0, -50.0, 60.0, 60.0]])
    assert places_of_labels(np.array([[10.0, 10.0]]), ["7"], 6.5, clear, (100.0, 100.0)) == {}
    assert places_of_labels(np.array([[10.0, 10.0]]), ["7"], 6.5, NOTHING, (100.0, 100.0)) == {0: (13.5, 12.5)}
    # In the upper right corner there is room at the lower left only.
    ((left, bottom),) = places_of_labels(np.array([[98.0, 98.0]]), ["7"], 6.5, NOTHING, (100.0, 100.0)).values()
    assert left < 94.5
    assert bottom < 94.0


def test_pictures_in_several_threads_leave_the_filters_of_warnings_as_they_were() -> None:
    before = list(warnings.filters)
    entered = threading.Event()

    def second() -> None:
        with any_letters():
            entered.set()

    thread = threading.Thread(target=second)
    with any_letters():
        thread.start()
        assert not entered.wait(0.05)  # it would take these filters for those to put back
    thread.join()
    assert entered.is_set()
    assert warnings.filters == before
