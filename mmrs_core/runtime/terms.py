"""What a run goes by, and how it ended."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import inf

from mmrs_core.behaviour.replay import Outcome
from mmrs_core.behaviour.semantics import Waiting
from mmrs_core.contributions.execution import Fault
from mmrs_core.runtime.attention import Attention
from mmrs_core.runtime.orders import Orders
from mmrs_core.runtime.standing import Standing
from mmrs_runtime.records.steps import StepRecord

Observer = Callable[[StepRecord], None]


@dataclass(frozen=True, slots=True)
class Terms:
    """What a run goes by, whatever its robots do.

    Attributes:
        run: identifier of the run.
        incarnation: differs each time that these robots are started within a run.
        observe: called with each step before it has an effect; a log, for example.
        seconds: of the run's clock, after which it is cut off.
        steps: number of them after which it is cut off, since a Choice can go round for ever.
        resumed: the steps that were made before the run was broken off, those of a robot in order.
        unready: whether robots have still to get ready: each goes on, or begins, as soon as it is.
        suspends: whether a battery that is low, and whose policy brings the robot down, breaks its program
            off without a fault, so that the run can be resumed with a full one.
        patience: seconds for which the run then waits for the order to resume once nobody else works.
        attention: through which backends wake the interpreter; None in simulated time.
        orders: what people order meanwhile.
        say: tells people what goes on.
        standing: for people who ask how robots are.
    """

    run: str = "run-0"
    incarnation: str = "0"
    observe: Observer | None = None
    seconds: float = inf
    steps: int = 1_000_000
    resumed: tuple[StepRecord, ...] = ()
    unready: bool = False
    suspends: bool = False
    patience: float = 0.0
    attention: Attention | None = None
    orders: Orders = field(default_factory=Orders)
    say: Callable[[str], None] = lambda words: None
    standing: Standing = field(default_factory=Standing)


TO_THE_END = Terms()
"""Of a run that nobody is told of and that comes to its end, unless a Choice goes round for ever."""


@dataclass(frozen=True, slots=True)
class Ending:
    """How a run ended.

    Attributes:
        outcome: INCOMPLETE where a limit cut it off.
        waiting: the robots that waited for slots that nobody can set any more, when that first
            became certain; it stays when policies then end their waits by a fault.
        faults: by robot.
        unconfirmed: robots that did not confirm that they have stopped.
        time: seconds of the run's clock.
        steps: how many were made.
        suspended: robots whose programs were broken off, to be resumed with a full battery.
        responses: to faults, by robot.
        absent: robots that did not get ready and were told nothing; those of `suspended`, too.
        came_down: in words how robots came down for their batteries that have not gone on since; those of
            `suspended` that are not here are not known to have come down for that.
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
