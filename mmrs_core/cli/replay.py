"""``mmrs replay``: did a run do what its behaviour says?"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.behaviour.box_files import black_boxes, is_part
from mmrs_core.behaviour.log import logs_in, read_logs, recover_log
from mmrs_core.behaviour.replay import ReplayResult
from mmrs_core.behaviour.replay import replay as replayed
from mmrs_core.cli.behaviours import load_program
from mmrs_core.cli.encoding import plain
from mmrs_core.cli.output import counted, say, say_json, say_lines, table, tell
from mmrs_core.cli.parameters import Behaviour, behaviour_file
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.pictures.figures import clock
from mmrs_runtime.semantics import Outcome

if TYPE_CHECKING:
    from mmrs_core.pictures.flights.flight import Flight
    from mmrs_core.pictures.flights.positions import PlacedStep


def replay(
    call: typer.Context,
    behaviour: Behaviour,
    logs: Annotated[list[Path], typer.Argument(metavar="LOG...", help="Step logs, or folders of them.")],
    partial: Annotated[
        bool, typer.Option("--partial", help="Accept logs that end before the run is complete.")
    ] = False,
    steps: Annotated[
        bool,
        typer.Option("--steps", help="Print every step, with the robot's position if a black box has it."),
    ] = False,
    json: Json = False,
) -> int:
    """Check the logs of a run against its behaviour.

    Replays every logged step by the rules of the Behaviour Language. Black boxes next to the logs are read as
    well; damaged and missing records are reported.

    Example: mmrs replay field field/logs
    """
    from mmrs_core.pictures.flights.gathering import read_flight
    from mmrs_core.pictures.flights.positions import steps_of

    session = Session(settings_of(call))
    program = load_program(session, behaviour_file(behaviour))
    given = [path for path in logs if not is_part(path)]
    result = replayed(program, read_logs(given, partial=partial), partial=partial)
    flight = read_flight(logs, program, {}) if steps or black_boxes(logs) else None
    placed = steps_of(flight, program) if flight is not None and steps else None
    if json:
        _say_json(result, flight, placed)
    else:
        _say(result, flight)
        if partial and flight is None:
            for damage in (each for path in logs_in(given) for each in recover_log(path)[1]):
                tell(str(damage))
        if placed is not None:
            _say_steps(placed)
    cut = partial and result.outcome is Outcome.INCOMPLETE
    return 0 if result.accepted and (cut or result.outcome is Outcome.SUCCESS) else 1


def _say(result: ReplayResult, flight: Flight | None) -> None:
    verdict = "accepted" if result.accepted else "not what the behaviour says"
    say(f"{verdict}: {result.outcome.value} after {result.steps} steps and {clock(result.duration)}")
    for complaint in result.complaints:
        say(f"  - {complaint}")
    for robot, fault in result.faults.items():
        say(f"  fault of '{robot}': {fault}")
    for waiting in result.waiting:
        say(f"  {waiting}")
    if flight is not None and flight.boxes:
        fixes = sum(len(flown.track.times) for flown in flight.robots.values())
        say(f"  black boxes of {counted(flight.boxes, 'robot')}: {counted(fixes, 'place')}")
    for damage in flight.damages if flight is not None else ():
        tell(damage)


def _say_steps(steps: Sequence[PlacedStep]) -> None:
    from mmrs_core.pictures.report.wording import place

    rows = [(clock(step.time), step.robot, place(step.where), step.words) for step in steps]
    say_lines(table(("time", "robot", "where", "step"), rows))


def _say_json(result: ReplayResult, flight: Flight | None, steps: Sequence[PlacedStep] | None) -> None:
    reported = plain(result)
    assert isinstance(reported, dict)
    if flight is not None:
        reported |= {"boxes": flight.boxes, "damages": list(flight.damages)}
    if steps is not None:
        reported["where"] = plain(steps)
    say_json(reported)
