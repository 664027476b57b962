"""Small missions, and the scenes that they become."""

import pytest

from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.scenes import ground
from mmrs_core.languages import mission, robot
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet


def geo(latitude=42.37, longitude=13.35, **heights) -> Element:
    return mission.GeoCoordinate(latitude=latitude, longitude=longitude, **heights)


def relative(x=0.0, y=0.0, z=0.0, **more) -> Element:
    return mission.RelativeCoordinate(x=x, y=y, z=z, **more)


def quad(**more) -> Element:
    features = {
        "name": "quad",
        "size": robot.Size(width=1.0, length=2.0, height=2.0, weight=1.5),
        "movementCapabilities": [
            robot.MovementCapability(
                payloadWeight=0.0, lifetime=1200.0, speed=robot.Interval(min=1.0, max=10.0)
            )
        ],
    }
    return robot.Robot(**{**features, **more})


def simple(registry, *homes, point=None, **features) -> Element:
    """Return a mission with a visit to one point, and a quadrocopter at each of some homes."""
    robots = [mission.Robot(name=f"r{n}", type="quad", home=home) for n, home in enumerate(homes)]
    visit = registry.create("urn:test:visit", "Visit", name="visit", point=point or relative(1.0, 2.0, 3.0))
    return mission.Mission(name="m", team=mission.Team(robots=robots), **{"tasks": [visit], **features})


def scene(made, place=None, **types):
    """Return a mission's scene at a place, with types of robots by name."""
    return ground(ModelSet(made, place, types or {"quad": quad()}, ()))


def point_of(made, place=None):
    return scene(made, place).tasks[0].part.attributes["point"]


def faults(made, place=None, **types) -> list[str]:
    """Return what stands in the way of a scene."""
    with pytest.raises(InvalidModelError) as caught:
        scene(made, place, **types)
    return [fault.message for fault in caught.value.diagnostics]
