"""The mission, its behaviour, and how near to areas a track may come."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, inf
from pathlib import Path
from shutil import copytree

from shapely import LineString, Polygon

from mmrs_core import pipeline
from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.languages.writing import write_model
from mmrs_core.plugins import load_plugins
from mmrs_core.resources import shipped
from mmrs_core.scene import Area, AreaUse, Position
from mmrs_core.testing.programs import installed

EXAMPLE = "carbon-dioxide"
START_SECONDS = 150.0
"""Real seconds until vehicles are ready that were just started, and machines are busy."""

SLACK = 0.05
"""Metres by which a measured track may be off: the record is in millimetres and tenths of a second."""

Track = Sequence[tuple[float, float, float, float]]


@dataclass(frozen=True, slots=True)
class Home:
    """A robot, and where it is at first: degrees, and metres east, north and up in the mission's frame."""

    robot: str
    latitude: float
    longitude: float
    place: tuple[float, float, float]


class Mission:
    """The planned mission, in a folder with its behaviour and its generated controllers.

    Attributes:
        program: what robots do. place: where. homes: in its order. seconds: that it is planned to take.
    """

    def __init__(self, folder: Path, properties: Mapping[str, str] | None = None) -> None:
        """Plan it; `properties` are values of device properties that replace the example's relay."""
        self.folder = folder
        contributions = load_plugins().contributions
        copytree(shipped("examples") / EXAMPLE, folder, dirs_exist_ok=True)
        if properties is not None:
            _rewire(folder / "robots" / "quad-650.xmi", properties)
        models, _ = pipeline.valid_models(folder, contributions)
        scene = pipeline.expand(pipeline.ground(models), contributions)
        plan = pipeline.plan(scene)
        self.seconds = plan.makespan
        behaviour, _ = pipeline.transform(scene, plan, contributions)
        write_model([behaviour], folder / "behaviour.xmi", contributions.languages)
        self.program = pipeline.program_of(behaviour, contributions)
        self.place = pipeline.place_of_scene(scene)
        files = pipeline.render(self.program, self.place, "mavlink-python", contributions)
        pipeline.write(files, folder / "controllers")
        degrees = degrees_of([robot.home[:2] for robot in self.program.robots], self.program.frame)
        self.homes = [
            Home(robot.id, *place, robot.home)
            for robot, place in zip(self.program.robots, degrees, strict=True)
        ]

    def patience(self, speedup: float) -> float:
        """Return the real seconds after which it counts as stuck: twice as planned, and a start."""
        return START_SECONDS + 2.0 * self.seconds / speedup

    def margins(self, home: Home, track: Track) -> dict[str, float]:
        """Return how much farther from each area as drawn than it must be a robot's track stays, metres."""
        return margins(self.program, self.place, home.robot, track)


def _rewire(type: Path, properties: Mapping[str, str]) -> None:
    """Give a type's device on a relay other properties."""
    relay = '<properties name="mavlink.relay" value="0"/>'
    text = type.read_text("utf-8")
    assert relay in text
    others = (f'<properties name="{name}" value="{value}"/>' for name, value in properties.items())
    type.write_text(text.replace(relay, "".join(others)), "utf-8")


def margins(
    program: Program, place: pipeline.BehaviourContext, robot_id: str, track: Track
) -> dict[str, float]:
    """Return how much farther from each area as drawn than it must be a track stays, by area, metres.

    Args:
        program: of all robots. place: where they are, with their types.
        robot_id: whose track it is.
        track: seconds, metres north, east and up of home; under water, up of the surface.
    """
    robot = next(each for each in program.robots if each.id == robot_id)
    kind = robot_kind_of(place.types[robot.type_name], installed().robot_kinds)
    dives = kind is not None and kind.medium == "water"
    zero = (*robot.home[:2], program.frame.surface if dives else robot.home[2])
    needed = place.types[robot.type_name].half_diagonal + program.position_error
    areas = [area for area in place.areas if area.use is not AreaUse.EMERGENCY]
    return {
        area.name: least_distance(zero, track, area) - area.safety_distance - needed
        for area in areas
        if area.concerns(robot.type_name)
    }


def least_distance(zero: Position, track: Track, area: Area) -> float:
    """Return the metres between an area as drawn and what was flown, leg by leg of the record."""
    shape, (east, north, up) = Polygon(area.shell), zero
    least = inf
    for (_, n1, e1, u1), (_, n2, e2, u2) in pairwise(track):
        way = LineString([(east + e1, north + n1), (east + e2, north + n2)])
        above = max(up + min(u1, u2) - area.high, area.low - up - max(u1, u2), 0.0)
        least = min(least, hypot(shape.distance(way), above))
    return least
