"""The problem instance: tasks with a place, workload and deadline; robots with a start, capacity and speed."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import ScenarioError
from mrta_zoo.wording import composed, counted

FloatArray = npt.NDArray[np.float64]

SMALLEST, LARGEST = 1e-12, 1e12
"""What a positive quantity may be: times and distances made of such numbers neither overflow nor vanish."""
# Besides what steers terminals, what turns round all that follows, in browsers, too.
UNSAID = (math.nan, math.nan)
"""A map's size or origin that follows from the places on it."""
DEFAULT_SIZE = (100.0, 100.0)
_UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
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
        map_size: width and height of the map, > 0. By default 100 and 100 or, if that does not hold every place, those
            of the square that does, see `square_around`.
        name: what files, tables and pictures call this scenario.
        map_origin: the map's lowest x and y, which may be negative. By default 0 and 0 or, where the map would not
            hold every place then, the least whole x and y of all places, see `map_origin_for`.
        task_names: what people call the tasks, each differently; none if they have no names but their numbers.
        robot_names: likewise for the robots.

    Raises:
        ScenarioError: if an array has the wrong shape, or a value is out of range: positive numbers must lie between
            `SMALLEST` and `LARGEST`, coordinates within `LARGEST` of 0, and none may be NaN or infinite.
    """

    task_xy: FloatArray
    deadline: FloatArray
    workload: FloatArray
    robot_xy: FloatArray
    capacity: FloatArray
    speed: FloatArray = field(default_factory=lambda: np.empty(0))
    map_size: tuple[float, float] = UNSAID
    name: str = "scenario"
    map_origin: tuple[float, float] = UNSAID
    task_names: tuple[str, ...] = ()
    robot_names: tuple[str, ...] = ()

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
                    f"{attribute} has shape {getattr(self, attribute).shape}; with {counted(n, 'deadline')} and "
                    f"{counted(m, 'capacity', 'capacities')} it must be {shape}"
                )
        size, origin = _map_of(np.concatenate((self.task_xy, self.robot_xy)), self.map_size, self.map_origin)
        object.__setattr__(self, "map_size", _pair(size, "map_size", SMALLEST, f"two finite numbers > 0{BOUNDS}"))
        if _is_unsaid(origin):
            origin = map_origin_for(np.concatenate((self.task_xy, self.robot_xy)), self.map_size)
        within = f"two numbers from {-LARGEST:g} to {LARGEST:g}"
        object.__setattr__(self, "map_origin", _pair(origin, "map_origin", -LARGEST, within))
        for who, what in (("task", "deadline"), ("robot", "capacity"), ("robot", "speed")):
            values = getattr(self, what)
            _check(values, who, what, values > 0, "a finite number > 0")
            _check(values, who, what, (values >= SMALLEST) & (values <= LARGEST), f"a number > 0{BOUNDS}")
        _check(self.workload, "task", "workload", self.workload >= 0, "a finite number >= 0")
        _check(self.workload, "task", "workload", self.workload <= LARGEST, f"a number from 0 to {LARGEST:g}")
        for who, places in (("task", self.task_xy), ("robot", self.robot_xy)):
            for letter, values, low, high in zip("xy", places.T, self.map_origin, self.map_end, strict=True):
                inside = (values >= low) & (values <= high)
                _check(values, who, letter, inside, f"a number from {low:g} to {high:g}, inside the map")
        object.__setattr__(self, "task_names", as_names(self.task_names, "task", n))
        object.__setattr__(self, "robot_names", as_names(self.robot_names, "robot", m))

    @property
    def num_tasks(self) -> int:
        """N, the number of tasks."""
        return len(self.deadline)

    @property
    def num_robots(self) -> int:
        """M, the number of robots."""
        return len(self.capacity)

    @property
    def map_end(self) -> tuple[float, float]:
        """The map's highest x and y."""
        (x, y), (width, height) = self.map_origin, self.map_size
        return x + width, y + height

    def task_name(self, task: int) -> str:
        """What people call a task: its name, or its number."""
        return self.task_names[task] if self.task_names else str(task)

    def robot_name(self, robot: int) -> str:
        """What people call a robot: its name, or "robot" and its number."""
        return self.robot_names[robot] if self.robot_names else f"robot {robot}"

    def task_label(self, task: int) -> str:
        """A task for messages about code or files, where it is a number: that and, if it has one, its name."""
        return f"{task} ({self.task_names[task]})" if self.task_names else str(task)

    def robot_label(self, robot: int) -> str:
        """A robot likewise."""
        return f"{robot} ({self.robot_names[robot]})" if self.robot_names else str(robot)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[object, ...]:
        arrays = (self.task_xy, self.deadline, self.workload, self.robot_xy, self.capacity, self.speed)
        said = (self.name, self.map_size, self.map_origin, self.task_names, self.robot_names)
        return (*said, *(array.tobytes() for array in arrays))

    def __reduce__(self) -> tuple[type[Scenario], tuple[object, ...]]:
        # Through the constructor, so that a copy is checked and read-only, too.
        return type(self), tuple(getattr(self, each.name) for each in fields(self))

    @property
    def size(self) -> str:
        """How many tasks and robots, in words."""
        return f"{counted(self.num_tasks, 'task')}, {counted(self.num_robots, 'robot')}"

    def __repr__(self) -> str:
        return f"Scenario({self.name!r}, {self.size})"


