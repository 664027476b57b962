"""What makes a vehicle's data unfit for a bus, so that nothing is generated from it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import fields
from math import hypot
from sys import float_info
from typing import Any

from auv_vessel.instruments import Instruments
from auv_vessel.sheet import Sheet, Thruster, unknown

MOST_THRUSTERS, MOST_DEVICES = 32, 256
LEAST_THRUST, MOST_THRUST = 0.01, 32767.0
MOST_POWER, MOST_DEPTH, MOST_SPEED, MOST_PLACE = 6553.5, 8388.607, 5.1, 8388.607
LEAST_BIT_RATE, MOST_BIT_RATE, LEAST_WATCHDOG, MOST_WATCHDOG = 5_000, 1_000_000, 0.1, 60.0
LEAST_SIZE, MOST_SIZE, MOST_MASS, MOST_DENSITY, MOST_ENERGY, MOST_EXTRA = (
    0.01,
    1000.0,
    1e8,
    20_000.0,
    1e15,
    1e9,
)
POSITIVE = ("climb.speed", "turn.rate", "search.radius", "search.spacing")
MOST_LEVER = 1000.0
LONGEST_NAME = 64
"""Figures that do not fit are refused. Power, depth, speed and place: what the fields of messages hold; size,
mass, density and energy: beyond any vehicle. `POSITIVE`: what `extra` may only say above 0."""


class SheetError(ValueError):
    """A bus cannot be made of a vehicle's data.

    Attributes:
        faults: one line for each, its place first.
    """

    def __init__(self, faults: Sequence[str]) -> None:
        super().__init__("; ".join(faults))
        self.faults = tuple(faults)


def refuse(sheet: Sheet) -> None:
    """Return if a bus can be made of a vehicle's data.

    Raises:
        SheetError: if not; lists all that is wrong.
    """
    if faults := tuple(faults_of(sheet)):
        raise SheetError(faults)


def faults_of(sheet: Sheet) -> Iterator[str]:
    """Yield all that is wrong with a vehicle's data, each with its place."""
    yield from _name("robot", sheet.robot)
    yield from _hull(sheet)
    if len(sheet.thrusters) > MOST_THRUSTERS:
        yield f"thrusters: {len(sheet.thrusters)}, there are identifiers for {MOST_THRUSTERS}"
    for number, thruster in enumerate(sheet.thrusters):
        place = f"thruster {number} ({thruster.id!r})"
        yield from (f"{place}: {fault}" for fault in _thruster(thruster))
    yield from _twice("thrusters", [thruster.id for thruster in sheet.thrusters])
    if len(sheet.devices) > MOST_DEVICES:
        yield f"devices: {len(sheet.devices)}, there are numbers for {MOST_DEVICES}"
    for number, device in enumerate(sheet.devices):
        yield from _name(f"device {number}", device)
    yield from _twice("devices", sheet.devices)


def _hull(sheet: Sheet) -> Iterator[str]:
    for what in ("length", "width", "height"):
        yield from _number(what, getattr(sheet, what), least=LEAST_SIZE, most=MOST_SIZE)
    for what, most in (("mass", MOST_MASS), ("water_density", MOST_DENSITY), ("battery", MOST_ENERGY)):
        yield from _number(what, getattr(sheet, what), above=0.0, most=most)
    yield from _number("hotel", sheet.hotel, least=0.0, most=MOST_ENERGY)
    yield from _weights(sheet)
    yield from _number("heading", sheet.heading, least=-MOST_EXTRA, most=MOST_EXTRA)
    yield from _number("speed", sheet.speed, above=0.0, most=MOST_SPEED)
    yield from _number("max_depth", sheet.max_depth, above=0.0, most=MOST_DEPTH)
    yield from _number("bit_rate", sheet.bit_rate, least=LEAST_BIT_RATE, most=MOST_BIT_RATE)
    yield from _number("watchdog", sheet.watchdog, least=LEAST_WATCHDOG, most=MOST_WATCHDOG)
    yield from _vector("home", sheet.home, most=MOST_PLACE)
    yield from misnamed(sheet)
    for key, value in sheet.extra.items():
        above = 0.0 if key in POSITIVE else None
        yield from _number(f"extra {key!r}", value, above=above, least=-MOST_EXTRA, most=MOST_EXTRA)
    yield from _log(sheet)


def _log(sheet: Sheet) -> Iterator[str]:
    """Yield that a Doppler log has the bottom at no height, if that is so."""
    usual = Instruments()
    least, most = sheet.extra.get("log.least", usual.log_least), sheet.extra.get("log.most", usual.log_most)
    if not [*_number("", least), *_number("", most)] and least >= most:
        yield f"extra 'log.least': {least!r} is not below 'log.most', {most!r}"


