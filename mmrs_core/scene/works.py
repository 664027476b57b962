"""What a task is made of for one robot: strokes, and what is done along them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import compress, pairwise
from math import ceil, dist

from mmrs_core.scene.primitives import Position, Ring


@dataclass(frozen=True, slots=True)
class ActionAt:
    """A device action along a stroke.

    Attributes:
        at: arc length from the stroke's first point, metres.
        device: identifier of the device; empty: the only one of the robot that supports the action.
        parameters: (key, value) pairs.
    """

    at: float
    action: str
    device: str = ""
    parameters: tuple[tuple[str, str], ...] = ()


DISTANCE = "distance"
"""Parameter of an action that is repeated while the robot moves, at once and whenever it has gone these
metres; 0 ends this, with a last time."""


@dataclass(frozen=True, slots=True)
class Repetition:
    """A device action that is repeated along a stroke, which the robot moves along without a stop.

    It is done where it begins, after each `every` metres, and where it ends.

    Attributes:
        every: metres.
        action: that takes the parameter ``distance``.
        device: identifier of the device.
        before: metres of the stroke before it begins. after: those after it has ended.
    """

    every: float
    action: str
    device: str
    before: float = 0.0
    after: float = 0.0

    def times(self, length: float) -> int:
        """Return how often it is done along a stroke of a length, metres."""
        return ceil((length - self.before - self.after) / self.every - 1e-6) + 1


@dataclass(frozen=True, slots=True)
class Look:
    """What a device points at during a stroke: a position, with the angle of BL's Heading in degrees."""

    at: Position
    device: str = ""
    angle_degrees: float = 0.0


@dataclass(frozen=True, slots=True)
class Stroke:
    """A stretch of work that is done in one go, in this direction unless reversible.

    Attributes:
        points: (east, north, up), at least one; consecutive points are joined by straight lines.
        actions: ordered by arc length; the robot stops for each.
        repetition: what is done along it without a stop; None: nothing.
        look: orientation during the stroke and while holding; None: the direction of travel.
        speed: largest speed on it, metres per second; None: the robot's cruise.
        slow_down: factor on the robot's cruise speed, 0 to 1; None: 1. QUICK work has speed=inf.
        hold: seconds to hold at the last point, after which actions there are done.
        cuts: arc lengths inside the stroke at which the work may be split, ascending.
        reversible: whether it may be done from its last point to its first.
        object: description of an object to go up to after the last point; None: none.
        object_distance: metres from it at the end; object_tolerance: how far it may be from the
            last point, metres, None where unknown.
        settles: whether the robot stops at both ends, to turn and settle, though it could pass.
        part: which part of the task it does, such as "row 3"; empty: the one with these points. Robots of
            different sorts share a task by it.
        stretch: from where to where it does that part, in a measure that is the same for all robots.
    """

    points: tuple[Position, ...]
    actions: tuple[ActionAt, ...] = ()
    look: Look | None = None
    speed: float | None = None
    slow_down: float | None = None
    hold: float = 0.0
    cuts: tuple[float, ...] = ()
    reversible: bool = False
    object: str | None = None
    object_distance: float = 0.0
    object_tolerance: float | None = None
    part: str = ""
    stretch: tuple[float, float] = (0.0, 1.0)
    repetition: Repetition | None = None
    settles: bool = False

    @property
    def length(self) -> float:
        """Return the metres along its points."""
        return sum(dist(one, two) for one, two in pairwise(self.points))

    @property
    def commands(self) -> tuple[ActionAt, ...]:
        """Return its actions, and those that begin and end its repetition."""
        if self.repetition is None:
            return self.actions
        each = self.repetition
        begin = ActionAt(each.before, each.action, each.device, ((DISTANCE, f"{each.every:.3f}"),))
        end = ActionAt(self.length - each.after, each.action, each.device, ((DISTANCE, "0"),))
        return (begin, *self.actions, end)

    @property
    def spots(self) -> tuple[float, ...]:
        """Return the arc lengths at which actions are done, once or repeatedly."""
        own = tuple(action.at for action in self.actions)
        if self.repetition is None:
            return own
        length, each = self.length, self.repetition
        repeated = (each.before + index * each.every for index in range(each.times(length) - 1))
        return tuple(sorted((*own, *repeated, length - each.after)))


