"""Whether robots have enough time and energy for every sortie, and recharge as their batteries allow.

The limits follow from the robot type alone: the lifetime of the capability for the robot's payload, and
what the batteries hold, both less the reserve. Mean power is what empties the batteries in the lifetime;
against wind or current all the time it is more, by the kinematics' draw. Times are those of the kinds of
moves; what these reckon without, the reserve must cover.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from math import ceil, dist, inf

from mmrs_core.analysis.figures import MissingFigureError, capability_of, home_of, kinematics_of, type_of
from mmrs_core.analysis.motion import MovePath, motions
from mmrs_core.analysis.sorties import RECHARGE, ChargeUse, Sorties, sorties_of
from mmrs_core.analysis.verdicts import (
    Margin,
    UnknownMove,
    for_each_robot,
    judged,
    not_checked,
    once,
    safe,
    violated,
)
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.behaviour.walk import reachable_moves
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene import Position

ENDURANCE_NAME = "endurance"
ENERGY_NAME = "energy"
RECHARGE_NAME = "recharge"

_MOST = "up to"
"""How the bound is called that no run exceeds."""

CHARGER_REACH = 1.0
"""Metres around home within which batteries can be recharged."""


def sorties_of_all(input: CheckInput) -> dict[str, Sorties]:
    """Return the sorties of every robot by its identifier."""
    return {robot.id: sorties_of(input, robot) for robot in input.program.robots}


def _judge_endurance(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    lifetime = _lifetime(input, robot)
    if lifetime is None:
        yield not_checked(ENDURANCE_NAME, robot, "it has no batteries and no lifetime: it is wired")
        return
    allowed = _usable(input, lifetime)
    sorties = once(input, sorties_of_all)[robot.id]
    yield from _judged_uses(ENDURANCE_NAME, robot, sorties, (1.0, 1.0), allowed, "s", lifetime)


def _judge_energy(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    stored = sum(battery.energy for battery in type_of(input, robot).batteries)
    if not type_of(input, robot).batteries:
        yield not_checked(ENERGY_NAME, robot, "it has no batteries: it is wired")
        return
    lifetime = _lifetime(input, robot)
    if not lifetime:
        raise MissingFigureError(f"{robot.id}: its lifetime, from which its power follows, is not given")
    allowed = stored * (1.0 - input.program.reserve)
    sorties = once(input, sorties_of_all)[robot.id]
    mean = stored / lifetime
    most = mean * kinematics_of(input, robot).draw if sorties.uses else mean
    yield from _judged_uses(ENERGY_NAME, robot, sorties, (mean, most), allowed, "J", lifetime)


def allowed_seconds(input: CheckInput, robot: RobotProgram) -> float:
    """Return how long a robot may run on one charge at the most power; inf for a wired one.

    Raises:
        MissingFigureError: its lifetime is not given.
    """
    lifetime = _lifetime(input, robot)
    if lifetime is None:
        return inf
    draw = kinematics_of(input, robot).draw if type_of(input, robot).batteries else 1.0
    return _usable(input, lifetime) / draw


def _usable(input: CheckInput, lifetime: float) -> float:
    return lifetime * (1.0 - input.program.reserve)


def _lifetime(input: CheckInput, robot: RobotProgram) -> float | None:
    """Return the lifetime with the robot's payload; None for a wired robot."""
    lifetime = capability_of(input, robot).lifetime
    if lifetime is None and type_of(input, robot).batteries:
        raise MissingFigureError(
            f"{robot.id}: the lifetime of robot type '{robot.type_name}'"
            f" with a payload of {robot.payload:g} kg is not given"
        )
    return lifetime


