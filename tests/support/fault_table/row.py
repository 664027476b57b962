"""A row of the fault table: what is declared and what goes wrong; and what became of it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from fault_table.project import POLICY
from mmrs_mavlink.sitl import SimulatedVehicle

Act = Callable[[SimulatedVehicle], object]

AT, LEG, AUTO, UP = "at its place", "on a leg (GUIDED)", "on a mission (AUTO)", "climbing"
"""Moments at which most faults happen."""


def leave_alone(vehicle: SimulatedVehicle) -> None:
    """Leave the vehicle alone: what goes wrong is elsewhere."""


def policy(event: str, response: str, after: float | None = None) -> POLICY:
    """Return what a model declares for an event."""
    return (event, response, after)


HASTE_SECONDS = 1.0
"""Real seconds that a busy machine may take for what takes none: at a speed-up of ten they are ten seconds
of the run, in real time nothing is added."""


def within(seconds: float, speedup: float) -> float:
    """Return the seconds of the run in which something must be answered, given those that are declared."""
    return seconds + HASTE_SECONDS * (speedup - 1.0)


@dataclass(frozen=True, slots=True)
class Row:
    """Something that goes wrong with one robot, or an order that it gets.

    Attributes:
        fault: in words.
        during: when it happens, one of `record.MOMENTS`.
        policy: what the model declares for it; None: nothing.
        strike: makes it happen.
        event: that ends the step log; empty: none may; several are separated by ``|``.
        ends: where the vehicle comes to rest, as `record.ending` says; ``done``: as if nothing had been.
        within: seconds of the run until the vehicle must answer; None: it need not do anything new.
        least: real seconds that it may take all the same: networks do not become faster with the run.
        mends: undoes the fault after so many seconds of the run, or adds to it.
        order: is given instead of a fault; resumes: seconds of the run after which ``resume`` follows.
        fast: whether it is among those that are always tested.
        hands_off: whether nothing but heartbeats may be sent once the controller has noticed.
        refuses: an order that is given then, and must not be obeyed.
        strikes_peer: whether the fault is that of the robot which this one waits for.
        stays: metres, sideways, from which the vehicle must not go away.
        suspends: whether the robot only comes down for a new battery, which is no fault in its log.
        responds: the response, where it cannot be that of the policy.
        says: what the process must say, where logs cannot.
        lasts: seconds of the run for which the vehicle must stay where it has come to rest.
        together: whether the order is given to all robots at once, by somebody else.
    """

    fault: str
    during: str
    policy: POLICY | None
    strike: Act
    event: str
    ends: str
    within: float | None = 5.0
    least: float = 0.0
    program: str = "tour"
    stay: float = 20.0
    settings: Mapping[str, object] = field(default_factory=dict)
    mends: tuple[float, Act] | None = None
    order: str = ""
    resumes: float | None = None
    fast: bool = False
    hands_off: bool = False
    refuses: str = ""
    strikes_peer: bool = False
    stays: float | None = None
    suspends: bool = False
    responds: str = ""
    says: str = ""
    lasts: float = 5.0
    together: bool = False

    @property
    def declared(self) -> str:
        """Return the policy in words."""
        if self.policy is None:
            return "nothing"
        event, response, after = self.policy
        return f"{event} → {response}" + (f" after {after:g} s" if after is not None else "")

    @property
    def title(self) -> str:
        """Return what tells this row from others."""
        return f"{self.fault}, {self.during}, {self.declared}"

    @property
    def rest(self) -> str:
        """Return where the vehicle must come to rest."""
        return "home" if self.ends == "done" else self.ends

    @property
    def response(self) -> str:
        """Return what the black box must have as the response; empty where it need not have any."""
        if self.order or not (self.event or self.suspends or self.responds):
            return ""
        declared = self.policy[1] if self.policy is not None else ""
        return self.responds or ("NOTHING" if self.hands_off else declared)


def answered_rows(
    fault: str,
    strike: Act,
    event: str,
    after: float | None,
    cases: Sequence[tuple[str, str, str]],
    *,
    fast: tuple[str, str] | None = None,
    **more: Any,
) -> list[Row]:
    """Return a row for each moment, response and end of a fault that a policy for its event answers.

    Args:
        fast: moment and response of the row that is always tested; None: none is.
        more: attributes of all rows.
    """
    return [
        Row(
            fault,
            during,
            policy(event, response, after),
            strike,
            event,
            ends,
            fast=(during, response) == fast,
            **more,
        )
        for during, response, ends in cases
    ]


@dataclass(slots=True)
class Outcome:
    """What became of a row: in words, in seconds of the run, by the logs; no `problems` if all is right.

    Attributes:
        answered: seconds until the vehicle did something else; rested: until it had come to rest.
        confirmed: real seconds until the robot confirmed its orders, by order.
        line: of the step log; decision: of the black box.
    """

    title: str
    declared: str
    happened: str = ""
    answered: float | None = None
    rested: float | None = None
    confirmed: dict[str, float] = field(default_factory=dict)
    line: str = ""
    decision: str = ""
    problems: list[str] = field(default_factory=list)
