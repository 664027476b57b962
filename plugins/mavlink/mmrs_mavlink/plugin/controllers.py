"""The target mavlink-python: standalone controllers on top of pymavlink."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any

from mmrs_core.behaviour.earth import metres
from mmrs_core.behaviour.program import Action, Heading, Move, RobotProgram
from mmrs_core.behaviour.rally_points import RallyPoints, rally_points_of
from mmrs_core.behaviour.travel import capability_of, travel_margins_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.escaping import Call, Constant
from mmrs_core.generation.planned_moves import kinematics_of
from mmrs_core.generation.python import MOVEMENTS, PythonDriver, go_to, place_of, python_target
from mmrs_core.generation.python.moves import look_of, unturnable
from mmrs_core.generation.python.program import program_of
from mmrs_core.generation.safety import areas_of, policies_of
from mmrs_core.scene import Name, Point, Policy
from mmrs_mavlink import program as words
from mmrs_mavlink.plugin.capabilities import OF_CONTROLLERS, WIRINGS
from mmrs_mavlink.plugin.charges import charge_of
from mmrs_mavlink.plugin.context import VehicleContext, context_of, neighbours_of, templates_of, vehicleless
from mmrs_mavlink.plugin.escapes import Escape, escapes_of, straight_lines_are_clear
from mmrs_mavlink.plugin.fencing import Fence, fence_faults, fences_of
from mmrs_mavlink.plugin.headings import NO_TURNING, gimbal_of, on_gimbal, turns_to
from mmrs_mavlink.plugin.runs import MoveRun, runs_of
from mmrs_mavlink.profiles import ARDUPILOT, PROFILES
from mmrs_mavlink.wiring import Sampled, Wired


@dataclass(frozen=True, slots=True)
class _Protection:
    """What protects a robot beside its program."""

    fences: tuple[Fence, ...]
    rally_points: RallyPoints
    escapes: tuple[Escape, ...]

    @property
    def vertices(self) -> list[Point]:
        """Return all points that it consists of, seen from above."""
        corners = [vertex for fence in self.fences for vertex in fence.ring]
        ways = [place[:2] for escape in self.escapes for place in escape.places]
        return [*corners, *self.rally_points.points, *ways]


def _take_off(move: Move, context: VehicleContext, driver: object) -> Call:
    return Call("TakeOff", (metres(context.climb(move)),))


def _land(move: Move, context: VehicleContext, driver: object) -> Call:
    return Call("Land")


def _go_to(move: Move, context: VehicleContext, driver: Any) -> Call:
    return go_to(move, context, driver, context.legs(move))


MANOEUVRES: Mapping[str, Any] = {"take_off": _take_off, "land": _land, "go_to": _go_to}
"""Movements by `MoveKind.manoeuvre`."""


class MavlinkPython(PythonDriver[VehicleContext]):
    """How programs in Python drive vehicles that speak MAVLink."""

    name = "mavlink-python"
    description = "standalone pymavlink controllers, one for each robot and one for the whole fleet"
    module = "mmrs_mavlink"
    requires = ("mmrs-mavlink",)
    templates = templates_of("mavlink-python")
    capabilities = OF_CONTROLLERS
    tried_with = "copter"
    wirings = WIRINGS

    def undriven(self, robot: RobotProgram, input: TargetInput) -> str:
        """Return why no vehicle carries a robot."""
        if why := vehicleless(robot, input):
            return why
        profile = context_of(robot, input).profile
        if profile.name in PROFILES or profile.source:
            return ""
        return f"robot '{robot.id}': profile '{profile.name}' says no module that programs import it from"

    def context(self, robot: RobotProgram, input: TargetInput) -> VehicleContext:
        """Return what there is to know of a robot."""
        return context_of(robot, input)

    def vehicle(self, context: VehicleContext) -> str:
        """Return the class of vehicle."""
        return context.profile.vehicle

    def device(self, action: Action, context: VehicleContext) -> Call | str:
        """Return a command, or a value that is measured."""
        wiring = context.wiring(action)
        if isinstance(wiring, Wired):
            return _operate(action, wiring)
        if isinstance(wiring, Sampled):
            return Call("Measure", (action.device, action.name, wiring.value, wiring.seconds))
        return wiring.reason

    def movements_of(self, context: VehicleContext) -> Mapping[Name, Any]:
        """Return what moves become: those of plug-ins by the manoeuvre that their kind states."""
        known = {name: MANOEUVRES[kind.manoeuvre] for name, kind in context.moves.items() if kind.manoeuvre}
        return {**known, **MOVEMENTS}

    def look(self, heading: Heading, context: VehicleContext) -> Call | None:
        """Return how a device or a gimbal is pointed."""
        if not turns_to(heading, context):
            return None
        more: list[tuple[str, object]] = []
        if on_gimbal(heading, context):
            more.append(("gimbal", True))
            if number := gimbal_of(heading, context):
                more.append(("device", number))
        return look_of(heading, context, tuple(more))

    def unseen(self, heading: Heading, context: VehicleContext) -> Iterator[str]:
        """Yield why neither the vehicle nor a gimbal can be turned so."""
        if not turns_to(heading, context):
            yield NO_TURNING
        yield from unturnable(heading, context)
        if on_gimbal(heading, context):
            if heading.angle_degrees:
                yield "a gimbal points straight at its target, not at an angle to it"
            if context.frame.is_local:
                yield "a gimbal is pointed at places on the Earth, and the behaviour is local"

    def unsaid(self, move: Move, context: VehicleContext) -> Iterator[str]:
        """Yield that a vehicle takes off to where it stands, or to an unknown height."""
        if context.manoeuvre(move) != "take_off":
            return
        if context.path(move) is None:
            yield "its path is unknown where no home is given, and a take-off counts from the ground"
        elif context.climb(move) <= 0:
            yield f"takes off to {context.climb(move):g} m above the ground"

    def unanswerable(self, policy: Policy, context: VehicleContext) -> str:
        """Return what a vehicle cannot do, or not as a failsafe."""
        profile, response = context.profile, policy.response
        if policy.event == "LINK_LOST" and response not in profile.alone:
            return f"no {profile.vehicle} does {response} as a failsafe"
        return "" if response in profile.responses else f"no {profile.vehicle} can answer it by {response}"

    def refusals(self, context: VehicleContext, input: TargetInput) -> Iterable[str]:
        """Return what no geofence can keep."""
        robot = context.robot
        return () if context.frame.is_local else fence_faults(robot, areas_of(robot, input))

    def head(self, context: VehicleContext, input: TargetInput) -> Iterator[tuple[str, object]]:
        """Yield what protects a robot, and how it travels."""
        robot = context.robot
        kept, homes = _protection(robot, input), neighbours_of(robot, input)
        if not context.frame.is_local:
            context.degrees.find([*kept.vertices, *(home[:2] for _, home in homes)])
        if context.profile.source:
            yield "driven_by", context.profile.source
        if context.profile.autopilot.name != ARDUPILOT.name:
            yield "autopilot", context.profile.autopilot.name
        yield "neighbours", tuple((name, place_of(home, context)) for name, home in homes)
        yield from _endurance(context)
        if (charge := charge_of(robot, input)) is not None:
            yield (
                "charge",
                Call("Charge", (), tuple((each.name, getattr(charge, each.name)) for each in fields(charge))),
            )
        how = travel_of(context, input)
        yield "travel", Call("Travel", (robot.travel_mode,), tuple(how.items()))
        yield "runs", tuple(_run(run, robot) for run in runs_of(context, kinematics_of(robot, input)))
        yield ("fence", tuple(tuple(_ground(each, context) for each in fence.ring) for fence in kept.fences))
        shared = (kept.rally_points.shared,) if kept.rally_points.shared else ()
        yield "tight", (*(str(fence) for fence in kept.fences if fence.is_tight), *shared)
        points = kept.rally_points.points
        yield "rally", tuple(place_of((*point, _highest(context)), context) for point in points)
        yield "escapes", tuple(_escapes(kept.escapes, context))
        if _escapes_alone(robot, input) and not straight_lines_are_clear(context, input, points):
            yield "straight", False


DRIVER = MavlinkPython()
MAVLINK_PYTHON = python_target(DRIVER)


def robot_of(robot: RobotProgram, input: TargetInput) -> words.Robot:
    """Return the program that a controller of that robot would carry out.

    Raises:
        UnsupportedError: degrees are needed, and the behaviour has none.
    """
    made: words.Robot = program_of(robot, input, DRIVER, words)
    return made


def command_name(number: int) -> str:
    """Return the name of a MAVLink command, such as ``MAV_CMD_DO_SET_SERVO``; empty where it has none."""
    from pymavlink.dialects.v20 import ardupilotmega as mavlink

    commands: Mapping[int, Any] = mavlink.enums["MAV_CMD"]
    return "" if number == mavlink.MAV_CMD_ENUM_END or number not in commands else str(commands[number].name)


def _named(number: int) -> object:
    name = command_name(number)
    return Constant(name, number) if name else number


def _operate(action: Action, wiring: Wired) -> Call:
    named: list[tuple[str, object]] = []
    if wiring.more:
        more = tuple((_named(number), tuple(map(float, params))) for number, params in wiring.more)
        named.append(("more", more))
    if wiring.confirmed:
        named.append(("confirmed", True))
    if wiring.trial:
        named.append(("trial", True))
    given = (_named(wiring.command), tuple(map(float, wiring.params)), wiring.seconds)
    return Call("Operate", (action.device, action.name, *given), tuple(named))


def _protection(robot: RobotProgram, input: TargetInput) -> _Protection:
    if input.program.frame.is_local:
        return _Protection((), RallyPoints(), ())
    rally_points = rally_points_of(robot, input.program, input.types, input.areas)
    escapes = escapes_of(robot, input, rally_points.points)
    return _Protection(fences_of(robot, input, escapes), rally_points, escapes)


def _escapes(escapes: Iterable[Escape], context: VehicleContext) -> Iterator[tuple[str, object]]:
    """Yield the path from the end of each move; one that several share has a name."""
    ways = [(each.move, tuple(place_of(place, context) for place in each.places)) for each in escapes]
    uses = Counter(way for _, way in ways)
    shared = [way for way, count in uses.items() if count > 1]
    names = {way: Constant(f"ESCAPE_{number}", way) for number, way in enumerate(shared, start=1)}
    yield from ((move, names.get(way, way)) for move, way in ways)


def _escapes_alone(robot: RobotProgram, input: TargetInput) -> bool:
    """Return whether the vehicle is to reach an emergency area by its failsafe, anywhere."""
    everywhere = policies_of(robot, input)
    somewhere = (policy for each in robot.transitions.values() for policy in each.policies)
    return ("LINK_LOST", "EMERGENCY_AREA") in ((p.event, p.response) for p in (*everywhere, *somewhere))


def _endurance(context: VehicleContext) -> Iterator[tuple[str, object]]:
    """Yield the robot type's endurance and largest speed."""
    if context.type is None or (capability := capability_of(context.robot, context.type)) is None:
        return
    if capability.lifetime is not None:
        yield "endurance", capability.lifetime
    yield "fastest", metres(capability.speed[1])


