"""A project on disk in which every robot has a pad of its own, with a meadow for emergencies beside it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import atan2, degrees, hypot
from pathlib import Path
from xml.sax.saxutils import quoteattr

from pyproj import Geod

LATITUDE, LONGITUDE, ALTITUDE = 42.37, 13.35, 720.0
EARTH = Geod(ellps="WGS84")
"""PROJ's geodesics, which know nothing of how robots and simulated vehicles reckon."""

PAD_METRES = 150.0

OUT = (30.0, 0.0, 12.0)
"""Where a robot stays first: metres north, east and up of its home."""

TOUR = ((30.0, 20.0, 12.0), (45.0, 20.0, 12.0), (45.0, 0.0, 12.0), (45.0, -10.0, 12.0))
"""Places that are flown to as a mission, without stops in the program."""

MEADOW = ((12.0, -40.0), (32.0, -40.0), (32.0, -22.0), (12.0, -22.0))
"""Corners of the emergency area, metres north and east of a home."""

SCHOOL = ((80.0, -20.0), (100.0, -20.0), (100.0, 20.0), (80.0, 20.0))
"""Corners of the forbidden area, which becomes a fence."""

POLICY = tuple[str, str, float | None]
"""Event, response, and the seconds that the event must last, if it is said."""


@dataclass(frozen=True, slots=True)
class Pad:
    """A robot, its program and its policies.

    Attributes:
        program: ``tour``, ``wait``, ``give``, ``charge`` or ``perch``, see `steps_of`.
        gives: the robot whose wait a ``give`` ends.
        of_wait: policies of the wait only.
    """

    robot: str
    program: str = "tour"
    policies: tuple[POLICY, ...] = ()
    stay: float = 20.0
    gives: str = ""
    of_wait: tuple[POLICY, ...] = ()


@dataclass(frozen=True, slots=True)
class Step:
    """One move: its metaclass, attributes, target, what it does at its end, and how it goes on."""

    kind: str
    name: str
    attributes: str = ""
    target: tuple[float, float, float] | None = None
    actions: str = ""
    waits: bool = False
    fluid: bool = False


def home_of(index: int) -> tuple[float, float]:
    """Return latitude and longitude of a pad."""
    return _away((LATITUDE, LONGITUDE), 0.0, index * PAD_METRES)


def steps_of(pad: Pad, pads: Sequence[Pad]) -> list[Step]:
    """Return the steps of a pad's program, between its start and its stop."""
    photo = '<preActions xsi:type="behaviour:DeviceAction" actionName="TakePicture" deviceId="camera"/>'
    up = Step("multicopter:TakeOff", "up", 'altitude="10.0"')
    down = Step("multicopter:Land", "down")
    stay = Step("behaviour:HoldPosition", "stay", f'duration="{pad.stay}"', actions=photo)
    if pad.program == "wait":
        return [up, Step("multicopter:GoTo", "out", 'speed="5.0"', OUT, waits=True), *_home(), down]
    if pad.program == "give":
        owner = next(i for i, each in enumerate(pads) if each.robot == pad.gives)
        notify = (
            f'<postActions xsi:type="behaviour:UnicastNotify" name="go" slot="//@robots.{owner}/@slots.0"/>'
        )
        stay = Step("behaviour:HoldPosition", "stay", f'duration="{pad.stay}"', actions=notify)
        return [up, Step("multicopter:GoTo", "out", 'speed="5.0"', OUT), stay, *_home(), down]
    if pad.program == "charge":
        charge = Step("behaviour:Recharge", "charge", f'duration="{pad.stay}"')
        return [
            up,
            down,
            charge,
            Step("multicopter:TakeOff", "up again", 'altitude="10.0"'),
            Step("multicopter:Land", "down again"),
        ]
    if pad.program == "perch":
        return [
            up,
            Step("multicopter:GoTo", "out", 'speed="5.0"', OUT),
            Step("multicopter:Land", "perch"),
            stay,
            Step("multicopter:TakeOff", "up again", 'altitude="12.0"'),
            Step("multicopter:GoTo", "on", 'speed="5.0"', TOUR[1]),
            *_home(),
            down,
        ]
    tour = [
        Step("multicopter:GoTo", f"tour {n}", 'speed="4.0"', place, fluid=n < len(TOUR) - 1)
        for n, place in enumerate(TOUR)
    ]
    return [up, Step("multicopter:GoTo", "out", 'speed="5.0"', OUT), stay, *tour, *_home(), down]


def _home() -> list[Step]:
    return [Step("multicopter:GoTo", "back", 'speed="5.0"', (0.0, 0.0, 12.0))]


def write_project(folder: Path, pads: Sequence[Pad]) -> Path:
    """Write behaviour, context and robot type; return the behaviour's file."""
    (folder / "robots").mkdir(parents=True, exist_ok=True)
    (folder / "robots" / "quad.xmi").write_text(QUAD, "utf-8")
    (folder / "context.xmi").write_text(_context(len(pads)), "utf-8")
    (folder / "behaviour.xmi").write_text(_behaviour(pads), "utf-8")
    return folder / "behaviour.xmi"


