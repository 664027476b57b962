"""How plain robots and the moves of the core language move."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import dist, inf
from typing import TYPE_CHECKING

from mmrs_core.behaviour.travel import SHARE_OF_LARGEST_SPEED
from mmrs_core.contributions.rules import MoveKind, MoveSpec, RobotKind
from mmrs_core.contributions.samples import sample_type
from mmrs_core.errors import InfeasibleError
from mmrs_core.languages.uris import BEHAVIOUR
from mmrs_core.scene import Capability, Kinematics, Position, Robot, RobotType, Scene
from mmrs_core.scene.timing import MoveSeconds, noticing

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Move

ROBOT = ("urn:mmrs:robot:1.0", "Robot")
ANYWHERE = frozenset({"grounded", "airborne", "moving"})
AFLOAT = frozenset({"airborne", "moving"})

_HEADWAY = 0.1
"""Metres per second that a robot must make against wind or current to go anywhere."""


def capability_for(robot_type: RobotType, payload: float) -> Capability:
    """Return the capability that was measured with the smallest payload not below this one.

    A type that states no maxPayload carries none.

    Raises:
        InfeasibleError: if the robot was never measured with so much, or may not carry it.
    """
    largest = robot_type.max_payload
    if payload > (largest or 0.0):
        carries = (
            "states no maxPayload and carries none" if largest is None else f"carries at most {largest:g} kg"
        )
        raise InfeasibleError(
            f"robot type '{robot_type.name}' {carries}, not the {payload:g} kg that it is to carry"
        )
    for capability in robot_type.capabilities:
        if capability.payload >= payload:
            return capability
    raise InfeasibleError(
        f"robot type '{robot_type.name}' has no movement capability for a payload of {payload:g} kg"
    )


def kinematics_for(
    robot: Robot,
    scene: Scene,
    *,
    floor: float = -inf,
    ceiling: float = inf,
    launch: float = 0.0,
    recovery: float = 0.0,
    launches: bool = False,
    flow: str = "",
) -> Kinematics:
    """Return the kinematics that follow from a robot type's own figures.

    Cruise is the travel mode's share of the largest speed, never under the smallest. Against the flow a
    robot goes over ground at its largest speed less the flow's; no higher speed is commanded, so that a leg
    takes as long in any direction. The mean power is what empties the batteries in the lifetime; against the
    flow it grows by (flow / largest speed)². Robot kinds add their limits of height.

    Args:
        robot: with its type and payload.
        scene: with the environment and the reserve.
        floor: height above the origin, in metres, below which the robot does not go.
        ceiling: height above the origin, in metres, above which it does not go.
        launch: seconds that launching takes beside the climb.
        recovery: seconds that landing takes beside the descent.
        launches: whether the robot climbs from its home before it travels, and descends onto it at the end.
        flow: name of the environment's attribute with the speed of the wind or current that the robot
            travels in, such as ``windSpeed``; empty: none.

    Raises:
        InfeasibleError: if the type has no capability for the robot's payload, or cannot go against the
            flow.
    """
    capability = capability_for(robot.type, robot.payload)
    slowest, own_speed = capability.speed
    against = scene.environment.get(flow, 0.0)
    fastest = _over_ground(slowest, own_speed, against)
    timing = capability.timing("STEP")
    stored = sum(battery.energy for battery in robot.type.batteries)
    lifetime = capability.lifetime
    usable = 1.0 - scene.reserve
    return Kinematics(
        cruise=min(fastest, max(slowest, SHARE_OF_LARGEST_SPEED[robot.travel_mode] * own_speed)),
        slowest=slowest,
        fastest=fastest,
        climb=timing.climb,
        descent=timing.descent,
        timing=timing,
        turn_rate=capability.turn_rate or 90.0,
        floor=floor,
        ceiling=ceiling,
        launch=launch if capability.launch is None else capability.launch,
        recovery=recovery if capability.recovery is None else capability.recovery,
        landing_rate=inf if capability.landing_rate is None else capability.landing_rate,
        landing_height=capability.landing_height or 0.0,
        endurance=inf if lifetime is None else lifetime * usable,
        energy=stored * usable if stored else inf,
        power=stored / lifetime if stored and lifetime else 0.0,
        draw=1.0 + (against / own_speed) ** 2 if own_speed > 0.0 else 1.0,
        recharge=_recharge(robot.type),
        launches=launches,
        own_speed=own_speed,
        mission=capability.timing("MISSION") if capability.leg_timings.get("MISSION") else None,
    )


def _over_ground(slowest: float, own_speed: float, against: float) -> float:
    """Return the speed over ground that a robot can keep in every direction, metres per second."""
    fastest = own_speed - against
    if against > 0.0 and fastest < max(slowest, _HEADWAY):
        raise InfeasibleError(
            f"goes at {slowest:g} to {own_speed:g} m/s, too slow against {against:g} m/s of wind or current"
        )
    return fastest if against > 0.0 else own_speed


def _recharge(robot_type: RobotType) -> float | None:
    times = [battery.recharge_time for battery in robot_type.batteries]
    known = [time for time in times if time is not None]
    return max(known) if known and len(known) == len(times) else None


def straight_travel(route: tuple[Position, ...]) -> tuple[MoveSpec, ...]:
    """Return one GoTo of the core language for each leg of a route."""
    return tuple(MoveSpec((BEHAVIOUR, "GoTo"), target=position) for position in route[1:])


def straight_path(move: Move, here: Position, home: Position | None) -> tuple[Position, ...] | None:
    """Return the straight path to a GoTo's target, ended `distance` before it.

    None where the target is an object whose place is not known.
    """
    if move.target is None or move.target.position is None:
        return None
    return (here, before_target(here, move.target.position, move.distance))


def before_target(here: Position, target: Position, distance: float) -> Position:
    """Return the point `distance` before the target on a straight path; `here` if it is nearer."""
    whole = dist(here, target)
    if distance <= 0.0:
        return target
    if whole <= distance:
        return here
    part = (whole - distance) / whole
    return (
        here[0] + part * (target[0] - here[0]),
        here[1] + part * (target[1] - here[1]),
        here[2] + part * (target[2] - here[2]),
    )


def path_seconds(move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str) -> MoveSeconds:
    """Return how long a move along a path takes at its commanded or its robot's cruise speed.

    The robot stops after every leg; where the move flows into the next or out of the one before, it may
    be quicker. One that cannot turn on the spot may have to turn right round first, or go the right way
    already. Where its motors may be off before, it sets out.
    """
    rates, legs = kinematics.rates(move.speed), list(pairwise(path))
    soonest = rates.soonest()
    if move.speed is not None and move.speed > soonest.cruise:  # as commanded, where the flow lets it
        soonest = replace(soonest, cruise=move.speed)
    latest, facing, push = rates.latest(), kinematics.facing, kinematics.push
    entering = kinematics.entering
    out = kinematics.setting_out() if kinematics.sets_out and legs else MoveSeconds.exactly(0.0)
    least, expected, most = out
    for leg in legs:
        least += soonest.eased(*leg, entering) if move.flows else soonest.from_stop_to_stop(*leg, push=push)
        expected += rates.from_stop_to_stop(*leg, facing, push)
        most += latest.from_stop_to_stop(*leg, facing, push)
        facing, push, entering = rates.faces(*leg, facing), rates.push(*leg, push), 0.0
    return MoveSeconds(least, expected, most)


def stays(move: Move, here: Position, home: Position | None) -> tuple[Position, ...]:
    """Return the path of a move on the spot."""
    return (here,)


def starting_time(move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str) -> MoveSeconds:
    """Return the duration of a start, which takes none."""
    return MoveSeconds(0.0, 0.0, noticing(kinematics.timing))


def stopping_time(move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str) -> MoveSeconds:
    """Return the duration of a stop: until it is confirmed that motors do, which landing includes."""
    expected = 0.0 if kinematics.launches else kinematics.recovery
    return MoveSeconds(0.0, expected, max(expected, kinematics.timing.reporting))


def declared_time(move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str) -> MoveSeconds:
    """Return the duration that the move itself declares; that it has passed may be noticed later."""
    seconds = _declared(move)
    return MoveSeconds(seconds, seconds, seconds + noticing(kinematics.timing))


def charging_time(move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str) -> MoveSeconds:
    """Return the duration of charging, which may take longer than declared until the batteries are full."""
    return kinematics.charging_time(_declared(move))


def turning_time(move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str) -> MoveSeconds:
    """Return the duration of a turn on the spot, from and to any heading."""
    return kinematics.turning(None if move.heading is None else move.heading.seen_from(path[-1]))


def _declared(move: Move) -> float:
    duration = move.attributes.get("duration")
    return float(duration) if isinstance(duration, (int, float)) else 0.0


def _level_kinematics(robot: Robot, scene: Scene) -> Kinematics:
    return kinematics_for(robot, scene, floor=robot.home[2], ceiling=robot.home[2])


def _nothing() -> tuple[MoveSpec, ...]:
    return ()


def _no_launch(height: float) -> tuple[MoveSpec, ...]:
    return ()


PLAIN_ROBOT = RobotKind(
    name="plain_robot",
    metaclass=ROBOT,
    kinematics=_level_kinematics,
    launch=_no_launch,
    recover=_nothing,
    travel=straight_travel,
    policies={
        "LINK_LOST": "HOLD",
        "PEER_LOST": "HOLD",
        "BATTERY_LOW": "RETURN",
        "WAIT_TOO_LONG": "HOLD",
        "DEVICE_SILENT": "CONTINUE",
        "POSITION_LOST": "HOLD",
        "OBSTACLE": "HOLD",
        "FENCE_BREACHED": "HOLD",
        "VEHICLE_RESTARTED": "HOLD",
        "LOG_FAILED": "HOLD",
        "GROUND_LOST": "CONTINUE",
        "MOTOR_FAILED": "HOLD",
    },
    vehicle="ground",
    sample=sample_type((ROBOT,)),
)

_Seconds = Callable[["Move", tuple[Position, ...], Kinematics, str], MoveSeconds]


def _on_the_spot(name: str, seconds: _Seconds, needs: frozenset[str] = ANYWHERE) -> MoveKind:
    return MoveKind((BEHAVIOUR, name), stays, seconds, needs)


MOVE_KINDS = (
    _on_the_spot("Start", starting_time, frozenset({"grounded", "moving"})),
    _on_the_spot("Stop", stopping_time, frozenset({"grounded", "moving"})),
    _on_the_spot("HoldPosition", declared_time),
    _on_the_spot("Recharge", charging_time, frozenset({"grounded", "moving"})),
    _on_the_spot("HeadTo", turning_time, AFLOAT),
    MoveKind((BEHAVIOUR, "GoTo"), straight_path, path_seconds, AFLOAT, manoeuvre="go_to"),
)
