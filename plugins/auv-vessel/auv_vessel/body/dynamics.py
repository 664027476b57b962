"""How a vehicle moves in water: six degrees of freedom, by Kirchhoff's equations with drag.

The motion is reckoned relative to water that moves as a whole, which is exact for a steady even current
(Fossen 2011, 8.2). Forces of inertia come from the momentum of hull and water together, so they do no work.
Added mass is taken about the centre of gravity and stays what it is at the surface; drag fades there with
the immersed part of the hull, thrust with the depth of the thruster.

Plain numbers, no arrays: at thirteen numbers, Python's own are several times faster.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, sqrt
from typing import TypeAlias

from auv_vessel.body.hydrodynamics import GRAVITY, Hull, Six, hull_of
from auv_vessel.body.rotation import Quaternion, Rows, rows_of, to_body, to_world
from auv_vessel.sheet import Sheet, Vector

State: TypeAlias = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float
]
"""North, east, depth; quaternion; surge, sway, heave through the water, m/s; roll, pitch, yaw, rad/s."""

_DRAWS_AIR = 0.1  # metres of depth over which a thruster gains its thrust
_GROUND_PULSE, _GROUND_LOSS = 20.0, 0.3  # rad/s and damping ratio of a hull that lies on the bottom
_GRIP, _SLIP = 0.4, 0.05  # friction there, and the metres per second from which it is full
_STICKS = 10.0  # part of a speed that friction takes per second, at most
_FAST, _FINEST = 20.0, 50  # steps per radian of a vehicle that tumbles, and the most parts of one step


@dataclass(frozen=True, slots=True)
class Jet:
    """A thruster's place and the force and moment of one newton of its thrust."""

    position: Vector
    wrench: Six


@dataclass(frozen=True, slots=True)
class Body:
    """A vehicle in its water, as the equations of motion need it.

    Attributes:
        momentum: along each axis that turns with the hull, per metre per second, kilograms.
        weight: newtons. buoyancy: newtons when immersed.
        current: metres per second north and east. bottom: depth, metres.
        reach: metres from the centre of gravity beyond which nothing of the vehicle is.
    """

    hull: Hull
    inertia: Six
    momentum: Vector
    jets: tuple[Jet, ...]
    weight: float
    buoyancy: float
    current: tuple[float, float]
    bottom: float
    reach: float


def body_of(sheet: Sheet, current: tuple[float, float], bottom: float, density: float | None = None) -> Body:
    """Return a vehicle in water that flows so, m/s north and east, above a bottom at that depth.

    Raises:
        ValueError: a dimension, mass, density or coefficient can't be.
    """
    hull = hull_of(sheet)
    jets = tuple(_jet(each.position, each.direction) for each in sheet.thrusters)
    water = sheet.water_density if density is None else density
    if not water > 0.0:
        raise ValueError(f"{sheet.robot}: the density of its water is {water:g}, and has to be positive")
    reach = max([sqrt(_dot(jet.position, jet.position)) for jet in jets], default=0.0)
    return Body(
        hull=hull,
        inertia=hull.inertia,
        momentum=_plus((hull.mass, hull.mass, hull.mass), hull.carried),
        jets=jets,
        weight=hull.mass * GRAVITY,
        buoyancy=water * hull.volume * GRAVITY,
        current=current,
        bottom=bottom,
        reach=max(reach, max(hull.half) + hull.righting_arm),
    )


def lighter(body: Body, ballast: float) -> Body:
    """Return the body without kilograms of ballast at its centre of gravity, whose volume is neglected."""
    surge, sway, heave, roll, pitch, yaw = body.inertia
    inertia = (surge - ballast, sway - ballast, heave - ballast, roll, pitch, yaw)
    momentum = _plus(body.momentum, (-ballast, -ballast, -ballast))
    return replace(body, inertia=inertia, momentum=momentum, weight=body.weight - ballast * GRAVITY)


def floating_depth(body: Body) -> float:
    """Return how deep a level vehicle's centre of gravity floats, m; just immersed if it sinks."""
    part, low, high = body.weight / body.buoyancy, 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if _immersed(middle) < part else (low, middle)
    return body.hull.righting_arm + body.hull.half[2] * (2.0 * high - 1.0)


def at_rest(body: Body, place: Vector, attitude: Quaternion) -> State:
    """Return the state of a vehicle that stands still over ground."""
    rows = rows_of(*attitude)
    return (*place, *attitude, *to_body(rows, (-body.current[0], -body.current[1], 0.0)), 0.0, 0.0, 0.0)


def over_ground(body: Body, state: State) -> Vector:
    """Return velocity north, east and down, metres per second."""
    north, east, down = to_world(rows_of(*state[3:7]), state[7:10])
    return north + body.current[0], east + body.current[1], down


