"""How findings become verdicts."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from math import isnan
from typing import TypeVar, cast

from mmrs_core.analysis.figures import MissingFigureError
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict

TOLERANCE = 1e-6
"""A margin that is not further below zero than this counts as kept: it is in the noise of rounding."""

Found = TypeVar("Found")


@dataclass(frozen=True, slots=True)
class Margin:
    """What is left of one limit at one move.

    Attributes:
        value: negative where the limit is broken.
        move: index in the robot; None where the limit is not one of moves.
        message: what was measured there and what is allowed; without the robot.
        area: name of the area that the limit belongs to; may be empty.
        error: the part of the limit that allows for position errors, metres.
    """

    value: float
    move: int | None
    message: str
    area: str = ""
    error: float = 0.0


@dataclass(frozen=True, slots=True)
class UnknownMove:
    """What is not known of a move. Attributes: its index in the robot, and the reason."""

    move: int
    reason: str


def once(input: CheckInput, find: Callable[[CheckInput], Found]) -> Found:
    """Return what a function finds in the input; it is called once for all checks of a verification."""
    if find not in input.shared:
        input.shared[find] = find(input)
    return cast(Found, input.shared[find])


def for_each_robot(
    property: str, judge: Callable[[CheckInput, RobotProgram], Iterable[Verdict]]
) -> Callable[[CheckInput], Iterator[Verdict]]:
    """Return a check's run that judges robot by robot; a missing figure becomes a verdict UNKNOWN."""

    def run(input: CheckInput) -> Iterator[Verdict]:
        for robot in input.program.robots:
            try:
                yield from judge(input, robot)
            except MissingFigureError as missing:
                yield unknown(property, robot, str(missing))

    return run


def judged(
    property: str, robot: RobotProgram, unit: str, margins: Iterable[Margin], gaps: Iterable[UnknownMove] = ()
) -> Iterator[Verdict]:
    """Yield what margins and gaps mean for one robot.

    The worst violation of each area, or one in all where there are no areas; then what is unknown,
    margins that are not a number among it; and only if there is neither, that the property is kept,
    with the smallest margin.
    """
    given = tuple(margins)
    unclear = [margin for margin in given if isnan(margin.value)]
    measured = sorted((each for each in given if not isnan(each.value)), key=lambda each: each.value)
    violations: dict[str, Margin] = {}
    for margin in measured:
        if margin.value < -TOLERANCE:
            violations.setdefault(margin.area, margin)
    for margin in violations.values():
        yield of_margin(property, Status.VIOLATED, robot, unit, margin)
    for margin in unclear:
        found = of_margin(property, Status.UNKNOWN, robot, unit, margin)
        yield replace(found, margin=None, message=f"{found.message}, one of which is not a number")
    missing = tuple(gaps)
    if missing:
        yield unknown_moves(property, robot, missing)
    elif not violations and not unclear and measured:
        yield of_margin(property, Status.SAFE, robot, unit, measured[0])


def of_margin(property: str, status: Status, robot: RobotProgram, unit: str, margin: Margin) -> Verdict:
    """Return the verdict about the move where a margin was measured."""
    move = robot.moves[margin.move] if margin.move is not None else None
    return Verdict(
        property=property,
        status=status,
        robot=robot.id,
        margin=margin.value,
        unit=unit,
        move=move.id if move else "",
        area=margin.area,
        message=f"{robot.id}: {margin.message}",
        place=move.place if move else robot.place,
        error=margin.error,
    )


def unknown(property: str, robot: RobotProgram, message: str) -> Verdict:
    """Return that a property of a robot cannot be decided, and what is missing."""
    return Verdict(property, Status.UNKNOWN, robot.id, message=message, place=robot.place)


def unknown_moves(property: str, robot: RobotProgram, gaps: Iterable[UnknownMove]) -> Verdict:
    """Return that a property cannot be decided because of some moves; the first one is named."""
    missing = tuple(gaps)
    move = robot.moves[missing[0].move]
    others = len({gap.move for gap in missing} - {missing[0].move})
    more = f", and {others} more move{'s are' if others > 1 else ' is'} not known" if others else ""
    message = f"{robot.id}: {move.kind} '{move.id}': {missing[0].reason}{more}"
    return Verdict(property, Status.UNKNOWN, robot.id, move=move.id, message=message, place=move.place)


def not_checked(property: str, robot: RobotProgram, reason: str) -> Verdict:
    """Return that there is nothing to check a robot against, and why."""
    message = f"{robot.id}: {reason}"
    return Verdict(property, Status.NOT_CHECKED, robot.id, message=message, place=robot.place)


def violated(property: str, robot: RobotProgram, message: str, move: int | None = None) -> Verdict:
    """Return a violation that has no measure."""
    at = robot.moves[move] if move is not None else None
    return Verdict(
        property=property,
        status=Status.VIOLATED,
        robot=robot.id,
        move=at.id if at else "",
        message=f"{robot.id}: {message}",
        place=at.place if at else robot.place,
    )


def safe(property: str, robot: RobotProgram, message: str) -> Verdict:
    """Return that a property without a measure is kept."""
    return Verdict(property, Status.SAFE, robot.id, message=f"{robot.id}: {message}", place=robot.place)


def verify(input: CheckInput, checks: Iterable[Check]) -> tuple[Verdict, ...]:
    """Return what every check finds, in the order of the checks.

    A check that finds nothing to say leaves a verdict NOT_CHECKED, so that no property is missing.
    """
    found: list[Verdict] = []
    for check in checks:
        verdicts = tuple(check.run(input))
        found.extend(verdicts or (_silent(check),))
    return tuple(found)


def refuses(verdicts: Iterable[Verdict], accepted_unknowns: Collection[str] = ()) -> tuple[Verdict, ...]:
    """Return the verdicts that forbid to carry out the behaviour.

    These are all violations, and what is unknown of properties that the mission does not accept by
    name. A violation is never accepted.
    """
    return tuple(
        verdict
        for verdict in verdicts
        if verdict.status is Status.VIOLATED
        or (verdict.status is Status.UNKNOWN and verdict.property not in accepted_unknowns)
    )


def _silent(check: Check) -> Verdict:
    return Verdict(check.name, Status.NOT_CHECKED, message="not applicable to this behaviour")
