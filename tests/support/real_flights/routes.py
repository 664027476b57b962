"""Behaviours of one robot or a few, as short routes, and the shipped examples."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from shutil import copy, copytree

from mmrs_core.resources import shipped

Place = tuple[float, float, float]
"""Metres east, north and up of the robot's home; under water, up of the surface."""

CHARGING = 180.0
"""Seconds: the longest that a battery of the crafts' types takes."""

WIND_FROM = 45.0
"""Degrees from which the wind blows that is expected: half along, half across each leg of a square."""

ORIGIN = 'latitude="42.35" longitude="13.39" altitude="630.0"'
AT_SEA = 'latitude="40.66" longitude="14.30" altitude="0.0"'


@dataclass(frozen=True, slots=True)
class Craft:
    """A robot type of an example, and what its behaviours begin and end with.

    Attributes:
        example, file: where the type stands. type: its name.
        goes: metaclass of its legs. up, down: its first and last moves, with their attributes.
        origin: where it is.
    """

    example: str
    file: str
    type: str
    goes: str = "behaviour:GoTo"
    up: str = ""
    down: str = ""
    origin: str = ORIGIN


COPTER = Craft(
    "carbon-dioxide",
    "quad-650.xmi",
    "Quad 650",
    "multicopter:GoTo",
    '<moves xsi:type="multicopter:TakeOff" name="up" altitude="12.0"/>',
    '<moves xsi:type="multicopter:Land" name="down"/>',
)
PHOTOGRAPHER = replace(COPTER, example="barn", file="yard-drone.xmi", type="Yard drone")
ROVER = Craft("drone-and-rover", "field-rover.xmi", "Field rover")
CRAWLER = Craft("mixed-team", "crawler.xmi", "Crawler")
SUB = Craft("outfall", "survey-auv.xmi", "Survey AUV", origin=AT_SEA)


@dataclass(frozen=True, slots=True)
class Route:
    """What one robot does.

    Attributes:
        robot: its name.
        craft: that goes.
        places: in this order; the moves are ``p0``, ``p1`` and so on.
        speed: metres per second.
        fluid: whether it passes all places but the last.
        stays: seconds that it stays at the first place (move ``stay``).
        policies: event, response, seconds.
        home: metres east and north of the origin.
        turns: degrees per second at which it turns to two other places at each; 0: it does not.
        photos: metres between photos that are taken in passing, on each leg; 0: none.
        looks: what its front looks at on all legs but the first; None: it looks where it goes.
        sorties: how often it does all that. It charges before the second, whose moves are ``2-p0`` and so on.
    """

    robot: str
    craft: Craft
    places: Sequence[Place]
    speed: float
    fluid: bool = False
    stays: float = 0.0
    policies: Sequence[tuple[str, str, float]] = ()
    home: tuple[float, float] = (0.0, 0.0)
    turns: float = 0.0
    photos: float = 0.0
    looks: Place | None = None
    sorties: int = 1


def routes(*given: Route, forbidden: Sequence[Place] = (), wind: float = 0.0) -> Callable[[Path], None]:
    """Return what writes a behaviour of these routes.

    Args:
        given: of one robot each.
        forbidden: shell of an area, metres of the origin.
        wind: that is expected, metres per second.
    """

    def write(folder: Path) -> None:
        (folder / "robots").mkdir(parents=True)
        for craft in {route.craft for route in given}:
            copy(shipped("examples") / craft.example / "robots" / craft.file, folder / "robots")
        for route in (route for route in given if route.turns):
            file = folder / "robots" / route.craft.file
            rate = f'maxTurnRate="{route.turns:g}"'
            file.write_text(re.sub(r'maxTurnRate="[^"]*"', rate, file.read_text("utf-8")), "utf-8")
        (folder / "context.xmi").write_text(_context(given[0].craft.origin, forbidden, wind), "utf-8")
        (folder / "behaviour.xmi").write_text(_behaviour(given), "utf-8")

    return write


def on_px4(models: Callable[[Path], None]) -> Callable[[Path], None]:
    """Return what writes the same models, of robots with a PX4, which takes other times than an ArduPilot."""

    def write(folder: Path) -> None:
        models(folder)
        for file in (folder / "robots").iterdir():
            before, device, after = file.read_text("utf-8").partition("<devices ")
            name, end, after = after.partition(">")
            of_px4 = '<properties name="mavlink.autopilot" value="px4"/>'
            file.write_text(before + device + name + end + of_px4 + after, "utf-8")

    return write


def example(name: str, changes: Mapping[str, str] | None = None) -> Callable[[Path], None]:
    """Return what copies a shipped example; `changes` are texts of its robot types that are replaced."""

    def write(folder: Path) -> None:
        copytree(shipped("examples") / name, folder)
        for file in (folder / "robots").iterdir():
            text = file.read_text("utf-8")
            for old, new in (changes or {}).items():
                text = text.replace(old, new)
            file.write_text(text, "utf-8")

    return write


HEAD = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<{root} xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:behaviour="urn:mmrs:behaviour:1.0"'
    ' xmlns:multicopter="urn:mmrs:multicopter:1.0" xmlns:context="urn:mmrs:context:1.0"'
    ' xmlns:mission="urn:mmrs:mission:1.0" {rest}>\n'
)