def step(body: Body, state: State, thrusts: Sequence[Sequence[float]], duration: float) -> State:
    """Return the state `seconds` later, in shorter steps if the hull tumbles or drag is very great.

    Args:
        thrusts: of all thrusters, newtons, at the beginning, in the middle and at the end.
    """
    fastest = max(_decay(body, state), _FAST * max(state[10:]), -_FAST * min(state[10:]))
    parts = ceil(min(fastest * duration, _FINEST))
    if parts <= 1:
        return runge_kutta(body, state, thrusts, duration)
    for _ in range(parts):
        state = runge_kutta(body, state, (thrusts[1], thrusts[1], thrusts[1]), duration / parts)
    return state


def runge_kutta(body: Body, state: State, thrusts: Sequence[Sequence[float]], duration: float) -> State:
    """Return the state after one step of the classic method of order four; see `step`."""
    half, sixth = duration / 2.0, duration / 6.0
    first = slopes(body, state, thrusts[0])
    second = slopes(body, _moved(state, first, half), thrusts[1])
    third = slopes(body, _moved(state, second, half), thrusts[1])
    fourth = slopes(body, _moved(state, third, duration), thrusts[2])
    moved = [
        s + sixth * (a + 2.0 * (b + c) + d)
        for s, a, b, c, d in zip(state, first, second, third, fourth, strict=True)
    ]
    w, x, y, z = moved[3:7]
    norm = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    moved[3:7] = w * norm, x * norm, y * norm, z * norm
    return tuple(moved)  # type: ignore[return-value]


def slopes(body: Body, state: State, thrusts: Sequence[float]) -> State:
    """Return what each number of a state changes by per second."""
    qw, qx, qy, qz = state[3:7]
    u, v, w, p, q, r = state[7:]
    rows = rows_of(qw, qx, qy, qz)
    north, east, down = to_world(rows, (u, v, w))
    forces = _forces(body, state, rows, thrusts)
    m1, m2, m3, i1, i2, i3 = body.inertia
    n1, n2, n3 = body.momentum
    a, b, c = n1 * u, n2 * v, n3 * w
    k, l, m = i1 * p, i2 * q, i3 * r  # noqa: E741
    return (
        north + body.current[0],
        east + body.current[1],
        down,
        0.5 * (-qx * p - qy * q - qz * r),
        0.5 * (qw * p + qy * r - qz * q),
        0.5 * (qw * q + qz * p - qx * r),
        0.5 * (qw * r + qx * q - qy * p),
        (forces[0] + b * r - c * q) / m1,
        (forces[1] + c * p - a * r) / m2,
        (forces[2] + a * q - b * p) / m3,
        (forces[3] + l * r - m * q + b * w - c * v) / i1,
        (forces[4] + m * p - k * r + c * u - a * w) / i2,
        (forces[5] + k * q - l * p + a * v - b * u) / i3,
    )


def drag(body: Body, state: State) -> Six:
    """Return force and moment of the water on the moving hull, newtons and newton metres."""
    wet = _immersed(_immersion(body, state[2], rows_of(*state[3:7])[2])[0])
    return _drag(body.hull, state, wet)


def thrust(body: Body, state: State, thrusts: Sequence[float]) -> Six:
    """Return force and moment of the thrusters, newtons and newton metres."""
    return _thrust(body, state[2], rows_of(*state[3:7])[2], thrusts)


def energy(body: Body, state: State) -> float:
    """Return kinetic energy relative to the water and potential energy, joules; this is 0 at the surface.

    A vehicle that touches nothing loses by drag, and gains by thrust, what this changes by.
    """
    down = rows_of(*state[3:7])[2]
    kinetic = 0.5 * sum(mass * speed * speed for mass, speed in zip(body.inertia, state[7:], strict=True))
    immersion, extent, centre = _immersion(body, state[2], down)
    afloat = extent * immersion**3 * (2.0 - immersion) if immersion < 1.0 else centre
    pressed = max(0.0, centre + extent - body.bottom)
    return (
        kinetic - body.weight * state[2] + body.buoyancy * afloat + 0.5 * _stiffness(body) * pressed * pressed
    )


def _forces(body: Body, state: State, rows: Rows, thrusts: Sequence[float]) -> Six:
    """Return all force and moment on a body but those of inertia."""
    down = rows[2]
    immersion, extent, centre = _immersion(body, state[2], down)
    wet = _immersed(immersion)
    dx, dy, dz, dk, dm, dn = _drag(body.hull, state, wet)
    tx, ty, tz, tk, tm, tn = _thrust(body, state[2], down, thrusts)
    lift = body.buoyancy * wet
    arm = _buoyancy_centre(body.hull, down, immersion, extent)
    rx, ry, rz = _cross(down, arm)  # lift acts against down: arm x (-lift down)
    heavy = body.weight - lift
    forces = (
        dx + tx + heavy * down[0],
        dy + ty + heavy * down[1],
        dz + tz + heavy * down[2],
        dk + tk + lift * rx,
        dm + tm + lift * ry,
        dn + tn + lift * rz,
    )
    if centre + extent > body.bottom:
        return _added(forces, _ground(body, state, rows, extent, centre + extent - body.bottom))
    return forces


