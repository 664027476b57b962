"""One row of the fault table: what is declared, what goes wrong, and whether what then happened is right."""

from __future__ import annotations

import json
import signal
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import dist
from pathlib import Path

from fault_table.fleet import Fleet
from fault_table.project import POLICY, Pad
from fault_table.record import MOMENTS, Struck, answered, ending, story, struck, talked
from mmrs_core.sitl import SimulatedVehicle

REAL_SECONDS = 50.0
"""How long, for a whole batch, everything may take."""

HANDS_OFF_SECONDS = 3.0
"""Simulated seconds after which nothing may be said any more to a vehicle whose pilot has taken over: a
heartbeat shows the mode once a second."""

GUIDED = 4

STAYS_SECONDS = 5.0
"""Simulated seconds for which a vehicle must stay where it has come to rest."""


@dataclass(frozen=True, slots=True)
class Row:
    """A fault of one vehicle.

    Attributes:
        fault: in words.
        during: when it happens, one of `MOMENTS`.
        policy: what the model declares for it; None: nothing.
        strike: makes it happen.
        event: that ends the step log; empty: none may.
        ends: where the vehicle comes to rest, as `record.ending` says; ``done``: as if nothing had been.
        within: simulated seconds until the vehicle must answer; None: it need not do anything new.
        mends: undoes the fault after so many simulated seconds; (0, None): never.
        fast: whether it is among those that are always tested.
        hands_off: whether nothing but heartbeats may be sent once the controller has noticed.
        strikes_peer: whether the fault is that of the robot which this one waits for.
    """

    fault: str
    during: str
    policy: POLICY | None
    strike: Callable[[SimulatedVehicle], object]
    event: str
    ends: str
    within: float | None = 5.0
    program: str = "tour"
    stay: float = 20.0
    settings: Mapping[str, object] = field(default_factory=dict)
    mends: tuple[float, Callable[[SimulatedVehicle], object] | None] = (0.0, None)
    fast: bool = False
    hands_off: bool = False
    strikes_peer: bool = False

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


@dataclass(slots=True)
class Outcome:
    """What became of a row: in words, in seconds of the run, by the logs; no `problems` if all is right."""

    title: str
    execution: str
    declared: str
    happened: str = ""
    answered: float | None = None
    rested: float | None = None
    line: str = ""
    decision: str = ""
    problems: list[str] = field(default_factory=list)


def fly(rows: Sequence[Row], execution: str, folder: Path, speedup: float = 10.0) -> list[Outcome]:
    """Fly all rows at once, each with a robot of its own in one process; return what became of them."""
    pads, names = _pads(rows)
    settings = {name: row.settings for row, name in zip(rows, names, strict=True)}
    with Fleet(folder, pads, execution, speedup=speedup, settings=settings) as fleet:
        watches = [_Watch(row, name, fleet) for row, name in zip(rows, names, strict=True)]
        until = time.monotonic() + REAL_SECONDS
        while time.monotonic() < until and not all([watch.settled() for watch in watches]):
            time.sleep(0.02)
        for watch in watches:
            watch.observe()
        if fleet.running():
            fleet.signal(signal.SIGINT)
        code = fleet.end(30.0)
        outcomes = [watch.judged() for watch in watches]
        for outcome in outcomes:
            if code is None:
                outcome.problems.append("the process does not end when it is interrupted")
            if outcome.problems:
                outcome.problems.append("said: " + " | ".join(fleet.said[-12:]))
    return outcomes


def _pads(rows: Sequence[Row]) -> tuple[list[Pad], list[str]]:
    pads, names = [], []
    for number, row in enumerate(rows):
        name = f"r{number}"
        policies = (row.policy,) if row.policy is not None else ()
        pads.append(Pad(name, row.program, policies, row.stay))
        names.append(name)
        if row.program == "wait":
            pads.append(Pad(f"g{number}", "give", (), 120.0, gives=name))
    return pads, names


