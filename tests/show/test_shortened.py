"""A name without room for all of it keeps what tells it from the others."""

from __future__ import annotations

import pytest

from mrta_zoo.show.shortened import shortened, telling

STATIONS = [f"Inspect pump station {number} (north wing)" for number in range(25)]


def in_letters(name: str, most: int, among: list[str]) -> str:
    return shortened(name, lambda text: len(text) <= most, among)


@pytest.mark.parametrize(("name", "most", "among", "shown"), [
    ("Inspect pump station 12 (north wing)", 12, STATIONS, "Inspect…12…"),
    ("Inspect pump station 1 (north wing)", 12, STATIONS, "Inspect p…1…"),
    ("Inspect pump station 12 (north wing)", 30, STATIONS, "Inspect pump station 12…wing)"),
    ("Inspect pump station 12 (north wing)", 4, STATIONS, "…12…"),
    ("Inspect pump station 12 (north wing)", 3, STATIONS, ""),
    ("Inspect pump station 12 (north wing)", 36, STATIONS, "Inspect pump station 12 (north wing)"),
    ("Spot 7", 5, ["Spot 7", "Spot 17", "Spot 77"], "Spo…7"),
    ("station 1", 6, ["station 1", "station 12"], "stat…1"),
    ("well 12.5 m", 8, ["well 12.5 m", "well 12.7 m"], "we…12.5…"),
    ("Room 12 valve A", 12, ["Room 12 valve A", "Room 12 valve B", "Room 13 valve A"], "R…12 valve A"),
    ("east wing door", 6, ["east wing door", "west wing door"], "east…r"),
    ("east wing door", 4, ["east wing door", "west wing door"], "ea…r"),
    ("东泵站一号室", 5, ["东泵站一号室", "东泵站二号室"], "东泵站一…"),
    ("survey-point-17", 10, [], "surve…t-17"), ("1234567", 5, ["1234567", "1234568"], ""), ("ab", 1, [], ""),
])  # fmt: skip
def test_by_hand(name: str, most: int, among: list[str], shown: str) -> None:
    assert in_letters(name, most, among) == shown


@pytest.mark.parametrize("most", [5, 8, 13, 21, 34])
def test_no_two_look_alike(most: int) -> None:
    assert len({in_letters(name, most, STATIONS) for name in STATIONS}) == len(STATIONS)
    assert all(len(in_letters(name, most, STATIONS)) <= most for name in STATIONS)


def test_of_many_names() -> None:
    names = tuple(f"survey point {number} of the long wall" for number in range(3000))
    assert {name[slice(*parts[0])] for name, parts in telling(names).items()} == {str(number) for number in range(3000)}
