"""Behaviours, robots and areas for tests of checks, with kinds of robots and moves of their own."""

from dataclasses import replace
from itertools import pairwise
from math import dist, inf

from mmrs_core.analysis.checks import CHECKS
from mmrs_core.behaviour.program import BEHAVIOUR, Move
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.rules import MoveKind, RobotKind
from mmrs_core.scene import Area, AreaUse, Kinematics
from mmrs_core.scene.timing import MoveSeconds
from mmrs_core.testing.small_programs import MOVE, ROBOT_TYPE, program, robot_type
from mmrs_core.transformation.kinds import charging_time
from mmrs_runtime.timing import LegTiming

ROBOT = ("urn:mmrs:robot:1.0", "Robot")
FLYER = ("urn:mmrs:test:1.0", "Flyer")
ANY = frozenset()
OF_PROGRAMS = ("minimum_separation", "position_error", "reserve", "idle")


def kind(
    metaclass=ROBOT,
    launches=False,
    floor=-inf,
    ceiling=inf,
    speed=2.0,
    acceleration=inf,
    turning_radius=0.0,
    overshoot=0.0,
):
    """Return a kind of robots that move at one speed in every direction."""
    return RobotKind(
        name=metaclass[1].lower(),
        metaclass=metaclass,
        kinematics=lambda robot, scene: Kinematics(
            speed,
            speed,
            speed,
            speed,
            speed,
            timing=LegTiming(acceleration, overshoot=overshoot),
            floor=floor,
            ceiling=ceiling,
            launches=launches,
            turning_radius=turning_radius,
        ),
        launch=lambda height: (),
        recover=lambda: (),
        travel=lambda route: (),
        position_hold="positionHold",
    )


def length(path):
    return sum(dist(a, b) for a, b in pairwise(path))


def stays(move, here, home):
    return (here,)


def straight(move, here, home):
    """Go to the target, ended `distance` before it."""
    if move.target.position is None:
        return None
    whole = dist(here, move.target.position)
    part = 1.0 if whole == 0.0 else max(0.0, 1.0 - move.distance / whole)
    return (here, tuple(a + part * (b - a) for a, b in zip(here, move.target.position, strict=True)))


def up(move, here, home):
    return (here, (here[0], here[1], here[2] + move.attributes["altitude"]))


def down(move, here, home):
    return (here, (here[0], here[1], home[2]))


def nothing(move, path, kinematics, mode):
    return MoveSeconds.exactly(0.0)


def travelled(move, path, kinematics, mode):
    return MoveSeconds.exactly(length(path) / (move.speed or kinematics.cruise))


def declared(move, path, kinematics, mode):
    return MoveSeconds.exactly(move.attributes["duration"])


def move_kinds(*kinds):
    return {each.metaclass: each for each in kinds}


TAKE_OFF = ("urn:mmrs:test:1.0", "TakeOff")
LAND = ("urn:mmrs:test:1.0", "Land")
MOVE_KINDS = move_kinds(
    MoveKind((BEHAVIOUR, "Start"), stays, nothing, ANY),
    MoveKind((BEHAVIOUR, "Stop"), stays, nothing, frozenset({"grounded", "moving"})),
    MoveKind((BEHAVIOUR, "HoldPosition"), stays, declared, ANY),
    MoveKind((BEHAVIOUR, "Recharge"), stays, charging_time, frozenset({"grounded", "moving"})),
    MoveKind((BEHAVIOUR, "GoTo"), straight, travelled, frozenset({"airborne", "moving"})),
    MoveKind(TAKE_OFF, up, travelled, frozenset({"grounded"}), "airborne"),
    MoveKind(LAND, down, travelled, frozenset({"airborne"}), "grounded"),
)


def uneven(low=0.5, high=2.0):
    """Return kinds of moves that take between so many times what they should."""
    return {
        name: replace(
            each,
            seconds=lambda *args, _seconds=each.seconds: MoveSeconds(
                *(f * seconds for f, seconds in zip((low, 1.0, high), _seconds(*args), strict=True))
            ),
        )
        for name, each in MOVE_KINDS.items()
    }


def take_off(id, altitude, **more):
    return Move(id, (TAKE_OFF, MOVE), {"altitude": altitude}, **more)


def land(id, **more):
    return Move(id, (LAND, MOVE), **more)


def recharge(id, seconds, **more):
    kinds = ((BEHAVIOUR, "Recharge"), (BEHAVIOUR, "HoldPosition"), MOVE)
    return Move(id, kinds, {"duration": seconds}, **more)


def strange(id):
    """Return a move of a kind that nobody contributed."""
    return Move(id, (("urn:elsewhere:1.0", "Burrow"), MOVE))


def square(name="tower", at=(10.0, 0.0), half=1.0, low=-inf, high=inf, use=AreaUse.OBSTACLE, distance=0.0):
    """Return a square area around a point."""
    e, n = at
    shell = ((e - half, n - half), (e + half, n - half), (e + half, n + half), (e - half, n + half))
    return Area(name, use, shell, low, high, distance)


def rover(**more):
    """Return the type that robots of tests are of; keywords are fields of `RobotType`."""
    figures = {name: more.pop(name) for name in list(more) if name not in ("half_diagonal", "max_payload")}
    return replace(robot_type(**figures), **more)


def given(*robots, type=None, robot_kind=None, moves=None, surface=0.0, **more):
    """Return the input of checks on these robots; keywords are fields of `Program` or `CheckInput`."""
    made = robot_kind or kind()
    asked = {name: more.pop(name) for name in list(more) if name in OF_PROGRAMS}
    return CheckInput(
        program=replace(program(*robots, surface=surface), **asked),
        types={ROBOT_TYPE: type or rover()},
        robot_kinds={made.metaclass: made},
        move_kinds=MOVE_KINDS if moves is None else moves,
        **more,
    )


def findings(name, input):
    """Return what the check of that name says."""
    check = next(check for check in CHECKS if check.name == name)
    return tuple(check.run(input))


def finding(name, input):
    """Return the only thing that the check of that name says."""
    (verdict,) = findings(name, input)
    return verdict
