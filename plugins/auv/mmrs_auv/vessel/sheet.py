"""What a vehicle is made of, as plain data that goes into files: no models are needed to run it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import TypeAlias

Vector: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Thruster:
    """A thruster and how it is mounted.

    Attributes:
        id: as in the robot's type.
        position: of its thrust, metres forward, to starboard and down of the centre of gravity.
        direction: of the force on the vehicle at positive thrust, a unit vector in the same axes.
        operating_thrust: newtons that it can exert continually. max_thrust: for short periods.
        operating_power: watts at operating thrust; max_power: at peak thrust.
        max_depth: metres.
    """

    id: str
    position: Vector
    direction: Vector
    operating_thrust: float
    max_thrust: float
    operating_power: float
    max_power: float
    max_depth: float


@dataclass(frozen=True, slots=True)
class Sheet:
    """A vehicle.

    Attributes:
        robot: identifier in the behaviour.
        thrusters: in the order of their numbers on the bus.
        length, width, height: of the hull, metres.
        mass: kilograms in air.
        weight_in_water: kilograms of apparent mass when immersed, negative: it floats.
        drop_weight: kilograms of ballast that it can release to come up; 0: none.
        speed: metres per second that it can do forward, at most. max_depth: metres.
        battery: joules when full; hotel: watts that all but the thrusters draw.
        home: metres north and east of the mission's origin, and metres below the surface.
        heading: at home, degrees clockwise from north.
        water_density: kilograms per cubic metre.
        devices: identifiers of the devices that actions name, in the order of their numbers on the bus.
        bit_rate: of the bus, bits per second.
        watchdog: seconds without a valid command after which a thruster's drive stops it.
    """

    robot: str
    thrusters: tuple[Thruster, ...]
    length: float
    width: float
    height: float
    mass: float
    weight_in_water: float
    speed: float
    max_depth: float
    battery: float
    home: Vector
    heading: float = 0.0
    drop_weight: float = 0.0
    hotel: float = 20.0
    water_density: float = 1025.0
    devices: tuple[str, ...] = ()
    bit_rate: int = 500_000
    watchdog: float = 0.5
    extra: dict[str, float] = field(default_factory=dict)


def to_json(sheet: Sheet) -> str:
    """Return a sheet as a file holds it."""
    return json.dumps(asdict(sheet), indent=2) + "\n"


def from_json(text: str) -> Sheet:
    """Return the sheet of a file.

    Raises:
        ValueError: the text is no sheet.
    """
    try:
        found = json.loads(text)
        thrusters = tuple(
            Thruster(**{**each, "position": tuple(each["position"]), "direction": tuple(each["direction"])})
            for each in found.pop("thrusters")
        )
        home, devices = tuple(found.pop("home")), tuple(found.pop("devices", ()))
        extra = dict(found.pop("extra", {}).items())
        return Sheet(**found, thrusters=thrusters, home=home, devices=devices, extra=extra)
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"no sheet of a vehicle: {error}") from error