def _weights(sheet: Sheet) -> Iterator[str]:
    """Yield what is wrong with weights, which have to leave a displaced volume and a mass without ballast."""
    for what, least in (("weight_in_water", -MOST_MASS), ("drop_weight", 0.0)):
        faults = list(_number(what, value := getattr(sheet, what), least=least, most=MOST_MASS))
        yield from faults
        if not faults and not list(_number("mass", sheet.mass, above=0.0)) and value >= sheet.mass:
            yield f"{what}: {value!r} is not below the mass, {sheet.mass!r}"


def _thruster(thruster: Thruster) -> Iterator[str]:
    yield from _name("id", thruster.id)
    yield from _vector("position", thruster.position, most=MOST_LEVER)
    wrong = tuple(_vector("direction", thruster.direction))
    yield from wrong
    if not wrong and abs(hypot(*thruster.direction) - 1.0) > 1e-3:
        yield f"direction: {thruster.direction} has the length {hypot(*thruster.direction):g}, not 1"
    thrusts = [
        fault
        for what in ("operating_thrust", "max_thrust")
        for fault in _number(what, getattr(thruster, what), least=LEAST_THRUST, most=MOST_THRUST)
    ]
    yield from thrusts
    if not thrusts and thruster.operating_thrust > thruster.max_thrust:
        yield f"operating_thrust: {thruster.operating_thrust!r} is more than max_thrust"
    for what in ("operating_power", "max_power"):
        yield from _number(what, getattr(thruster, what), least=0.0, most=MOST_POWER)
    yield from _number("max_depth", thruster.max_depth, above=0.0)


def _vector(what: str, value: Any, *, most: float | None = None) -> Iterator[str]:
    if not isinstance(value, (tuple, list)) or len(value) != 3:
        yield f"{what}: {value!r} is not three numbers"
        return
    for axis, each in enumerate(value):
        yield from _number(f"{what}[{axis}]", each, least=None if most is None else -most, most=most)


def _number(
    what: str,
    value: Any,
    *,
    above: float | None = None,
    least: float | None = None,
    most: float | None = None,
) -> Iterator[str]:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= float_info.max:
        yield f"{what}: {value!r} is not a finite number"
    elif above is not None and value <= above:
        yield f"{what}: {value!r} is not above {above:g}"
    elif least is not None and value < least:
        yield f"{what}: {value!r} is less than {least:g}"
    elif most is not None and value > most:
        yield f"{what}: {value!r} is more than {most:.10g}, the most that there is room for"


def _name(what: str, value: Any) -> Iterator[str]:
    if not isinstance(value, str) or not value.strip():
        yield f"{what}: {value!r} is not a name"
    elif len(value) > LONGEST_NAME:
        yield f"{what}: {value!r} has more than {LONGEST_NAME} characters"
    elif odd := sorted({each for each in value if not each.isprintable() or each in '"\\'}):
        yield f"{what}: {value!r} has {', '.join(repr(each) for each in odd)}"


def _twice(what: str, names: Sequence[str]) -> Iterator[str]:
    for name in sorted({name for name in names if names.count(name) > 1}, key=str):
        yield f"{what}: {name!r} is there {names.count(name)} times"


_ALONG, _ABOUT = ("surge", "sway", "heave"), ("roll", "pitch", "yaw")
_AXES = {
    "added_mass": _ALONG,
    "linear_drag": (*_ALONG, *_ABOUT),
    "quadratic_drag": (*_ALONG, *_ABOUT),
    "inertia": _ABOUT,
    "added_inertia": _ABOUT,
}

EXTRAS = frozenset((
    *(each.name.replace("_", ".", 1) for each in fields(Instruments)),
    *(f"{name}.{axis}" for name, axes in _AXES.items() for axis in axes),
    "righting_arm", "munk", "thruster.lag", "deadman.time", "antenna.height", "sonar.range",
    "peak.time", "rise.time", "power.limit", "climb.speed", "turn.rate", "search.radius", "search.spacing",
    "movement.patience", "position.lost", "bottom.clearance",
    "camera.front.forward", "camera.front.down", "camera.bottom.forward", "camera.bottom.down",
    "camera.baseline", "camera.focal",
))  # fmt: skip
"""All names but those of devices, which are ``device0.seconds``, ``device1.seconds`` and so on."""

_DEVICE = re.compile(r"device(0|[1-9][0-9]{0,8})\.seconds")


def misnamed(sheet: Sheet) -> Iterator[str]:
    """Yield a line for each unknown name in a sheet's `extra`."""
    devices = [f"device{number}.seconds" for number in range(len(sheet.devices))]
    for key in sheet.extra:
        found = _DEVICE.fullmatch(key) if isinstance(key, str) else None
        if found and int(found[1]) >= len(devices):
            yield f"extra {key!r}: there is no device {found[1]}, there are {len(devices)}"
        elif not found and key not in EXTRAS:
            yield f"extra {key!r}: {unknown(key, (*EXTRAS, *devices))}"
