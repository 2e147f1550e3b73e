"""The problem instance: tasks with a place, workload and deadline; robots with a start, capacity and speed."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import ScenarioError
from mrta_zoo.html import map_of, table

FloatArray = npt.NDArray[np.float64]

SMALLEST, LARGEST = 1e-12, 1e12
"""What a positive quantity may be: times and distances made of such numbers neither overflow nor vanish."""
BOUNDS = f", from {SMALLEST:g} to {LARGEST:g}"


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
        map_size: width and height of the map, whose corner is the origin, > 0.
        name: what files, tables and pictures call this scenario.

    Raises:
        ScenarioError: if an array has the wrong shape, or a value is out of range: positive numbers must lie between
            `SMALLEST` and `LARGEST`, and none may be NaN or infinite.
    """

    task_xy: FloatArray
    deadline: FloatArray
    workload: FloatArray
    robot_xy: FloatArray
    capacity: FloatArray
    speed: FloatArray = field(default_factory=lambda: np.empty(0))
    map_size: tuple[float, float] = (100.0, 100.0)
    name: str = "scenario"

    def __post_init__(self) -> None:
        for attribute in ("task_xy", "deadline", "workload", "robot_xy", "capacity", "speed"):
            object.__setattr__(self, attribute, _frozen(getattr(self, attribute), attribute))
        for attribute in ("deadline", "capacity"):
            if getattr(self, attribute).ndim != 1:
                shape = getattr(self, attribute).shape
                raise ScenarioError(f"{attribute} has shape {shape}; expected a list of numbers, one each")
        n, m = len(self.deadline), len(self.capacity)
        if n == 0:
            raise ScenarioError("a scenario needs at least one task; got 0")
        if m == 0:
            raise ScenarioError("a scenario needs at least one robot; got 0")
        if self.speed.shape == (0,):
            object.__setattr__(self, "speed", _frozen(np.ones(m), "speed"))
        for attribute, shape in (
            ("task_xy", (n, 2)), ("deadline", (n,)), ("workload", (n,)),
            ("robot_xy", (m, 2)), ("capacity", (m,)), ("speed", (m,)),
        ):  # fmt: skip
            if getattr(self, attribute).shape != shape:
                raise ScenarioError(
                    f"{attribute} has shape {getattr(self, attribute).shape}; with {n} deadlines and "
                    f"{m} capacities it must be {shape}"
                )
        try:
            size = tuple(float(side) for side in self.map_size)
        except (TypeError, ValueError):
            size = ()
        if len(size) != 2 or not all(SMALLEST <= side <= LARGEST for side in size):
            raise ScenarioError(f"map_size is {self.map_size!r}; expected two finite numbers > 0{BOUNDS}")
        object.__setattr__(self, "map_size", size)
        for who, what in (("task", "deadline"), ("robot", "capacity"), ("robot", "speed")):
            values = getattr(self, what)
            _check(values, who, what, values > 0, "a finite number > 0")
            _check(values, who, what, (values >= SMALLEST) & (values <= LARGEST), f"a number > 0{BOUNDS}")
        _check(self.workload, "task", "workload", self.workload >= 0, "a finite number >= 0")
        _check(self.workload, "task", "workload", self.workload <= LARGEST, f"a number from 0 to {LARGEST:g}")
        for who, places in (("task", self.task_xy), ("robot", self.robot_xy)):
            for axis, letter in enumerate("xy"):
                values = places[:, axis]
                inside = (values >= 0) & (values <= size[axis])
                _check(values, who, letter, inside, f"a number from 0 to {size[axis]:g}, inside the map")

    @property
    def num_tasks(self) -> int:
        """N, the number of tasks."""
        return len(self.deadline)

    @property
    def num_robots(self) -> int:
        """M, the number of robots."""
        return len(self.capacity)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[object, ...]:
        arrays = (self.task_xy, self.deadline, self.workload, self.robot_xy, self.capacity, self.speed)
        return (self.name, self.map_size, *(array.tobytes() for array in arrays))

    def __reduce__(self) -> tuple[type[Scenario], tuple[object, ...]]:
        # Through the constructor, so that a copy is checked and read-only, too.
        return type(self), tuple(getattr(self, each.name) for each in fields(self))

    def __repr__(self) -> str:
        return f"Scenario({self.name!r}, {self.num_tasks} tasks, {self.num_robots} robots)"

    def _repr_html_(self) -> str:
        """What a notebook shows: the ranges of what it holds, and the map."""
        rows = [
            (what, f"{values.min():g}", f"{values.mean():.4g}", f"{values.max():g}")
            for what, values in (
                ("deadline", self.deadline), ("workload", self.workload),
                ("capacity", self.capacity), ("speed", self.speed),
            )
        ]  # fmt: skip
        width, height = self.map_size
        title = f"{self.name}: {self.num_tasks} tasks, {self.num_robots} robots, map {width:g} by {height:g}"
        picture = map_of(self.map_size, self.task_xy.tolist(), self.deadline.tolist(), self.robot_xy.tolist())
        return table(title, ("", "least", "mean", "most"), rows) + picture


def _frozen(values: npt.ArrayLike, attribute: str) -> FloatArray:
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise ScenarioError(f"{attribute} must hold numbers: {error}") from None
    array += 0.0  # turns -0.0 into 0.0, so that equal scenarios have equal bytes
    array.setflags(write=False)
    return array


def _check(values: FloatArray, who: str, what: str, ok: npt.NDArray[np.bool_], expected: str) -> None:
    bad = ~(ok & np.isfinite(values))
    if bad.any():
        index = int(bad.argmax())
        raise ScenarioError(f"{who} {index} has {what} {values[index]:g}; expected {expected}")
