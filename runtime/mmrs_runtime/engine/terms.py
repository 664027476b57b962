"""What a run goes by, who tells it that there is news, and how it ended."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import inf

from ..orders.orders import Orders
from ..records.disk import Kept
from ..records.steps import StepRecord
from ..semantics import Outcome, Waiting
from ..vehicle import Event, Fault, Progress
from .clocks import RunClock
from .status import StatusBoard

Observer = Callable[[StepRecord], None]
Syncer = Callable[[str, Kept], None]

BUS = ""
"""Stands for the bus, where otherwise the identifier of a robot stands."""


class Attention:
    """Collects events of robots and the bus, and wakes the engine."""

    def __init__(self, clock: RunClock) -> None:
        self._clock = clock
        self._called: deque[tuple[str, Event]] = deque()

    def call(self, who: str, event: Event | None = None) -> None:
        """Report an event of a robot or the bus; from any thread or signal handler."""
        self._called.append((who, event or Progress()))
        self._clock.wake()

    def for_robot(self, robot: str) -> Callable[[], None]:
        """Return a function that says that this robot has news."""
        return lambda: self.call(robot)

    def taken(self) -> list[tuple[str, Event]]:
        """Return the events since the last call, in their order."""
        found: list[tuple[str, Event]] = []
        while self._called:
            found.append(self._called.popleft())
        return found


@dataclass(frozen=True, slots=True)
class Terms:
    """Conditions of a run, whatever its robots do.

    Attributes:
        run: identifier of the run.
        incarnation: differs each time that these robots are started within a run.
        observe: called with each step before it has an effect; a log, for example.
        sync: writes all observed steps of a robot to the disk, and then calls, from any thread, its
            argument; no notify is sent before. None: nothing is kept.
        seconds: of the run's clock, after which it is cut off.
        steps: number of them after which it is cut off, since a Choice can loop forever.
        resumed: the steps that were made before the run was broken off, those of a robot in order.
        unready: whether robots have still to get ready: each continues, or begins, as soon as it is.
        suspends: whether a battery that is low, and whose policy lands the robot, breaks its program
            off without a fault, so that the run can be resumed with a full one.
        patience: seconds for which the run then waits for the order to resume once no other robot works.
        attention: through which vehicles and the bus wake the engine; None: they do not.
        orders: orders of operators.
        say: reports events to the operator.
        status_board: status of the robots, for queries.
    """

    run: str = "run-0"
    incarnation: str = "0"
    observe: Observer | None = None
    sync: Syncer | None = None
    seconds: float = inf
    steps: int = 1_000_000
    resumed: tuple[StepRecord, ...] = ()
    unready: bool = False
    suspends: bool = False
    patience: float = 0.0
    attention: Attention | None = None
    orders: Orders = field(default_factory=Orders)
    say: Callable[[str], None] = lambda words: None
    status_board: StatusBoard = field(default_factory=StatusBoard)


TO_THE_END = Terms()
"""Terms of an unobserved run that comes to its end, unless a Choice loops forever."""


@dataclass(frozen=True, slots=True)
class Ending:
    """How a run ended.

    Attributes:
        outcome: INCOMPLETE where a limit cut it off.
        waiting: the robots that waited for slots that can never be set, when that first
            became certain; it stays when policies then end their waits by a fault.
        faults: by robot.
        unconfirmed: robots that did not confirm that they have stopped.
        time: seconds of the run's clock.
        steps: how many were made.
        suspended: robots whose programs were broken off, to be resumed with a full battery.
        responses: to faults, by robot.
        absent: robots that did not get ready and received no command; those of `suspended`, too.
        came_down: in words how robots landed for their batteries that have not continued since; those of
            `suspended` that are not here are not known to have landed for that.
        lost: robots whose links were lost, for a time at least, when they were to stop, or had.
    """

    outcome: Outcome
    waiting: tuple[Waiting, ...]
    faults: Mapping[str, Fault]
    unconfirmed: tuple[str, ...]
    time: float
    steps: int
    suspended: tuple[str, ...] = ()
    responses: Mapping[str, str] = field(default_factory=dict)
    came_down: Mapping[str, str] = field(default_factory=dict)
    absent: tuple[str, ...] = ()
    lost: tuple[str, ...] = ()
