"""From a robot's type to the data of a vehicle that its bus and its simulation are made of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import hypot

from auv_vessel.refusals import MOST_DEPTH, MOST_SPEED, SheetError, refuse
from auv_vessel.sheet import Sheet, Thruster, Vector, unknown
from mmrs_auv.kinds import SEA_WATER, largest_depth, thrusters_of
from mmrs_auv.names import AUV_MOVEMENT, IN_WATER_SIZE, MOUNTING
from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.errors import InfeasibleError, UnsupportedError
from mmrs_core.planning.devices import figure
from mmrs_core.scene import Device, Part, Position, RobotType
from mmrs_core.transformation.kinds import capability_for

POSITION = ("forward", "starboard", "down")
PUSH = ("pushForward", "pushStarboard", "pushDown")
HULL = ("length", "width", "height", "weight", "weightInWater")
FIGURES = ("operatingThrust", "maxThrust", "operatingPower", "maxPower")
LOG_KEYS = "dvl."
LOG = {"dvl.range.min": "log.least", "dvl.range.max": "log.most"}
"""What properties of a Doppler log are called in a sheet."""


def is_vehicle(robot_type: RobotType) -> bool:
    """Return whether robots of a type are underwater vehicles."""
    return any(capability.part.is_a(AUV_MOVEMENT) for capability in robot_type.capabilities)


def sheet_of(
    robot_type: RobotType,
    robot: str,
    *,
    home: Position = (0.0, 0.0, 0.0),
    surface: float = 0.0,
    payload: float = 0.0,
    density: float | None = None,
) -> Sheet:
    """Return the data of a vehicle.

    Args:
        robot: its identifier in the behaviour.
        home: metres east, north and up of the mission's origin.
        surface: height of the water surface above the origin, metres.
        payload: that it carries, kilograms.
        density: of the water, kilograms per cubic metre; None: unknown.

    Raises:
        UnsupportedError: the type lacks data, or they fit no vehicle; lists all.
    """
    missing = tuple(_missing(robot_type, payload))
    if missing:
        raise UnsupportedError(
            f"robot '{robot}': type '{robot_type.name}' lacks what a vehicle's bus is made of", missing
        )
    capability = capability_for(robot_type, payload)
    water = SEA_WATER if density is None else density
    size = _part(robot_type.part, "size")
    sheet = Sheet(
        robot=robot,
        thrusters=tuple(_thruster(each) for each in thrusters_of(robot_type, capability.part)),
        length=_figure(size, "length"),
        width=_figure(size, "width"),
        height=_figure(size, "height"),
        mass=_figure(size, "weight"),
        weight_in_water=_figure(size, "weightInWater"),
        drop_weight=_number(size, "dropWeight") or 0.0,
        speed=min(capability.speed[1], MOST_SPEED),
        max_depth=min(largest_depth(robot_type, payload, water), MOST_DEPTH),
        battery=sum(battery.energy for battery in robot_type.batteries),
        home=(home[1], home[0], max(0.0, surface - home[2])),
        water_density=water,
        devices=tuple(robot_type.devices),
        extra=_extra(tuple(robot_type.devices.values())),
    )
    try:
        refuse(sheet)
    except SheetError as error:
        who = f"robot '{robot}', type '{robot_type.name}'"
        raise UnsupportedError(f"{who}: no bus can be made of it", error.faults) from error
    return sheet


def sheet_of_robot(
    program: Program, robot: RobotProgram, robot_type: RobotType, environment: Mapping[str, float]
) -> Sheet:
    """Return the data of the vehicle of a robot of a behaviour; errors as in `sheet_of`."""
    surface = program.frame.surface
    home, density = robot.home or (0.0, 0.0, surface), environment.get("waterDensity")
    return sheet_of(robot_type, robot.id, home=home, surface=surface, payload=robot.payload, density=density)


def action_number(robot_type: RobotType, device: str, action: str) -> int | None:
    """Return the number that an action of a device has on the bus; None where it does not support it."""
    supported = robot_type.devices.get(device)
    return list(supported.actions).index(action) if supported and action in supported.actions else None


def _missing(robot_type: RobotType, payload: float) -> Iterator[str]:
    try:
        capability = capability_for(robot_type, payload)
        largest_depth(robot_type, payload, SEA_WATER)
    except InfeasibleError as error:
        yield str(error)
        return
    if not is_vehicle(robot_type):
        yield "movementCapabilities: no AUVMovement"
        return
    size = _part(robot_type.part, "size")
    if size is None or not size.is_a(IN_WATER_SIZE):
        yield "size: no InWaterSize, which defines its weight in water"
    else:
        yield from (f"size: {feature}" for feature in HULL if _number(size, feature) is None)
    for name, device in robot_type.devices.items():
        yield from (f"device '{name}': {wrong}" for wrong in _wrong_log(device))
    if not robot_type.batteries:
        yield "batteries: none"
    thrusters = thrusters_of(robot_type, capability.part)
    if not thrusters:
        yield "thrusters: none"
    for number, thruster in enumerate(thrusters):
        label = f"thruster '{thruster.attributes.get('id') or number}'"
        yield from (f"{label}: {figure}" for figure in FIGURES if _number(thruster, figure) is None)
        mounting = _part(thruster, "mounting")
        if mounting is None or not mounting.is_a(MOUNTING):
            yield f"{label}: mounting, which defines where it sits and which way it pushes"
        elif not any(_vector(mounting, PUSH)):
            yield f"{label}: mounting: {', '.join(PUSH)} are all 0"


def _wrong_log(device: Device) -> Iterator[str]:
    """Yield which properties of a Doppler log say nothing."""
    for key, text in device.properties.items():
        if key.startswith(LOG_KEYS) and key not in LOG:
            yield f"property {key!r}: {unknown(key, LOG)}"
        elif key in LOG and figure(device.properties, key) is None:
            yield f"property {key!r} is {text!r}, no number above 0"


def _thruster(part: Part) -> Thruster:
    mounting = _part(part, "mounting")
    push = _vector(mounting, PUSH)
    most = max(map(abs, push))
    forward, starboard, down = (each / most for each in push)
    length = hypot(forward, starboard, down)
    depth = _number(part, "maxDepth")
    return Thruster(
        id=str(part.attributes.get("id")),
        position=_vector(mounting, POSITION),
        direction=(forward / length, starboard / length, down / length),
        operating_thrust=_figure(part, "operatingThrust"),
        max_thrust=_figure(part, "maxThrust"),
        operating_power=_figure(part, "operatingPower"),
        max_power=_figure(part, "maxPower"),
        max_depth=MOST_DEPTH if depth is None else depth,
    )


def _extra(devices: tuple[Device, ...]) -> dict[str, float]:
    """Return how long devices take, and what the Doppler log can do."""
    found: dict[str, float] = {}
    for number, device in enumerate(devices):
        if device.actions:
            found[f"device{number}.seconds"] = max(each.duration for each in device.actions.values())
        if device.properties.get("sensor.kind") == "dvl":
            known = {LOG[key]: text for key, text in device.properties.items() if key in LOG}
            found |= {name: float(text) for name, text in known.items()}
    return found


def _part(part: Part, feature: str) -> Part | None:
    found = part.attributes.get(feature)
    return found if isinstance(found, Part) else None


def _number(part: Part | None, feature: str) -> float | None:
    found = part.attributes.get(feature) if part is not None else None
    return float(found) if isinstance(found, (int, float)) and not isinstance(found, bool) else None


def _figure(part: Part | None, feature: str) -> float:
    found = _number(part, feature)
    assert found is not None
    return found


def _vector(part: Part | None, features: tuple[str, str, str]) -> Vector:
    first, second, third = (_number(part, feature) or 0.0 for feature in features)
    return (first, second, third)
