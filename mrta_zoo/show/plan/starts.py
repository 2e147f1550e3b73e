"""Labels where a plan's robots start on the map, placed so that none hides another.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state. Lengths are in points, 1/72 of an inch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from mrta_zoo.scenario import FloatArray
from mrta_zoo.show.lettering import covers, fitted, text_width
from mrta_zoo.show.palette import INK, robot_colour

SIZE, PAD, HIGH = 8.0, 0.3, 14.0
"""Of a label: the size of its letters, the padding around them as a share of that, and its height."""
HIDES = 11.0
"""Labels whose places are nearer than this along both axes would hide each other."""
LONGEST, SHORTER = 60.0, 35.0
"""The widest that a name may be, and the widest where that has no room."""
ASIDE = (0.0, 0.5, -0.5, 1.0, -1.0)
"""How far labels may lie beside the place of their robots, in halves of their size: at 1 they touch it."""
MOST_NAMES, MOST_NUMBERS, IN_A_ROW = 6, 12, 4
"""The most robots at one place that are labelled by name, by number, and in one row; more are only counted."""


@dataclass(frozen=True, slots=True)
class StartLabel:
    """A label at the start of a robot, or of several.

    Attributes:
        robot: whose it is; the first, if it is that of several.
        text: what it says.
        colour: its background.
        shift: from the robot's start to its middle.
        box: what it covers: left, bottom, right, top.
    """

    robot: int
    text: str
    colour: str
    shift: tuple[float, float]
    box: tuple[float, float, float, float]


def start_labels(
    places: FloatArray, names: Sequence[str], clear: FloatArray, frame: tuple[float, float]
) -> list[StartLabel]:
    """The labels of all robots: their names where there is room, or else their numbers.

    Labels of robots that start at one place, or nearly, lie side by side; names lie one above the other.

    Args:
        places: (M, 2) where the robots start.
        names: (M,) their names; empty if they have none.
        clear: (K, 4) boxes that names must not cover, and that several numbers avoid if they can.
        frame: its width and height; labels lie within.
    """
    groups = _groups(places)
    blocks = [_block(places, group, _numbers(group), IN_A_ROW) for group in groups]
    for index, group in enumerate(groups):
        others = [each.box for block in blocks[:index] + blocks[index + 1 :] for each in block]
        taken = np.concatenate((clear, np.reshape(others, (-1, 4))))
        named: list[tuple[Sequence[str], int]] = []
        if names and len(group) <= MOST_NAMES:
            for room in (LONGEST, SHORTER):
                texts = [fitted(names[robot], room, SIZE, "bold", names) for robot in group]
                named += [(texts, 1)] if all(texts) else []
        numbered = [(_numbers(group), IN_A_ROW)] if len(group) > 1 else []
        found = (_free(places, group, *choice, taken, frame) for choice in [*named, *numbered])
        blocks[index] = next(filter(None, found), blocks[index])
    return [each for block in blocks for each in block]


def _groups(places: FloatArray) -> list[list[int]]:
    """Groups of robots whose labels would hide each other."""
    groups: list[list[int]] = []
    for robot, place in enumerate(places):
        near = [group for group in groups if (np.abs(places[group] - place).max(axis=1) < HIDES).any()]
        groups = [group for group in groups if group not in near]
        groups.append([*(each for group in near for each in group), robot])
    return groups


def _numbers(group: Sequence[int]) -> list[str]:
    return [str(robot) for robot in group] if len(group) <= MOST_NUMBERS else [f"{len(group)} robots"]


def _free(
    places: FloatArray, group: Sequence[int], texts: Sequence[str], columns: int, taken: FloatArray,
    frame: tuple[float, float],
) -> list[StartLabel]:  # fmt: skip
    """Labels as near to the robots' place as possible, inside the frame and covering nothing; none without room."""
    for right, up in sorted(product(ASIDE, ASIDE), key=lambda each: abs(each[0]) + abs(each[1])):
        block = _block(places, group, texts, columns, (right, up))
        boxes = np.array([each.box for each in block])
        if (boxes >= 0).all() and (boxes[:, 2:] <= frame).all() and not any(covers(each.box, taken) for each in block):
            return block
    return []


def _block(
    places: FloatArray, group: Sequence[int], texts: Sequence[str], columns: int, aside: tuple[float, float] = (0, 0)
) -> list[StartLabel]:
    """Labels in rows of `columns`, centred on the robots' places or `aside` by so many halves of the block's size."""
    columns = min(columns, len(texts))
    size = np.array((max(map(_width, texts)), HIGH))
    grid = np.array((columns, -(-len(texts) // columns)))
    middle = places[group].mean(axis=0) if len(group) > 1 else places[group[0]]
    labels = []
    for index, text in enumerate(texts):
        cell = np.array((index % columns, grid[1] - 1 - index // columns))
        at = middle + size * (cell - (grid - 1) / 2 + np.array(aside) * grid / 2)
        half = np.array((_width(text), HIGH)) / 2
        labels.append(
            StartLabel(
                robot=group[index],
                text=text,
                colour=robot_colour(group[index]) if len(texts) == len(group) else INK,
                shift=(at - places[group[index]]).tolist(),
                box=(*(at - half).tolist(), *(at + half).tolist()),
            )
        )
    return labels


def _width(text: str) -> float:
    return max(text_width(text, SIZE, "bold") + 2 * PAD * SIZE, HIGH)