def _judged_uses(
    property: str,
    robot: RobotProgram,
    sorties: Sorties,
    rate: tuple[float, float],
    allowed: float,
    unit: str,
    lifetime: float,
) -> Iterator[Verdict]:
    """Judge the largest use, and the first that no run can keep; `rate` is the least and most a second.

    What is used of what is allowed falls as the lifetime grows.
    """
    largest = max(sorties.uses, key=lambda use: use.seconds, default=None)
    if largest is None and not sorties.gaps:
        yield safe(property, robot, "it never runs on its batteries")
        return

    def margin(use: ChargeUse, rate: float, bound: str) -> Margin:
        used = rate * use.seconds
        move = robot.moves[use.move]
        words = (
            f"until {move.kind} '{move.id}' it needs {bound} {used:.1f} {unit} of one charge,"
            f" {allowed:.1f} {unit} are allowed"
        )
        if used > allowed > 0.0 and bound == _MOST:
            words += f": a lifetime of {ceil(lifetime * used / allowed)} s would do"
        return Margin(_rounded(allowed - used, allowed), use.move, words)

    margins = [] if largest is None else [margin(largest, rate[1], _MOST)]
    certain = (margin(use, rate[0], "at least") for use in sorted(sorties.least, key=lambda use: use.seconds))
    margins += islice((each for each in certain if each.value < 0.0), 1)
    yield from judged(property, robot, unit, margins, sorties.gaps)


def _rounded(margin: float, allowed: float) -> float:
    """Return the margin, and zero where it is below zero by the rounding of coordinates and sums alone."""
    return 0.0 if -1e-6 * allowed <= margin < 0.0 else margin


def _judge_recharge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    moves = [index for index in sorted(reachable_moves(robot)) if robot.moves[index].is_a(RECHARGE)]
    if not moves:
        yield not_checked(RECHARGE_NAME, robot, "no Recharge move")
        return
    times = [battery.recharge_time for battery in type_of(input, robot).batteries]
    known = [time for time in times if time is not None]
    if not times or len(known) < len(times):
        reason = "it has no batteries" if not times else "a battery of its type cannot be recharged"
        yield violated(
            RECHARGE_NAME, robot, f"'{robot.moves[moves[0]].id}' recharges, but {reason}", moves[0]
        )
        return
    margins = [_long_enough(robot, index, max(known)) for index in moves]
    yield from judged(RECHARGE_NAME, robot, "s", margins, _gaps_at(input, robot, moves))
    yield from _away_from_home(input, robot, moves)


def _long_enough(robot: RobotProgram, index: int, needed: float) -> Margin:
    move = robot.moves[index]
    duration = move.attributes.get("duration")
    seconds = float(duration) if isinstance(duration, int | float) else 0.0
    words = f"{move.kind} '{move.id}' lasts {seconds:.1f} s, full batteries take {needed:.1f} s"
    return Margin(seconds - needed, index, words)


def _gaps_at(input: CheckInput, robot: RobotProgram, moves: list[int]) -> list[UnknownMove]:
    return [gap for gap in motions(input)[robot.id].gaps if gap.move in moves]


def _away_from_home(input: CheckInput, robot: RobotProgram, moves: list[int]) -> Iterator[Verdict]:
    home = home_of(robot)
    worst: dict[int, float] = {}
    for leg in motions(input)[robot.id].paths:
        if leg.move in moves:
            worst[leg.move] = max(worst.get(leg.move, -inf), _away(leg, home))
    for index, away in worst.items():
        if away > CHARGER_REACH:
            words = f"'{robot.moves[index].id}' recharges {away:.2f} m away from home"
            yield violated(RECHARGE_NAME, robot, words, index)


def _away(leg: MovePath, home: Position) -> float:
    return max(dist(point, home) for point in leg.points) + leg.radius


ENDURANCE = Check(
    name=ENDURANCE_NAME,
    title="No sortie takes longer than the robot's lifetime with its payload, less the reserve.",
    run=for_each_robot(ENDURANCE_NAME, _judge_endurance),
    hint="let more robots share the work, recharge in between, or take weight off",
)
ENERGY = Check(
    name=ENERGY_NAME,
    title="No sortie takes more energy than the batteries hold, less the reserve.",
    run=for_each_robot(ENERGY_NAME, _judge_energy),
    hint="let more robots share the work, recharge in between, or take weight off",
)
RECHARGE_CHECK = Check(
    name=RECHARGE_NAME,
    title="Robots recharge at home, and long enough for full batteries.",
    run=for_each_robot(RECHARGE_NAME, _judge_recharge),
    hint="let the robot go home before it recharges, and stay for at least the longest rechargeTime",
)
