"""Sample scenes, for rules and kinds that are tested without any model."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from mmrs_core.scene import (
    Area,
    AreaUse,
    Capability,
    Device,
    DeviceAction,
    Frame,
    Kinematics,
    Metaclasses,
    Name,
    Part,
    Position,
    Robot,
    RobotType,
    Scene,
    Task,
    TravelMode,
    Value,
)

ROBOT: Name = ("urn:mmrs:robot:1.0", "Robot")
FLYER = Kinematics(5.0, 0.0, 10.0, 2.0, 2.0, floor=1.0, ceiling=100.0)
"""A robot that stands still in the air, between 1 and 100 metres."""


def sample_type(
    *,
    name: str = "Any",
    metaclasses: Metaclasses = (ROBOT,),
    attributes: Mapping[str, Value] | None = None,
    movement: Part | None = None,
    devices: Mapping[str, Device] | None = None,
    speed: tuple[float, float] = (0.0, 10.0),
    lifetime: float = 1000.0,
    payload: float = 1.0,
    acceleration: float | None = None,
    climb_rate: float | None = None,
    descent_rate: float | None = None,
    turn_rate: float | None = None,
) -> RobotType:
    """Return a robot type with one capability and no battery; half its diagonal is half a metre.

    Args:
        name: of the type.
        metaclasses: of the type, most specific first.
        attributes: of the type, by feature name.
        movement: its movement capability, with the attributes that plug-ins add.
        devices: that it carries, by identifier.
        speed: smallest and largest, metres per second.
        lifetime: on full batteries, seconds.
        payload, acceleration, climb_rate, descent_rate, turn_rate: as in `Capability`.
    """
    part = movement or Part((), {})
    rates = climb_rate, descent_rate, turn_rate
    return RobotType(
        name,
        metaclasses,
        part.metaclasses,
        0.5,
        None,
        (Capability(payload, lifetime, speed, acceleration, *rates, part),),
        (),
        devices or {},
        Part(metaclasses, attributes or {}),
    )


def sample_device(
    id: str, action: str, *parameters: str, properties: Mapping[str, str] | None = None
) -> Device:
    """Return a device that supports one action of a second, with parameters of these keys."""
    return Device(id, {action: DeviceAction(action, 1.0, parameters)}, properties or {})


def sample_robot(
    robot_type: RobotType | None = None,
    *,
    home: Position = (0.0, 0.0, 0.0),
    kinematics: Kinematics | None = FLYER,
    travel_mode: TravelMode = "NORMAL",
    payload: float = 0.0,
    clearance: float = 0.5,
) -> Robot:
    """Return a robot of a type, `sample_type` unless one is given, that comes home at the end."""
    chosen = robot_type or sample_type()
    return Robot(
        "Alba", chosen, home, True, payload, travel_mode, clearance, kind="sample", kinematics=kinematics
    )


def sample_scene(
    *robots: Robot,
    areas: tuple[Area, ...] = (),
    elements: tuple[Part, ...] = (),
    surface: float = 0.0,
    environment: Mapping[str, float] | None = None,
    reserve: float = 0.2,
) -> Scene:
    """Return a scene of robots among areas; `surface` is the height of the water, metres."""
    frame = Frame("EPSG:4326", 42.0, 13.0, surface=surface)
    team = robots or (sample_robot(),)
    return Scene(
        "sample",
        frame,
        (),
        (),
        team,
        areas=areas,
        elements=elements,
        environment=environment or {},
        reserve=reserve,
    )


def square(
    name: str, east: float, north: float, half: float, top: float = inf, *, safety: float = 1.0
) -> Area:
    """Return a square obstacle around a point that reaches up to a height, metres."""
    west, south, right, upper = east - half, north - half, east + half, north + half
    shell = ((west, south), (right, south), (right, upper), (west, upper))
    return Area(name, AreaUse.OBSTACLE, shell, high=top, safety_distance=safety)


def sample_task(metaclass: Name, **attributes: Value) -> Task:
    """Return a grounded task: coordinates are (east, north, up), metres; enumerations are texts."""
    return Task("task", Part((metaclass,), attributes))
