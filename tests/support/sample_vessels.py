"""Vehicles of which tests are made; numbers of thrusters, mounting and buoyancy differ."""

from math import cos, pi, radians, sin
from random import Random

from auv_vessel.sheet import Sheet, Thruster, Vector


def thruster(name: str, position: Vector, direction: Vector) -> Thruster:
    """Return a thruster of 18 N, for short 35 N."""
    return Thruster(name, position, direction, 18.0, 35.0, 90.0, 230.0, 100.0)


def level(name: str, forward: float, starboard: float, azimuth: float) -> Thruster:
    """Return a horizontal thruster that pushes to an azimuth, degrees from the bow to starboard."""
    angle = radians(azimuth)
    return thruster(name, (forward, starboard, 0.0), (cos(angle), sin(angle), 0.0))


def upright(name: str, forward: float, starboard: float) -> Thruster:
    """Return a thruster that pushes down."""
    return thruster(name, (forward, starboard, 0.0), (0.0, 0.0, 1.0))


VECTORED = (
    level("T1", 0.2, 0.17, -45.0),
    level("T2", 0.2, -0.17, 45.0),
    level("T3", -0.2, 0.17, 45.0),
    level("T4", -0.2, -0.17, -45.0),
)
"""Four at 45 degrees: surge, sway and yaw."""

VERTICAL = (upright("T5", 0.0, 0.17), upright("T6", 0.0, -0.17))


def pool_sheet(**extra: float) -> Sheet:
    """Return a small vehicle with six thrusters, as in the example of a pool: it cannot pitch by itself."""
    return sheet(VECTORED + VERTICAL, **extra)


def torpedo_sheet(**extra: float) -> Sheet:
    """Return a slender vehicle that has no thrust to the side: it steers by its heading."""
    thrusters = (
        level("L", -0.8, -0.15, 0.0),
        level("R", -0.8, 0.15, 0.0),
        upright("B", 0.6, 0.0),
        upright("S", -0.6, 0.0),
    )
    return sheet(
        thrusters, length=1.9, width=0.3, height=0.3, mass=95.0, weight_in_water=-0.5, speed=1.2, **extra
    )


def heavy_sheet(**extra: float) -> Sheet:
    """Return a large vehicle with eight thrusters that sinks unless it drops its weight."""
    upper = tuple(
        upright(f"V{number}", forward, starboard)
        for number, (forward, starboard) in enumerate(((0.4, 0.3), (0.4, -0.3), (-0.4, 0.3), (-0.4, -0.3)))
    )
    lower = tuple(
        level(each.id, 2.0 * each.position[0], 2.0 * each.position[1], azimuth)
        for each, azimuth in zip(VECTORED, (-45.0, 45.0, 45.0, -45.0), strict=True)
    )
    return sheet(
        lower + upper,
        length=1.2,
        width=0.8,
        height=0.6,
        mass=140.0,
        weight_in_water=0.5,
        drop_weight=2.0,
        speed=0.8,
        **extra,
    )


def sheet(
    thrusters: tuple[Thruster, ...],
    *,
    length: float = 0.6,
    width: float = 0.45,
    height: float = 0.35,
    mass: float = 19.0,
    weight_in_water: float = -0.2,
    drop_weight: float = 0.0,
    speed: float = 0.8,
    **extra: float,
) -> Sheet:
    """Return a vehicle at the origin, on its surface, heading north; `extra` goes into the sheet."""
    return Sheet(
        robot="pool-auv",
        thrusters=thrusters,
        length=length,
        width=width,
        height=height,
        mass=mass,
        weight_in_water=weight_in_water,
        drop_weight=drop_weight,
        speed=speed,
        max_depth=60.0,
        battery=799_200.0,
        home=(0.0, 0.0, 0.0),
        devices=("front-camera", "ctd"),
        extra=extra,
    )


def random_start(seed: int) -> dict[str, str]:
    """Return options of the backend can-sim: where a dive begins, in what current, and with which noise."""
    random = Random(seed)
    away, towards = random.uniform(0.0, 0.15), random.uniform(0.0, 2.0 * pi)
    return {
        "seed": str(seed),
        "start": f"{random.uniform(-1.0, 1.0)},{random.uniform(-1.0, 1.0)}",
        "heading": str(random.uniform(0.0, 360.0)),
        "current": f"{away * cos(towards)},{away * sin(towards)}",
    }
