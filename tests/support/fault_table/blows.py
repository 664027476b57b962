"""The part of the fault table about what happens to the process, and so to all of its robots at once."""

import signal
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from patience import wait_for
from warm_python import FREEZE, THAW

from fault_table.fleet import Fleet
from fault_table.links import SILENCE
from fault_table.orders import RESUMED_AFTER, to_all
from fault_table.process import Process
from fault_table.row import Outcome, Row, leave_alone
from fault_table.trial import Blow, fly
from mmrs_runtime.orders.ordering import give

AT = "at its place"
INJECTED_AT = 40
"""Second of the run at which faults are injected: by then, robots are at their places."""

STAY = 60.0
STATION_SILENCE = 4.0
"""Real seconds that a robot bears silence of ground stations at least, with one in which they were heard."""

FROZEN_SECONDS = 30.0
"""Longer than a vehicle bears silence before it acts by itself, seconds of the run."""


@dataclass(frozen=True, slots=True)
class Drill:
    """Something that happens to a process.

    Attributes:
        rows: its robots.
        blow: what happens to it.
        until: when, after all robots are at their places; None: at once.
        arguments: of the process.
        speedup: seconds of the run in a second.
        fast: whether it is always tested.
        watched: whether somebody looks on by a ground station of their own.
    """

    name: str
    rows: tuple[Row, ...]
    blow: Blow
    until: Blow | None = None
    arguments: tuple[str, ...] = ()
    fast: bool = False
    speedup: float = 10.0
    watched: bool = False

    def fly(self, folder: Path) -> list[Outcome]:
        """Let it happen; return what became of its robots."""
        return fly(
            self.rows,
            folder,
            speedup=self.speedup,
            until=self.until,
            blow=self.blow,
            arguments=self.arguments,
            watched=self.watched,
        )


def _kill(fleet: Fleet, process: Process) -> None:
    process.signal(signal.SIGKILL)


def _freeze(fleet: Fleet, process: Process) -> None:
    process.signal(FREEZE)
    threading.Timer(FROZEN_SECONDS / fleet.speedup, process.signal, (THAW,)).start()


def _interrupt(fleet: Fleet, process: Process) -> None:
    process.signal(signal.SIGINT)


def _kill_station(fleet: Fleet, process: Process) -> None:
    assert fleet.station is not None
    fleet.station.signal(signal.SIGKILL)


def _nothing(fleet: Fleet, process: Process) -> None:
    """Leave it to --inject."""


def _injected(fleet: Fleet, process: Process) -> None:
    """Wait until what was asked for with --inject begins."""
    wait_for(lambda: any("begins" in line for line in process.said) or not process.running(), 20.0)


def _injection(name: str, rows: tuple[Row, ...], faults: str) -> Drill:
    return Drill(name, rows, _nothing, _injected, ("--inject", faults))


def _link_lost(
    fault: str, cases: Sequence[tuple[str, str]], after: float, event: str = "", within: float | None = None
) -> tuple[Row, ...]:
    return tuple(
        Row(
            fault,
            AT,
            ("LINK_LOST", response, after),
            leave_alone,
            event,
            ends,
            within=within,
            least=SILENCE,
            stay=STAY,
        )
        for response, ends in cases
    )


def _ground_lost(
    fault: str, cases: Sequence[tuple[str, str]], after: float, within: float | None = None
) -> tuple[Row, ...]:
    """Return rows about people's own ground station: who carries on needs not answer, but has it recorded."""
    return tuple(
        Row(
            fault,
            AT,
            ("GROUND_LOST", response, after),
            leave_alone,
            "" if ends == "done" else "GROUND_LOST",
            ends,
            within=None if ends == "done" else within,
            least=STATION_SILENCE,
            stay=STAY,
            responds="CONTINUE" if response == "CONTINUE" else "",
        )
        for response, ends in cases
    )


def _full_disk() -> tuple[Row, ...]:
    cases = (("RETURN", "home"),)
    return tuple(
        Row(
            "disk full",
            AT,
            ("LOG_FAILED", response, None),
            leave_alone,
            "|LOG_FAILED",
            ends,
            within=60.0,
            stay=STAY / 2,
            says="LOG_FAILED",
        )
        for response, ends in cases
    )


def _interruption(how: str, ends: str) -> Drill:
    within = None if how == "hold" else 5.0
    row = Row(f"Ctrl-C, --on-stop {how}", AT, None, leave_alone, "STOPPED", ends, within=within, stay=STAY)
    return Drill(f"interrupted, --on-stop {how}", (row,), _interrupt, None, ("--on-stop", how))


