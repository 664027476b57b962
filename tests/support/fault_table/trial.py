"""Flies rows of the fault table, all at once, and says what became of them."""

import signal
from collections.abc import Callable, Sequence
from pathlib import Path

from patience import wait_for

from fault_table.fleet import GENERATED, Fleet
from fault_table.process import Process
from fault_table.project import Pad
from fault_table.row import Outcome, Row
from fault_table.watch import Watch
from mmrs_core.errors import MmrsError

GOODBYE_SECONDS, LEAST_GOODBYE_SECONDS = 8.0, 3.0
"""After how long a process that stays with vehicles of pilots is interrupted again, of the run and real."""

REAL_SECONDS, RUN_SECONDS = 50.0, 240.0
"""How long everything may take, at least: real seconds, and those of the run."""

Blow = Callable[[Fleet, Process], object]
"""Something that happens to the process, and so to all robots at once."""


def fly(
    rows: Sequence[Row],
    folder: Path,
    *,
    speedup: float = 10.0,
    until: Blow | None = None,
    blow: Blow | None = None,
    arguments: Sequence[str] = (),
    watched: bool = False,
) -> list[Outcome]:
    """Fly all rows at once, each with a robot of its own in one process; return what became of them.

    Args:
        rows: to be flown.
        folder: for all files.
        speedup: seconds of the run in a second.
        until: waits, once all robots are where their rows want them.
        blow: happens to the process then; None: things happen to the vehicles, one by one.
        arguments: of the process.
        watched: whether somebody looks on by a ground station.
    """
    patience = max(REAL_SECONDS, RUN_SECONDS / speedup)
    pads, names = _pads(rows)
    settings = {name: row.settings for row, name in zip(rows, names, strict=True)}
    with Fleet(folder, pads, GENERATED, speedup=speedup, settings=settings, watched=watched) as fleet:
        process = fleet.start(*arguments)
        watches = [Watch(row, name, fleet) for row, name in zip(rows, names, strict=True)]
        for watch in watches:
            watch.begin(itself=blow is None)
        if blow is not None and wait_for(lambda: all([watch.ready() for watch in watches]), patience):
            if until is not None:
                until(fleet, process)
            for watch in watches:
                watch.strike()
            blow(fleet, process)
        wait_for(lambda: all([watch.settled() for watch in watches]) or _over(process, blow), patience)
        for watch in watches:
            watch.observe()
        problems = _end(fleet, process)
        for watch in watches:
            watch.heard(process.said)
            watch.outcome.problems += problems
            if watch.outcome.problems:
                watch.outcome.problems.append("said: " + " | ".join(process.said[-12:]))
    return [watch.outcome for watch in watches]


def batches(rows: Sequence[Row], size: int = 10) -> list[tuple[Row, ...]]:
    """Return rows in groups that two cores can fly at once."""
    return [tuple(rows[first : first + size]) for first in range(0, len(rows), size)]


def _over(process: Process, blow: Blow | None) -> bool:
    """Return whether nothing can come any more; after a blow, vehicles go on without their process."""
    return blow is None and not process.running()


def _end(fleet: Fleet, process: Process) -> list[str]:
    if process.running():
        process.signal(signal.SIGINT)
        if process.end(max(GOODBYE_SECONDS / fleet.speedup, LEAST_GOODBYE_SECONDS)) is None:
            process.signal(signal.SIGINT)
    problems = [] if process.end(30.0) is not None else ["the process does not end when it is interrupted"]
    try:
        complaints = fleet.replayed().complaints
    except MmrsError as error:
        return [*problems, f"the logs cannot be read: {error}"]
    return problems + [f"the logs do not replay: {each}" for each in complaints]


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