def _behaviour(pads: Sequence[Pad]) -> str:
    targets: list[str] = []
    robots = "\n".join(_robot(index, pad, pads, targets) for index, pad in enumerate(pads))
    origin = len(targets)
    targets.append(_target(0, (0.0, 0.0, 0.0)))
    return (
        HEAD.format(
            root="behaviour:Behaviour",
            rest=f'name="faults" altitudeReference="MSL" reserve="0.2"'
            f' origin="//@targets.{origin}" positionError="0.4"',
        )
        + "  <acceptedUnknowns>endurance</acceptedUnknowns>\n  <acceptedUnknowns>energy</acceptedUnknowns>\n"
        + robots
        + "\n  "
        + "\n  ".join(targets)
        + "\n</behaviour:Behaviour>\n"
    )


def _robot(index: int, pad: Pad, pads: Sequence[Pad], targets: list[str]) -> str:
    def target(place: tuple[float, float, float]) -> str:
        targets.append(_target(index, place))
        return f"//@targets.{len(targets) - 1}"

    steps = [Step("behaviour:Start", "start"), *steps_of(pad, pads), Step("behaviour:Stop", "stop")]
    home = target((0.0, 0.0, 0.0))
    lines = [f'  <robots id={quoteattr(pad.robot)} typeName="Quad" home="{home}">']
    lines += ['    <slots name="go"/>'] if any(step.waits for step in steps) else []
    for step in steps:
        place = f' target="{target(step.target)}"' if step.target else ""
        lines.append(
            f'    <moves xsi:type="{step.kind}" name="{step.name}" {step.attributes}{place}>'
            f"{step.actions}</moves>"
        )
    for number, step in enumerate(steps[:-1]):
        moves = f"//@robots.{index}/@moves."
        waits = f' waitFor="//@robots.{index}/@slots.0"' if step.waits else ""
        lines.append(
            f'    <moveTransitions from="{moves}{number}" to="{moves}{number + 1}"'
            f'{waits} fluid="{str(step.fluid).lower()}">'
            f"{_policies(pad.of_wait) if step.waits else ''}</moveTransitions>"
        )
    return "\n".join([*lines, f"    {_policies(pad.policies)}", "  </robots>"])


def _policies(policies: Iterable[POLICY]) -> str:
    return "".join(
        f'<policies event="{event}" response="{response}"'
        + (f' after="{after}"/>' if after is not None else "/>")
        for event, response, after in policies
    )


def _degrees(index: int, north: float, east: float) -> tuple[float, float]:
    return _away(home_of(index), north, east)


def _away(place: tuple[float, float], north: float, east: float) -> tuple[float, float]:
    """Return the latitude and longitude that are so many metres from others."""
    azimuth = degrees(atan2(east, north))
    longitude, latitude, _ = EARTH.fwd(place[1], place[0], azimuth, hypot(north, east))
    return latitude, longitude


def _target(index: int, place: tuple[float, float, float]) -> str:
    latitude, longitude = _degrees(index, place[0], place[1])
    return (
        f'<targets xsi:type="behaviour:GeoCoordinate" latitude="{latitude:.9f}" longitude="{longitude:.9f}"'
        f' altitude="{ALTITUDE + place[2]}"/>'
    )


def _context(pads: int) -> str:
    areas = []
    for index in range(pads):
        corners = "".join(
            f'<shell xsi:type="mission:GeoCoordinate" latitude="{latitude:.9f}" longitude="{longitude:.9f}"/>'
            for latitude, longitude in (_degrees(index, *corner) for corner in MEADOW)
        )
        areas.append(
            f'  <emergencyAreas name="meadow {index}" safetyDistance="1.0">{corners}</emergencyAreas>'
        )
    return (
        HEAD.format(root="context:Context", rest='name="pads"') + "\n".join(areas) + "\n</context:Context>\n"
    )


HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<{root} xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:behaviour="urn:mmrs:behaviour:1.0" xmlns:multicopter="urn:mmrs:multicopter:1.0"
    xmlns:context="urn:mmrs:context:1.0" xmlns:mission="urn:mmrs:mission:1.0" {rest}>
"""

QUAD = """<?xml version="1.0" encoding="UTF-8"?>
<multicopter:Drone xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:multicopter="urn:mmrs:multicopter:1.0"
    name="Quad" onBoardObstacleAvoidance="false" gyro="true" gps="true" accelerometer="true"
    magnetometer="true" barometer="true" communicationRange="1000.0" maxAltitude="100.0" positionHold="8.0">
  <operatingTemperature min="0.0" max="40.0"/>
  <size xsi:type="multicopter:DroneSize" width="0.3" length="0.3" height="0.1" weight="0.75" propellers="4"
      propellerSize="203.0"/>
  <devices id="camera" name="Camera">
    <properties name="mavlink.camera" value="1"/>
    <supportedActions name="TakePicture" description="Takes one photo." duration="1.0"/>
  </devices>
  <batteries capacity="3600.0" voltage="11.4" rechargeTime="30.0"/>
  <movementCapabilities lifetime="1200.0" maxAcceleration="4.0" maxClimbRate="3.0" maxDescentRate="2.0"
      maxTurnRate="90.0">
    <speed min="0.0" max="10.0"/>
  </movementCapabilities>
</multicopter:Drone>
"""