def _order_all(order: str, *, resumes: bool = False) -> Drill:
    """Return a drill in which all robots of a process get an order at once, each in another state."""

    def give_to_all(fleet: Fleet, process: Process) -> None:
        fleet.replies += give(fleet.logs, order)
        if resumes:
            time.sleep(RESUMED_AFTER / fleet.speedup)
            fleet.replies += give(fleet.logs, "resume")

    rows = tuple(row for row in to_all(order, resumes=resumes))
    return Drill(rows[0].fault, rows, give_to_all, speedup=4.0)


def _piloted(order: str, event: str) -> Row:
    """Return a row in which a pilot has the vehicle as the process is interrupted, and keeps it."""
    return Row(
        "pilot's stick, then Ctrl-C for the others",
        AT,
        ("LINK_LOST", order, 5.0),
        lambda vehicle: vehicle.faults.begin("stick", "loiter"),
        event,
        "holds",
        within=None,
        stay=STAY,
        hands_off=True,
        lasts=FROZEN_SECONDS,
    )


def _interrupt_soon(fleet: Fleet, process: Process) -> None:
    """Interrupt it once it has seen what pilots do."""
    time.sleep(1.0)
    process.signal(signal.SIGINT)


def _unlocated() -> tuple[Row, ...]:
    return tuple(
        Row(
            "satellites lost by --inject",
            AT,
            ("POSITION_LOST", response, None),
            leave_alone,
            "POSITION_LOST",
            "here",
            within=4.0,
            least=1.0,
            stay=STAY,
            responds="LAND",
        )
        for response in ("HOLD",)
    )


BY_ITSELF = [("RETURN", "home"), ("LAND", "here")]
UNHARMED = [("RETURN", "done")]
WATCHED = [("RETURN", "home"), ("CONTINUE", "done")]
POOR_SPEEDUP = 2.0
"""A repetition waits for its answer in real seconds, which at a speed-up of ten are ten of the run each: what
is lost would cost ten times as much of the time that a vehicle has for anything."""

POOR = f"loss=0.1,delay=0.3~0.3,duplicate=0.1,corrupt=0.05,seed=7,cut@{INJECTED_AT}+2"

DRILLS: tuple[Drill, ...] = (
    Drill(
        "ground station killed",
        _link_lost("ground station killed", BY_ITSELF, 5.0, within=10.0),
        _kill,
        fast=True,
    ),
    Drill(
        "ground station frozen",
        _link_lost("ground station frozen for 30 s", BY_ITSELF[:1], 5.0, "LINK_LOST|TAKEN_OVER", 10.0),
        _freeze,
    ),
    Drill(
        "ground station of the operators killed",
        _ground_lost("ground station of the operators killed", WATCHED, 10.0, 15.0),
        _kill_station,
        watched=True,
        fast=True,
    ),
    Drill(
        "ground station of the operators not heard",
        _ground_lost("ground station of the operators not heard (--inject)", [("LAND", "here")], 10.0, 15.0),
        _nothing,
        _injected,
        ("--inject", f"ground-cut@{INJECTED_AT}"),
        watched=True,
    ),
    Drill(
        "ground station of the operators not heard for a moment",
        _ground_lost("ground station of the operators not heard for 20 s (--inject)", UNHARMED, 60.0),
        _nothing,
        _injected,
        ("--inject", f"ground-cut@{INJECTED_AT}+20"),
        watched=True,
    ),
    _injection("satellites lost by --inject", _unlocated(), f"gps-lost@{INJECTED_AT}"),
    _injection("disk full", _full_disk(), f"disk-full@{INJECTED_AT}"),
    _injection(
        "wall clock jumps back",
        _link_lost("wall clock jumps back by an hour", UNHARMED, 10.0),
        f"clock-jump@{INJECTED_AT}-3600",
    ),
    _injection(
        "process frozen for a moment",
        _link_lost("process frozen for 4 s", UNHARMED, 30.0),
        f"freeze@{INJECTED_AT}+4",
    ),
    Drill(
        "poor link",
        _link_lost("a tenth of all lost, doubled, late or damaged", UNHARMED, 30.0),
        _nothing,
        _injected,
        ("--tries", "12", "--inject", POOR),
        speedup=POOR_SPEEDUP,
    ),
    Drill("pilot's stick, then Ctrl-C", (_piloted("RETURN", "TAKEN_OVER"),), _interrupt_soon),
    _order_all("hold"),
    _order_all("hold", resumes=True),
    _order_all("stop"),
    *(_interruption(how, ends) for how, ends in (("hold", "holds"), ("return", "home"))),
)