def _behaviour(given: Sequence[Route]) -> str:
    targets = [f'<targets xsi:type="behaviour:GeoCoordinate" name="origin" {given[0].craft.origin}/>']
    robots = [_robot(number, route, targets) for number, route in enumerate(given)]
    rest = 'name="Route" altitudeReference="MSL" origin="//@targets.0" positionError="0.5" reserve="0.2"'
    accepted = "".join(
        f"<acceptedUnknowns>{each}</acceptedUnknowns>\n" for each in ("endurance", "energy", "range")
    )
    body = "\n".join((accepted, *robots, *targets))
    return HEAD.format(root="behaviour:Behaviour", rest=rest) + body + "\n</behaviour:Behaviour>\n"


def _robot(number: int, route: Route, targets: list[str]) -> str:
    (east, north), craft = route.home, route.craft
    home = _target(targets, f"{route.robot} home", (east, north, 0.0))
    places = [
        _target(targets, f"{route.robot} p{index}", (east + x, north + y, z))
        for index, (x, y, z) in enumerate(route.places)
    ]
    looks = ""
    if route.looks is not None:
        x, y, z = route.looks
        looked = _target(targets, f"{route.robot} looks", (east + x, north + y, z))
        looks = f'<heading target="{looked}"/>'
    moved = [('<moves xsi:type="behaviour:Start" name="start"/>', False), *_sortie(route, places, looks)]
    for sortie in range(2, route.sorties + 1):
        charge = f'<moves xsi:type="behaviour:Recharge" name="{sortie}-charge" duration="{CHARGING:g}"/>'
        moved += [(charge, False), *_sortie(route, places, looks, f"{sortie}-")]
    moved.append(('<moves xsi:type="behaviour:Stop" name="stop"/>', False))
    moves, fluid = zip(*moved, strict=True)
    at = f"//@robots.{number}/@moves."
    following = [
        f'<moveTransitions from="{at}{index}" to="{at}{index + 1}"{_fluid(fluid[index])}/>'
        for index in range(len(moves) - 1)
    ]
    policies = [
        f'<policies event="{event}" response="{response}" after="{after:g}"/>'
        for event, response, after in route.policies
    ]
    opening = f'<robots id="{route.robot}" typeName="{craft.type}" home="{home}">'
    return "\n".join((opening, *moves, *following, *policies, "</robots>"))


def _sortie(route: Route, places: Sequence[str], looks: str, sortie: str = "") -> Iterator[tuple[str, bool]]:
    """Yield the moves of a sortie, and whether each passes on to the next without a stop."""
    craft = route.craft
    if craft.up:
        yield craft.up.replace('name="', f'name="{sortie}'), False
    for index, target in enumerate(places):
        stays = route.stays if index == 0 else 0.0
        goes = f'<moves xsi:type="{craft.goes}" name="{sortie}p{index}" target="{target}"'
        goes += f' speed="{route.speed:g}">{_photos(route.photos)}{looks if index else ""}</moves>'
        yield goes, route.fluid and index < len(places) - 1 and not stays
        if stays:
            name = f"{sortie}stay"
            yield f'<moves xsi:type="behaviour:HoldPosition" name="{name}" duration="{stays:g}"/>', False
        for ahead in (1, 2) if route.turns else ():
            heading = f'<heading deviceId="camera" target="{places[(index + ahead) % len(places)]}"/>'
            name = f"{sortie}h{index}{ahead}"
            yield f'<moves xsi:type="behaviour:HeadTo" name="{name}">{heading}</moves>', False
    if craft.down:
        yield craft.down.replace('name="', f'name="{sortie}'), False


def _photos(distance: float) -> str:
    """Return the actions by which a leg takes photos in passing; none where the distance is 0."""
    acts = (("preActions", distance), ("postActions", 0.0)) if distance else ()
    return "".join(
        f'<{when} xsi:type="behaviour:DeviceAction" actionName="TriggerByDistance" deviceId="camera">'
        f'<parameters key="distance" value="{metres:g}"/></{when}>'
        for when, metres in acts
    )


def _fluid(passes: bool) -> str:
    return ' fluid="true"' if passes else ""


def _target(targets: list[str], name: str, place: Place) -> str:
    x, y, z = place
    targets.append(
        f'<targets xsi:type="behaviour:RelativeCoordinate" name="{name}" x="{x:.9g}" y="{y:.9g}" z="{z:g}"'
        ' reference="//@targets.0"/>'
    )
    return f"//@targets.{len(targets) - 1}"


def _context(origin: str, forbidden: Sequence[Place], wind: float) -> str:
    shell = "".join(
        f'<shell xsi:type="mission:RelativeCoordinate" x="{x:g}" y="{y:g}"/>' for x, y, _ in forbidden
    )
    area = f'<forbiddenAreas name="school" safetyDistance="1.0">{shell}</forbiddenAreas>\n' if shell else ""
    rest = 'name="Route" crs="EPSG:4326"'
    weather = f'<environment windSpeed="{wind:g}" windDirection="{WIND_FROM:g}" temperature="20.0"'
    weather += ' waterDensity="1025.0"/>\n'
    zero = f'<origin xsi:type="mission:GeoCoordinate" {origin}/>\n'
    return HEAD.format(root="context:Context", rest=rest) + zero + area + weather + "</context:Context>\n"