@dataclass(frozen=True, slots=True)
class Coverage:
    """What area a work covers, for checks and reports.

    Attributes:
        shell, holes: the polygon asked for, (east, north).
        target: the parts of it that the robot's clearance leaves, as (shell, holes) polygons.
        width: of the strip that a stroke covers, metres, centred on the stroke; length: of what one
            action covers along the stroke, centred on the action's point; 0 where actions do not matter.
    """

    shell: Ring
    holes: tuple[Ring, ...]
    target: tuple[tuple[Ring, tuple[Ring, ...]], ...]
    width: float
    length: float


@dataclass(frozen=True, slots=True)
class Gap:
    """A stretch of a line that a work leaves out, since it is too near to an area, or closed in by areas.

    Attributes:
        line: which line, such as "the line" or "row 3".
        begin: where it begins, metres along that line; length: of it, metres.
        at: its middle, (east, north, up).
        area: names of what it is too near to. closed_in: whether that is around it instead.
    """

    line: str
    begin: float
    length: float
    at: Position
    area: str
    closed_in: bool = False


@dataclass(frozen=True, slots=True)
class Work:
    """What a task is made of for one robot; leaves open who does it, when, and how to get there.

    Attributes:
        strokes: in an order that is good to follow; hops between them are routed by the planner.
        divisible: whether several robots, or several sorties, may share the strokes.
        ordered: whether the strokes must be done in this order.
        rule: name of the rule that made it.
        entry: where the first share begins before its first stroke; None: at the first stroke.
        coverage: for works over an area.
        gaps: what is left out of lines, since it cannot be followed.
        notes: what users should know of it, such as what it costs that a device lacks; shown with the plan
            after the names of task and robot.
        relays: whether the robot stays where the work ends, as a relay of its type's `relayRange`, until no
            other robot needs it; it then does nothing else.
    """

    strokes: tuple[Stroke, ...]
    divisible: bool
    rule: str
    ordered: bool = True
    entry: Position | None = None
    coverage: Coverage | None = None
    gaps: tuple[Gap, ...] = ()
    notes: tuple[str, ...] = ()
    relays: bool = False


class SharedWorks(Mapping[tuple[str, str], Work]):
    """Works by (task name, robot name); robots of one sort share theirs, so that pairs take no room.

    Attributes:
        sorts: by robot: number of its sort.
    """

    def __init__(self, sorts: Mapping[str, int]) -> None:
        """Begin without works."""
        self.sorts = sorts
        self._everyone = tuple(sorts)
        self._places = {robot: i for i, robot in enumerate(sorts)}
        self._works: dict[str, tuple[Sequence[Work | None], bytes]] = {}

    def add(self, task: str, works: Sequence[Work | None], able: bytes) -> None:
        """Add the works of a task, by sort; able: 1 for each robot that can do it, else 0."""
        self._works[task] = (works, b"" if all(able) else able)

    def able(self, task: str) -> tuple[str, ...]:
        """Return the robots that have work for a task, in the order of the sorts' robots."""
        if task not in self._works:
            return ()
        able = self._works[task][1]
        return tuple(compress(self._everyone, able)) if able else self._everyone

    def __getitem__(self, pair: tuple[str, str]) -> Work:
        """Return the work of a robot for a task."""
        task, robot = pair
        works, able = self._works[task]
        work = works[self.sorts[robot]]
        if work is None or (able and not able[self._places[robot]]):
            raise KeyError(pair)
        return work

    def __iter__(self) -> Iterator[tuple[str, str]]:
        """Yield the pairs that have work."""
        return ((task, robot) for task in self._works for robot in self.able(task))

    def __len__(self) -> int:
        """Return how many pairs have work."""
        return sum(len(self.able(task)) for task in self._works)

    def distinct(self) -> Iterator[Work]:
        """Yield each work of a task and a sort of robots once."""
        return (work for works, _ in self._works.values() for work in works if work is not None)


def distinct_works(works: Mapping[tuple[str, str], Work]) -> Iterable[Work]:
    """Return all works, each at least once, and seldom more often."""
    return works.distinct() if isinstance(works, SharedWorks) else works.values()