def map_origin_for(places: FloatArray, map_size: tuple[float, float]) -> tuple[float, float]:
    """Where a map lies that says only how large it is.

    At 0 and 0 or, if some coordinate is negative or no place lies on the map then, as in surveys, at the least whole
    x and y of all places, provided that it holds every place there.

    Args:
        places: (P, 2) at least one place.
        map_size: the map's width and height.
    """
    on_map = (places <= map_size).all(axis=1)
    if (places < 0).any() or not on_map.any():
        corner = np.floor(places.min(axis=0))
        if (places <= corner + map_size).all():
            return float(corner[0]), float(corner[1])
    return 0.0, 0.0


def square_around(places: FloatArray) -> tuple[tuple[float, float], tuple[float, float]]:
    """Size and origin of the map of a mission that names none.

    The smallest square with a whole side >= 1 that holds every place from 0 and 0 on; or from their least whole x and y
    on, if one is negative, or that square would be more than twice as large.

    Args:
        places: (P, 2) at least one place.
    """

    def side(origin: FloatArray) -> float:
        return max(1.0, float(np.ceil((places - origin).max())))  # which stays a float, however large

    origin = np.zeros(2)
    corner = np.floor(places.min(axis=0))
    if corner.min() < 0 or side(origin) > 2 * side(corner):
        origin = corner
    return (side(origin),) * 2, (float(origin[0]), float(origin[1]))


def _map_of(places: FloatArray, size: Any, origin: Any) -> tuple[Any, Any]:
    """Size and origin of the map as far as they are said or, where the default map does not hold all, follow."""
    if not _is_unsaid(size):
        return size, origin
    if _is_unsaid(origin) and np.isfinite(places).all():
        least = np.array(map_origin_for(places, DEFAULT_SIZE))
        if not ((places >= least) & (places <= least + DEFAULT_SIZE)).all():
            return square_around(places)
    return DEFAULT_SIZE, origin


def _is_unsaid(pair: Any) -> bool:
    return isinstance(pair, tuple) and len(pair) == 2 and all(isinstance(each, float) and each != each for each in pair)


def usable_name(name: object) -> str:
    """The name of a task or robot as text without blanks around it, accents composed; "" if it cannot be one."""
    if not isinstance(name, (str, int, np.integer)) or isinstance(name, bool):
        return ""
    text = composed(str(name).strip())
    return "" if _UNPRINTABLE.search(text) else text


def as_names(names: Iterable[object], who: str, count: int) -> tuple[str, ...]:
    """Names of `count` tasks or robots as text, numbers being names, too; none if they are the numbers from 0 on.

    Raises:
        ScenarioError: if they are not as many, not texts, empty, not all different, or hold control characters.
    """
    expected = f"a different text for each of the {count} {who}s, or nothing"
    if isinstance(names, (str, bytes)) or not isinstance(names, Iterable):
        raise ScenarioError(f"{who}_names is {names!r}; expected {expected}")
    given = tuple(names)
    if not given:
        return ()
    if len(given) != count:
        raise ScenarioError(f"{who}_names has {counted(len(given), 'name')}; expected {expected}")
    seen: dict[str, int] = {}
    for index, name in enumerate(given):
        text = usable_name(name)
        if not text:
            raise ScenarioError(f"{who} {index} has the name {name!r}; expected text without control characters")
        if text in seen:
            raise ScenarioError(f"{who} {index} has the name {text!r}, as {who} {seen[text]}; expected {expected}")
        seen[text] = index
    return () if all(name == str(index) for name, index in seen.items()) else tuple(seen)


def _pair(value: Any, attribute: str, least: float, expected: str) -> tuple[float, float]:
    try:
        x, y = (float(each) + 0.0 for each in value)
    except (TypeError, ValueError):
        x = y = math.nan
    if not (least <= x <= LARGEST and least <= y <= LARGEST):
        raise ScenarioError(f"{attribute} is {value!r}; expected {expected}")
    return x, y


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