class _Watch:
    """Follows one vehicle: strikes when it is time, and sees where it comes to rest."""

    def __init__(self, row: Row, robot: str, fleet: Fleet) -> None:
        self._row, self._robot, self._fleet = row, robot, fleet
        self._vehicle = fleet.vehicles[robot]
        self._victim = fleet.vehicles[f"g{robot[1:]}"] if row.strikes_peer else self._vehicle
        self._target: tuple[float, float, float] | None = None
        self._turned: float | None = None
        self._struck: Struck | None = None
        self._mended = row.mends[1] is None
        self._rest: tuple[str, float] | None = None
        self._outcome = Outcome(row.title, fleet.execution, row.declared)

    def settled(self) -> bool:
        """Go on with it; return whether nothing more is to come."""
        pilot, row = self._vehicle.autopilot, self._row
        if self._struck is None:
            if MOMENTS[row.during](pilot):
                self._target = pilot.body.target
                row.strike(self._victim)
                self._struck = struck(self._vehicle)
            return False
        self._notice_turn()
        if not self._mended and pilot.time - self._struck.time > row.mends[0]:
            self._mended = True
            row.mends[1](self._victim)
        found = ending(self._vehicle, self._struck)
        if not found or self._rest is None or self._rest[0] != found:
            self._rest = (found, pilot.time) if found else None
            return False
        wanted = "home" if row.ends == "done" else row.ends
        return found == wanted and pilot.time - self._rest[1] > STAYS_SECONDS and self._logged()

    def _notice_turn(self) -> None:
        """Keep when the vehicle first went for another place than before, in GUIDED."""
        pilot = self._vehicle.autopilot
        new = pilot.body.target
        if self._turned is not None or self._struck is None or pilot.mode != GUIDED or new is None:
            return
        if self._target is None or dist(new, self._target) > 1.0:
            self._turned = pilot.time - self._struck.time

    def _logged(self) -> bool:
        steps = self._fleet.steps(self._robot)
        return bool(steps) and (steps[-1]["label"] == "fault" or self._row.ends == "done")

    def observe(self) -> None:
        """Keep what the vehicle has done, before anybody interrupts the process."""
        if self._struck is None:
            self._outcome.problems.append(f"never {self._row.during}: {self._vehicle.autopilot.modes}")
            return
        self._outcome.happened = story(self._vehicle, self._struck)
        times = [self._turned, answered(self._vehicle, self._struck)]
        self._outcome.answered = min((time for time in times if time is not None), default=None)
        self._outcome.rested = self._rest[1] - self._struck.time if self._rest else None
        found = self._rest[0] if self._rest else ""
        wanted = "home" if self._row.ends == "done" else self._row.ends
        if found != wanted:
            self._outcome.problems.append(f"should end {wanted}")
        if self._row.hands_off:
            self._check_hands_off(self._struck.time)
        late = self._outcome.answered is None or self._outcome.answered > (self._row.within or 0.0)
        if self._row.within is not None and late:
            self._outcome.problems.append(
                f"answered after {self._outcome.answered}, not {self._row.within} s"
            )

    def _check_hands_off(self, since: float) -> None:
        sent = talked(self._vehicle, since + HANDS_OFF_SECONDS)
        self._outcome.happened += f"; heard nothing but heartbeats after {HANDS_OFF_SECONDS:g} s"
        if sent:
            self._outcome.problems.append(f"the pilot is disturbed: {sent[:5]}")

    def judged(self) -> Outcome:
        """Return the outcome, with what the logs say."""
        steps, row, outcome = self._fleet.steps(self._robot), self._row, self._outcome
        faults = [step for step in steps if step["label"] == "fault"]
        outcome.line = json.dumps(faults[-1]) if faults else json.dumps(steps[-1]) if steps else ""
        if [step["detail"] for step in faults] != ([row.event] if row.event else []):
            outcome.problems.append(f"the step log has faults {faults}, not {row.event or 'none'}")
        if faults and steps[-1]["label"] != "fault":
            outcome.problems.append("steps follow the fault")
        decisions = [line for line in self._fleet.box(self._robot) if line["kind"] == "decision"]
        fitting = [d for d in decisions if row.event and row.event in (d.get("what", ""), d.get("why", ""))]
        outcome.decision = json.dumps((fitting or decisions or [{}])[-1])
        if (
            row.event
            and row.policy is not None
            and not any(d["response"] == row.policy[1] for d in decisions)
        ):
            outcome.problems.append(f"the black box has no decision to {row.policy[1]}: {decisions}")
        return outcome
