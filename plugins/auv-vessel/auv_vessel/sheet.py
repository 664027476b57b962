"""What a vehicle is made of, as plain data that goes into files: no models are needed to run it."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import MISSING, asdict, dataclass, field, fields
from difflib import get_close_matches
from typing import Any, TypeAlias

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


def afloat_of(height: float) -> float:
    """Return the depth of its centre of gravity, metres, above which a vehicle is at the surface."""
    return height / 2.0 + 0.1


def to_json(sheet: Sheet) -> str:
    """Return a sheet as a file holds it."""
    return json.dumps(asdict(sheet), indent=2) + "\n"


def from_json(text: str) -> Sheet:
    """Return the sheet of a file.

    Raises:
        ValueError: the text is not a sheet, or has unknown names; lists these.
    """
    try:
        found = json.loads(text, object_pairs_hook=_once)
    except RecursionError:
        raise ValueError("no sheet of a vehicle: nested too deeply") from None
    if wrong := [*_misshapen(found)] or [*_misnamed(found, Sheet)] or [*_misnamed_thrusters(found)]:
        raise ValueError(f"no sheet of a vehicle: {'; '.join(wrong)}")
    thrusters = tuple(
        Thruster(**{name: _tuple(value) for name, value in each.items()}) for each in found["thrusters"]
    )
    return Sheet(**{name: _tuple(value) for name, value in found.items()} | {"thrusters": thrusters})


def unknown(name: object, known: Collection[str]) -> str:
    """Return that there is nothing of that name, and the name that was perhaps meant."""
    nearest = get_close_matches(str(name), sorted(known), n=1)
    return "there is no such name" + (f"; did you mean {nearest[0]!r}?" if nearest else "")


def _once(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object of JSON, whose names are there once."""
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = next(name for number, (name, _) in enumerate(pairs) if name in dict(pairs[:number]))
        raise ValueError(f"{twice!r} is there more than once")
    return found


def _tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


def _misshapen(found: Any) -> Iterator[str]:
    """Yield whatever is not an object or list where one is needed."""
    if not isinstance(found, dict):
        yield f"{found!r:.40} is not an object"
        return
    for name, kind, word in (
        ("thrusters", list, "a list"),
        ("devices", list, "a list"),
        ("extra", dict, "an object"),
    ):
        if name in found and not isinstance(found[name], kind):
            yield f"{name}: {found[name]!r:.40} is not {word}"
    rows = found.get("thrusters")
    for number, row in enumerate(rows if isinstance(rows, list) else ()):
        if not isinstance(row, dict):
            yield f"thruster {number}: {row!r:.40} is not an object"


def _misnamed(found: Mapping[str, Any], kind: type) -> Iterator[str]:
    """Yield a line for each name that is not of a kind, and for each of its names that is missing."""
    known = {each.name: each for each in fields(kind)}
    yield from (f"{name!r}: {unknown(name, known)}" for name in found if name not in known)
    for name, each in known.items():
        if name not in found and each.default is MISSING and each.default_factory is MISSING:
            yield f"{name!r} is missing"


def _misnamed_thrusters(found: Mapping[str, Any]) -> Iterator[str]:
    for number, row in enumerate(found["thrusters"]):
        yield from (f"thruster {number}: {wrong}" for wrong in _misnamed(row, Thruster))
