"""``mmrs calibrate``: figures of a robot type from the logs of flights."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import say, say_json, table, tell
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from mmrs_mavlink.calibration.figures import Figure
    from mmrs_mavlink.calibration.flight import Flight
    from mmrs_mavlink.calibration.type_file import TypeFile

app = typer.Typer(rich_markup_mode=None, add_completion=False)


@app.command()
def calibrate(
    call: typer.Context,
    logs: Annotated[
        list[Path],
        typer.Argument(
            metavar="LOG...",
            help="Logs of a vehicle: ArduPilot's .bin, a ground station's .tlog, or a black box of MMRS.",
        ),
    ],
    system: Annotated[
        int | None,
        typer.Option(
            "--system",
            metavar="N",
            min=1,
            max=255,
            help="MAVLink system id of the vehicle, if a .tlog has several.",
        ),
    ] = None,
    robot_type: Annotated[
        Path | None,
        typer.Option(
            "--robot-type",
            metavar="FILE.xmi",
            help="Robot type to compare with; its batteries give the lifetime (flight time on one charge).",
        ),
    ] = None,
    payload: Annotated[
        float,
        typer.Option(
            "--payload",
            metavar="KG",
            min=0.0,
            help="Payload carried in the flight; selects the figures of the robot type for it.",
        ),
    ] = 0.0,
    write: Annotated[
        bool, typer.Option("--write", help="Write the medians into the file of --robot-type.")
    ] = False,
    json: Json = False,
) -> int:
    """Calculate the figures of a robot type from flight logs.

    Prints acceleration, jerk, speeds, turn rate, settling time and power as the vehicle really flew them,
    target by target (STEP) and as an autopilot mission (MISSION), each with its number of values, median and
    spread.
    Values of several logs count together.

    Example: mmrs calibrate 00000042.BIN --robot-type field/robots/quad-650.xmi --write
    """
    if write and robot_type is None:
        raise typer.BadParameter("--write needs --robot-type, the file to write into")
    from mmrs_core.errors import UnsupportedError
    from mmrs_mavlink.calibration.figures import figures_of, nothing
    from mmrs_mavlink.calibration.judging import judged
    from mmrs_mavlink.calibration.reading import flight_in

    flights = [flight_in(log, system) for log in logs]
    for damage in (damage for flight in flights for damage in flight.damages):
        tell(damage)
    if any(flight.profile != flights[0].profile for flight in flights):
        vehicles = ", ".join(f"{log}: {flight.vehicle}" for log, flight in zip(logs, flights, strict=True))
        raise UnsupportedError(f"logs of different vehicles: {vehicles}")
    given = _type_in(call, robot_type, payload) if robot_type is not None else None
    current = nothing if given is None else given.current
    found = figures_of(flights, given.capacity if given is not None else None, current)
    figures = judged(flights, found, current)
    if given is not None and write:
        given.write(figures)
    if json:
        plain = [_plain(log, flight) for log, flight in zip(logs, flights, strict=True)]
        told = {"logs": plain, "figures": [_plain_figure(each, given) for each in figures]}
        say_json(told | {"written": [robot_type] if write else []})
        return 0
    for line in _lines(flights, figures, given):
        say(line)
    if write:
        say(f"written: {robot_type}")
    return 0


def _type_in(call: typer.Context, file: Path, payload: float) -> TypeFile:
    from mmrs_mavlink.calibration.type_file import type_in

    return type_in(file, settings_of(call).plugins().contributions.languages, payload)


def _plain(log: Path, flight: Flight) -> dict[str, object]:
    """Return a log as plain values."""
    return {
        "log": log,
        "vehicle": flight.vehicle,
        "seconds": round(flight.seconds, 3),
        "rate": round(flight.rate, 3),
        "damages": flight.damages,
    }


def _plain_figure(figure: Figure, given: TypeFile | None) -> dict[str, object]:
    found: dict[str, object] = {
        "name": figure.name,
        "unit": figure.unit,
        "flown_as": figure.flown_as or None,
        "n": len(figure.values),
    }
    if given is not None:
        found["type"] = given.current(figure.name, figure.flown_as)
    if figure.missing:
        return found | {"missing": figure.missing}
    low, high = figure.spread
    found |= {"median": round(figure.median, 4), "low": round(low, 4), "high": round(high, 4)}
    return found | {"doubt": figure.doubt or None}


def _lines(flights: Sequence[Flight], figures: tuple[Figure, ...], given: TypeFile | None) -> Iterator[str]:
    """Yield what is printed: the flights, the figures, those that are missing, and the attributes to copy."""
    from mmrs_mavlink.calibration.attributes import element_lines

    for flight in flights:
        yield f"{flight.vehicle}: {flight.seconds:.0f} s, {flight.rate:.1f} positions a second"
    yield ""
    known = [each for each in figures if not each.missing]
    head = ("flown as", "figure", "unit", "n", "median", "10 % … 90 %", *(() if given is None else ("type",)))
    rows = [
        (each.flown_as, each.name, each.unit, str(len(each.values)), *_numbers(each, given)) for each in known
    ]
    yield from table(head, rows)
    yield ""
    for why, names in _by_cause(figures, lambda each: each.missing).items():
        yield f"not in {'this log' if len(flights) == 1 else 'these logs'}: {', '.join(names)}: {why}"
    for why, names in _by_cause(figures, lambda each: each.doubt).items():
        yield f"not written: {', '.join(names)}: {why}"
    yield ""
    yield from element_lines(figures)


def _numbers(figure: Figure, given: TypeFile | None) -> tuple[str, ...]:
    """Return the median, the spread, which one value has not, and what the type has."""
    from mmrs_mavlink.calibration.attributes import shown

    low, high = figure.spread
    found = shown(figure.median), f"{shown(low)} … {shown(high)}" if len(figure.values) > 1 else ""
    if given is None:
        return found
    value = given.current(figure.name, figure.flown_as)
    return *found, "" if value is None else f"{value:g}"


def _by_cause(figures: Iterable[Figure], cause: Callable[[Figure], str]) -> dict[str, list[str]]:
    """Return the figures that a cause keeps out, by it."""
    found: dict[str, list[str]] = {}
    for each in figures:
        if why := cause(each):
            found.setdefault(f"{why} ({each.flown_as})" if each.flown_as else why, []).append(each.name)
    return found