def _immersion(body: Body, depth: float, down: Vector) -> tuple[float, float, float]:
    """Return the immersed part of the hull's height, half that height and its middle's depth, m."""
    a, b, c = body.hull.half
    x, y, z = down
    extent = sqrt(a * a * x * x + b * b * y * y + c * c * z * z)
    centre = depth - body.hull.righting_arm * z
    return max(0.0, min(1.0, (centre + extent) / (2.0 * extent))), extent, centre


def _immersed(immersion: float) -> float:
    """Return the immersed part of an ellipsoid's volume by that of its height."""
    return immersion * immersion * (3.0 - 2.0 * immersion)


def _buoyancy_centre(hull: Hull, down: Vector, immersion: float, extent: float) -> Vector:
    """Return where buoyancy acts: the middle of the immersed cap of the ellipsoid."""
    x, y, z = 0.0, 0.0, -hull.righting_arm
    if immersion < 1.0:
        cap = 3.0 * (1.0 - immersion) ** 2 / (3.0 - 2.0 * immersion) / extent
        a, b, c = hull.half
        x, y, z = x + cap * a * a * down[0], y + cap * b * b * down[1], z + cap * c * c * down[2]
    return x, y, z


def _drag(hull: Hull, state: State, wet: float) -> Six:
    u, v, w, p, q, r = state[7:]
    a, b, c, d, e, f = hull.linear
    g, h, i, j, k, l = hull.quadratic  # noqa: E741
    return (
        -wet * (a + g * abs(u)) * u,
        -wet * (b + h * abs(v)) * v,
        -wet * (c + i * abs(w)) * w,
        -wet * (d + j * abs(p)) * p,
        -wet * (e + k * abs(q)) * q,
        -wet * (f + l * abs(r)) * r,
    )


def _thrust(body: Body, depth: float, down: Vector, thrusts: Sequence[float]) -> Six:
    x = y = z = k = m = n = 0.0
    deep = depth > body.reach + _DRAWS_AIR
    for jet, force in zip(body.jets, thrusts, strict=True):
        if force == 0.0:
            continue
        if not deep:
            force *= max(0.0, min(1.0, (depth + _dot(down, jet.position)) / _DRAWS_AIR))
        a, b, c, d, e, f = jet.wrench
        x += a * force
        y += b * force
        z += c * force
        k += d * force
        m += e * force
        n += f * force
    return x, y, z, k, m, n


def _ground(body: Body, state: State, rows: Rows, extent: float, pressed: float) -> Six:
    """Return the force of the bottom on a hull pressed `depth` metres into it: spring, damper, friction."""
    a, b, c = body.hull.half
    down = rows[2]
    x, y, z = down
    point = (a * a * x / extent, b * b * y / extent, c * c * z / extent - body.hull.righting_arm)
    ground = _plus(state[7:10], to_body(rows, (body.current[0], body.current[1], 0.0)))
    speed = _plus(ground, _cross(state[10:13], point))
    sinks = _dot(speed, down)
    mass = body.inertia[2]
    normal = max(0.0, _stiffness(body) * pressed + 2.0 * _GROUND_LOSS * _GROUND_PULSE * mass * sinks)
    slides = _plus(speed, (-sinks * x, -sinks * y, -sinks * z))
    grip = -min(_GRIP * normal / (sqrt(_dot(slides, slides)) + _SLIP), _STICKS * mass)
    force = _plus(
        (-normal * x, -normal * y, -normal * z), (grip * slides[0], grip * slides[1], grip * slides[2])
    )
    return (*force, *_cross(point, force))


def _stiffness(body: Body) -> float:
    return _GROUND_PULSE**2 * body.inertia[2]


def _decay(body: Body, state: State) -> float:
    """Return the greatest part of a speed that drag takes per second."""
    most = 0.0
    for linear, quadratic, inertia, speed in zip(
        body.hull.linear, body.hull.quadratic, body.inertia, state[7:], strict=True
    ):
        rate = (linear + 2.0 * quadratic * abs(speed)) / inertia
        if rate > most:
            most = rate
    return most


def _moved(state: State, slope: State, duration: float) -> State:
    return tuple([s + duration * d for s, d in zip(state, slope, strict=True)])  # type: ignore[return-value]


def _jet(position: Vector, direction: Vector) -> Jet:
    return Jet(position, (*direction, *_cross(position, direction)))


def _added(one: Six, other: Six) -> Six:
    a, b, c, d, e, f = one
    g, h, i, j, k, l = other  # noqa: E741
    return a + g, b + h, c + i, d + j, e + k, f + l


def _plus(one: Vector, other: Vector) -> Vector:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def _dot(one: Vector, other: Vector) -> float:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _cross(one: Vector, other: Vector) -> Vector:
    a, b, c = one
    d, e, f = other
    return b * f - c * e, c * d - a * f, a * e - b * d
