"""What every robot does, step by step."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from mmrs_core.scene.primitives import Position
from mmrs_core.scene.works import Stroke


@dataclass(frozen=True, slots=True)
class Step:
    """One item of a robot's plan, with the estimated times at which it begins and ends.

    Attributes:
        begin, end: seconds after the mission's start.
        task: the task that it serves or leads to; empty: none in particular.
    """

    begin: float
    end: float
    task: str


@dataclass(frozen=True, slots=True)
class Launch(Step):
    """Leaves home: from `at` on the ground straight up to the height `up`."""

    at: Position
    up: float


@dataclass(frozen=True, slots=True)
class Transit(Step):
    """Travels along straight legs; `route` begins where the robot is, at least two points.

    `speed`: commanded, metres per second; None: the robot's cruise.
    """

    route: tuple[Position, ...]
    speed: float | None = None


@dataclass(frozen=True, slots=True)
class Serve(Step):
    """Does a stroke; the robot is at its first point. `speed`: commanded, metres per second.

    `first` and `last` tell the robot's first and last stroke of this task.
    """

    stroke: Stroke
    speed: float
    rule: str
    first: bool = False
    last: bool = False


@dataclass(frozen=True, slots=True)
class Await(Step):
    """Waits, where it is, until every one of these signals was given.

    `until` is an earliest time that a clock, not a robot, ends the wait at; None: none.
    """

    signals: tuple[str, ...]
    until: float | None = None


@dataclass(frozen=True, slots=True)
class Signal(Step):
    """Notifies other robots that this one's part of `task` has ended.

    Attributes:
        signal: unique in the plan.
        receivers: names of the robots that await it, at least one, not this one.
    """

    signal: str
    receivers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Recover(Step):
    """Comes down where it is, from `at` to the height `up` of the ground there."""

    at: Position
    up: float


@dataclass(frozen=True, slots=True)
class Recharge(Step):
    """Waits at home for full batteries, after a recovery and before the next launch."""


@dataclass(frozen=True, slots=True)
class Branch(Step):
    """Does one of several sequences of steps, by conditions tested in order.

    Attributes:
        arms: (condition, steps); the condition of the last arm is None: the else arm. Every arm
            begins where the robot is and ends at `exit`.
    """

    arms: tuple[tuple[str | None, tuple[Step, ...]], ...]
    exit: Position


def all_steps(steps: Iterable[Step]) -> Iterator[Step]:
    """Yield steps in order, and after a choice all that is in its arms."""
    for step in steps:
        yield step
        if isinstance(step, Branch):
            for _, arm in step.arms:
                yield from all_steps(arm)


@dataclass(frozen=True, slots=True)
class RobotPlan:
    """What one robot does.

    Attributes:
        steps: in order; empty for a robot that is not needed.
        length: metres travelled; busy: seconds from launch to the last recovery; energy: joules,
            None where nothing is known of its power; sorties: how many times it leaves home.
        idle: why it has nothing to do; empty for a robot that has.
    """

    robot: str
    steps: tuple[Step, ...]
    length: float = 0.0
    busy: float = 0.0
    energy: float | None = 0.0
    sorties: int = 0
    idle: str = ""


@dataclass(frozen=True, slots=True)
class Omission:
    """What is not done of a task, since robots must keep away from there.

    Attributes:
        task: its name.
        amount: metres of a line, square metres of an area.
        unit: "m" or "m²".
        where: in words.
        at: middle of a stretch of a line, or a place within a part of an area.
    """

    task: str
    amount: float
    unit: str
    where: str
    at: Position

    def __str__(self) -> str:
        """Return it in one line.

        >>> str(Omission("road", 4.5, "m", "from 118.0 m along it, too near to 'mast'", (9.0, 9.0, 0.0)))
        "task 'road' leaves out 4.5 m from 118.0 m along it, too near to 'mast'"
        """
        return f"task '{self.task}' leaves out {self.amount:.1f} {self.unit} {self.where}"


@dataclass(frozen=True, slots=True)
class Plan:
    """A plan: which robot does what, when and along which route.

    Attributes:
        robots: in the scene's order, robots without work included.
        makespan: seconds until the last robot has finished.
        begins, ends: by task, seconds after the mission's start.
        notes: assumptions to show, such as flat terrain.
        left_out: what is not done of tasks, since it cannot be reached.
        lower_bound: seconds that no plan's makespan by the planner's times falls below; 0: nothing is known.
        planned: makespan by the planner's times, where `makespan` is another; 0: it is the same.
        earliest: by task: seconds before which it does not begin in the plan, so that robots wait at home.
        unseparated: makespan of the best plan found in which robots need not keep apart; 0: there is none.
        timed: whether its robots stop at every corner, as in `Scene`.
    """

    robots: tuple[RobotPlan, ...]
    makespan: float
    begins: Mapping[str, float]
    ends: Mapping[str, float]
    notes: tuple[str, ...] = ()
    left_out: tuple[Omission, ...] = ()
    lower_bound: float = 0.0
    planned: float = 0.0
    unseparated: float = 0.0
    earliest: Mapping[str, float] = field(default_factory=dict)
    timed: bool = False
