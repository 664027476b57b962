"""How well a vehicle's instruments measure, and what of it a sheet may say otherwise."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import inf

from auv_vessel.sheet import Sheet


@dataclass(frozen=True, slots=True)
class Instruments:
    """Standard deviations of what instruments say, for those that fuse it and those that simulate it.

    Each may be overridden by `Sheet.extra` under its name with a point for the first underscore, such as
    ``heading.bias``.

    Attributes:
        pressure_noise: pascals. pressure_air: of the air at the surface, pascals absolute.
        rates_noise: degrees per second. rates_bias: constant error of the gyroscopes.
        attitude_noise: degrees, of roll and pitch.
        heading_noise: degrees. heading_bias: constant error of the compass.
        acceleration_noise: metres per second squared.
        log_noise: of the Doppler log, metres per second. log_bias: constant error along each of its axes.
        log_least, log_most: altitudes between which it has the bottom, metres.
        fix_noise: metres along each axis. fix_depth: metres of the receiver up to which it has a fix.
        start_noise: of the position where the vehicle is put into the water, metres along each axis.
    """

    pressure_noise: float = 60.0
    pressure_air: float = 101_325.0
    rates_noise: float = 0.15
    rates_bias: float = 0.02
    attitude_noise: float = 0.2
    heading_noise: float = 0.5
    heading_bias: float = 1.0
    acceleration_noise: float = 0.02
    log_noise: float = 0.01
    log_bias: float = 0.005
    log_least: float = 0.3
    log_most: float = 50.0
    fix_noise: float = 0.5
    fix_depth: float = 0.1
    start_noise: float = 0.1


def instruments_of(sheet: Sheet) -> Instruments:
    """Return what a vehicle's instruments are like.

    Raises:
        ValueError: a value of `extra` is negative.
    """
    given: dict[str, float] = {}
    for each in fields(Instruments):
        key = each.name.replace("_", ".", 1)
        value = sheet.extra.get(key)
        if value is None:
            continue
        if not 0.0 <= value < inf:
            raise ValueError(f"{sheet.robot}: {key} is {value:g}, and is to be 0 or more")
        given[each.name] = value
    return Instruments(**given)