def travel_of(context: VehicleContext, input: TargetInput) -> dict[str, float]:
    """Return how a robot travels, by the names of `Travel`."""
    margins = travel_margins_of(context.robot, input.program.position_error)
    how = {name: getattr(margins, name) for name in ("acceptance", "radius", "margin")}
    kinematics = kinematics_of(context.robot, input)
    if kinematics is not None and kinematics.turning_radius > 0.0:
        how["turning_radius"] = kinematics.turning_radius
    return {**how, **dict(_largest_rates(context))}


def _largest_rates(context: VehicleContext) -> Iterator[tuple[str, float]]:
    """Yield the robot type's largest vertical speeds and turn rate, as far as it states them."""
    capability = capability_of(context.robot, context.type) if context.type is not None else None
    if capability is not None and not context.profile.drives:
        upright = (("climb", capability.climb_rate), ("descent", capability.descent_rate))
        known = (*upright, ("turn_rate", capability.turn_rate))
        yield from ((name, rate) for name, rate in known if rate is not None)


def _run(run: MoveRun, robot: RobotProgram) -> Call:
    return Call("Run", (tuple(robot.moves[move].id for move in run.moves), run.holds))


def _ground(vertex: Point, context: VehicleContext) -> Call:
    return place_of((*vertex, context.zero), context)


def _highest(context: VehicleContext) -> float:
    ups = [move.target.position[2] for move in context.robot.moves if move.target and move.target.position]
    return max(ups, default=context.zero)
