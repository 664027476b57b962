"""Whether a robot can be used at all in a place, and for a work."""

from __future__ import annotations

from math import dist, inf

from mmrs_core.scene import Part, Robot, Scene, Value, Work


def unfit(robot: Robot, scene: Scene) -> str | None:
    """Return why no robot of that type operates in the weather of the scene; None if it does.

    What is not known of the weather or of the robot is no reason.
    """
    interval = robot.type.part.attributes.get("operatingTemperature")
    temperature = scene.environment.get("temperature")
    if temperature is None or not isinstance(interval, Part):
        return None
    lowest = _number(interval.attributes.get("min"), -inf)
    highest = _number(interval.attributes.get("max"), inf)
    if lowest <= temperature <= highest:
        return None
    return f"operates from {lowest:g} to {highest:g} °C, not at {temperature:g} °C"


def out_of_reach(work: Work, robot: Robot) -> str | None:
    """Return why the radio does not reach all of a work from the robot's home; None if it does."""
    reach = _number(robot.type.part.attributes.get("communicationRange"), inf)
    places = (point for stroke in work.strokes for point in stroke.points)
    farthest = max((dist(place, robot.home) for place in places), default=0.0)
    if farthest <= reach:
        return None
    return f"would be {farthest:.0f} m from home, its radio reaches {reach:g} m"


def _number(value: Value, absent: float) -> float:
    return float(value) if isinstance(value, (int, float)) else absent
