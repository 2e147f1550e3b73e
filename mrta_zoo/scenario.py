"""The problem instance: tasks with a place, workload and deadline; robots with a start, capacity and speed."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import Annotated, get_type_hints

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import ScenarioError
from mrta_zoo.map import UNSAID, map_around
from mrta_zoo.names import as_names
from mrta_zoo.quantities import FloatArray as FloatArray
from mrta_zoo.quantities import Quantity, Who, check_values
from mrta_zoo.wording import counted


def _by_default() -> FloatArray:
    return np.empty(0)


@dataclass(frozen=True, slots=True, eq=False)
class Scenario:
    """One mission to be planned (paper §II-A). Immutable: arrays are copied to float64 and made read-only.

    Task ``j`` and robot ``i`` are rows ``j`` and ``i`` of the arrays, counted from 0. Units are free but must
    agree: distance units for places, time units for deadlines, work units for workloads; speeds are distance
    per time and capacities work per time.

    Attributes:
        task_xy: (N, 2) task places, inside the map.
        deadline: (N,) latest finish that counts as completed, > 0.
        workload: (N,) work to be done at the task, >= 0 (0 is a mere visit).
        robot_xy: (M, 2) places where the robots start at time 0, inside the map.
        capacity: (M,) work done per time unit, > 0.
        speed: (M,) distance travelled per time unit, > 0; 1 for every robot by default.
        map_size: width and height of the map, > 0. By default 100 and 100 or, if that does not hold every place, those
            of a square that does, see `map.square_around`.
        name: its name in files, tables and pictures.
        map_origin: the map's lowest x and y, which may be negative. By default (0, 0) or, if the places do not suit
            that, their smallest whole x and y, see `map.map_origin_for`.
        task_names: names of the tasks, all different; empty if they are known by their numbers only.
        robot_names: likewise for the robots.

    Raises:
        ScenarioError: if an array has the wrong shape, or a value is out of range: positive numbers must lie between
            `quantities.SMALLEST` and `LARGEST`, coordinates within `LARGEST` of 0, and none may be NaN or infinite.
    """

    # The field table. To add a quantity: its line here, with a default and after the others, its line in the docstring
    # and in `scenario_batch.ScenarioBatch`, and its formula in `rules`. Files, digests, padding and notebooks follow.

    task_xy: FloatArray
    deadline: Annotated[FloatArray, Quantity("task", "time", positive=True)]
    workload: Annotated[FloatArray, Quantity("task", "work")]
    robot_xy: FloatArray
    capacity: Annotated[FloatArray, Quantity("robot", "work per time", positive=True)]
    speed: Annotated[FloatArray, Quantity("robot", "distance per time", positive=True, default=1.0)] = field(
        default_factory=_by_default
    )
    map_size: tuple[float, float] = UNSAID
    name: str = "scenario"
    map_origin: tuple[float, float] = UNSAID
    task_names: tuple[str, ...] = ()
    robot_names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        self._freeze_arrays()
        size, origin = map_around(np.concatenate((self.task_xy, self.robot_xy)), self.map_size, self.map_origin)
        object.__setattr__(self, "map_size", size)
        object.__setattr__(self, "map_origin", origin)
        for quantity in QUANTITIES:
            quantity.check(getattr(self, quantity.name))
        self._check_places()
        object.__setattr__(self, "task_names", as_names(self.task_names, "task", self.num_tasks))
        object.__setattr__(self, "robot_names", as_names(self.robot_names, "robot", self.num_robots))

    def _freeze_arrays(self) -> None:
        """Copy all arrays, fill in defaults, and check shapes."""
        for attribute in ARRAYS:
            object.__setattr__(self, attribute, _frozen(getattr(self, attribute), attribute))
        for attribute in ("deadline", "capacity"):
            if (shape := getattr(self, attribute).shape) != (getattr(self, attribute).size,):
                raise ScenarioError(f"{attribute} has shape {shape}; expected a list of numbers, one each")
        counts: dict[Who, int] = {"task": self.num_tasks, "robot": self.num_robots}
        for who, count in counts.items():
            if count == 0:
                raise ScenarioError(f"a scenario needs at least one {who}; got 0")
        for quantity in QUANTITIES:
            if quantity.default is not None and getattr(self, quantity.name).shape == (0,):
                everyone = np.full(counts[quantity.who], quantity.default)
                object.__setattr__(self, quantity.name, _frozen(everyone, quantity.name))
        for attribute, who in ARRAYS.items():
            expected = (counts[who], 2) if attribute.endswith("_xy") else (counts[who],)
            if (shape := getattr(self, attribute).shape) != expected:
                raise ScenarioError(
                    f"{attribute} has shape {shape}; with {counted(self.num_tasks, 'deadline')} and "
                    f"{counted(self.num_robots, 'capacity', 'capacities')} it must be {expected}"
                )

    def _check_places(self) -> None:
        places: tuple[tuple[Who, FloatArray], ...] = (("task", self.task_xy), ("robot", self.robot_xy))
        for who, xy in places:
            for letter, values, low, high in zip("xy", xy.T, self.map_origin, self.map_end, strict=True):
                inside = (values >= low) & (values <= high)
                check_values(values, who, letter, inside, f"a number from {low:g} to {high:.12g}, inside the map")

    @property
    def num_tasks(self) -> int:
        """N, the number of tasks."""
        return len(self.deadline)

    @property
    def num_robots(self) -> int:
        """M, the number of robots."""
        return len(self.capacity)

    def said(self, who: Who) -> dict[str, FloatArray]:
        """The quantities of the tasks, or of the robots, by name; without those that are neutral, see `Quantity`."""
        values = ((each, getattr(self, each.name)) for each in quantities_of(who))
        return {each.name: array for each, array in values if not each.is_neutral(array)}

    @property
    def map_end(self) -> tuple[float, float]:
        """The map's highest x and y."""
        (x, y), (width, height) = self.map_origin, self.map_size
        return x + width, y + height

    def task_name(self, task: int) -> str:
        """A task for people: its name, or its number."""
        return self.task_names[task] if self.task_names else str(task)

    def robot_name(self, robot: int) -> str:
        """A robot for people: its name, or "robot" and its number."""
        return self.robot_names[robot] if self.robot_names else f"robot {robot}"

    def task_label(self, task: int) -> str:
        """A task for messages about code or files: its number and, if it has one, its name."""
        return f"{task} ({self.task_names[task]})" if self.task_names else str(task)

    def robot_label(self, robot: int) -> str:
        """A robot for messages about code or files, likewise."""
        return f"{robot} ({self.robot_names[robot]})" if self.robot_names else str(robot)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[object, ...]:
        values = (getattr(self, each.name) for each in fields(self))
        return tuple(value.tobytes() if isinstance(value, np.ndarray) else value for value in values)

    def __reduce__(self) -> tuple[type[Scenario], tuple[object, ...]]:
        # Through the constructor, so that a copy is checked and read-only, too.
        return type(self), tuple(getattr(self, each.name) for each in fields(self))

    @property
    def size(self) -> str:
        """How many tasks and robots, in words."""
        return f"{counted(self.num_tasks, 'task')}, {counted(self.num_robots, 'robot')}"

    def __repr__(self) -> str:
        return f"Scenario({self.name!r}, {self.size})"


QUANTITIES = tuple(
    replace(quantity, name=name)
    for name, hint in get_type_hints(Scenario, include_extras=True).items()
    for quantity in getattr(hint, "__metadata__", ())
)
"""The field table: every number that tasks or robots have, in the order of `Scenario`."""

ARRAYS: dict[str, Who] = {"task_xy": "task", "robot_xy": "robot", **{each.name: each.who for each in QUANTITIES}}
"""Who has a row in each array."""


def quantities_of(who: Who) -> tuple[Quantity, ...]:
    """The rows of the field table for the tasks, or for the robots."""
    return tuple(quantity for quantity in QUANTITIES if quantity.who == who)


def _frozen(values: npt.ArrayLike, attribute: str) -> FloatArray:
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError) as error:
        raise ScenarioError(f"{attribute} must hold numbers: {error}") from None
    array += 0.0  # turns -0.0 into 0.0, so that equal scenarios have equal bytes
    array.setflags(write=False)
    return array
