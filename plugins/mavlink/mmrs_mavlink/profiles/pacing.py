"""How long vehicles take for what they do: by their firmware's parameters and source, and as measured.

Measured were ArduCopter, ArduSub and Rover 4.7-dev and PX4 1.15 in their own simulations, with the default
parameters of their classes. Half of the flights calibrated what no source states: settling, overshoot, the
deceleration of single legs, the speed of subs; the others agree (``benchmarks/results/flown_times.txt``).
Other parameters, such as WPNAV_ACCEL, make other figures: robot types state theirs.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf


@dataclass(frozen=True, slots=True)
class LegFigures:
    """How a vehicle takes straight legs in one way of being commanded (``docs/concepts/timing.md``).

    Attributes:
        acceleration, deceleration: level, metres per second squared.
        vertical_acceleration: up and down, metres per second squared.
        jerk: change of acceleration, metres per second cubed.
        speed: largest that it makes, metres per second.
        climb, descent: metres per second.
        corner_radius: metres from a corner within which it passes; 0: it comes to a stop at each.
        acceptance: metres from a target at which it may count as reached.
        settling: seconds from the end of a leg until it is reported as done.
        overshoot: metres that it goes beyond a target for each metre per second of the leg's largest speed.
        spread: by which share legs take longer or shorter than expected.
        shunts_within: turning radii up to which a leg may be shunted for.
    """

    acceleration: float = inf
    deceleration: float | None = None
    vertical_acceleration: float | None = None
    jerk: float = inf
    speed: float = inf
    climb: float = inf
    descent: float = inf
    corner_radius: float = inf
    acceptance: float = 0.0
    settling: float = 0.0
    overshoot: float = 0.0
    spread: float = 0.0
    shunts_within: float = inf


@dataclass(frozen=True, slots=True)
class Pacing:
    """How long a vehicle takes for what it does, in its own seconds.

    Attributes:
        step: for legs that it is commanded one by one: GUIDED, OFFBOARD.
        mission: for legs of a mission that it is given; None: as for single ones.
        launch: from the command to take off until it climbs; None: as its robot kind does.
        recovery: from touching the ground until it is disarmed; None: as its robot kind does.
        landing_rate: metres per second at which it comes down below `landing_height`, metres above ground.
        rounds: whether it drives round where it cannot turn on the spot.
    """

    step: LegFigures = LegFigures()
    mission: LegFigures | None = None
    launch: float | None = None
    recovery: float | None = None
    landing_rate: float = inf
    landing_height: float = 0.0
    rounds: bool = False


UNKNOWN = Pacing()
"""The limits of the robot type demand what is missing."""

COPTER = Pacing(
    step=LegFigures(
        acceleration=2.5,
        deceleration=1.5,
        vertical_acceleration=1.0,
        jerk=5.0,
        climb=2.5,
        descent=1.5,
        corner_radius=0.0,
        acceptance=1.0,
        settling=0.15,
        overshoot=0.145,
        spread=0.18,
    ),
    mission=LegFigures(
        acceleration=2.5,
        vertical_acceleration=1.0,
        jerk=1.0,
        climb=2.5,
        descent=1.5,
        corner_radius=2.0,
        settling=1.75,
        spread=0.18,
    ),
    launch=3.0,
    recovery=3.0,
    landing_rate=0.5,
    landing_height=10.0,
)
"""WPNAV_ACCEL, WPNAV_ACCEL_Z, WPNAV_SPEED_UP and WPNAV_SPEED_DN, LAND_SPEED and LAND_ALT_LOW; PSC_JERK_NE
where it is commanded leg by leg, WPNAV_JERK and WPNAV_RADIUS on missions, whose legs hold for a second.

Leg by leg it slows down by half of its acceleration, which its square-root controller corrects
(``shape_pos_vel_accel_xy``, ``control.cpp``); it goes beyond places by what its velocity controller lags.

The overshoot covers what was measured with ArduCopter 4.7-dev in its own simulation, targets commanded one at
a time in calm air: 0.29 m at 2 m/s, 0.41 m at 3 m/s, 0.63 m at 5 m/s, 0.77 m at 8 m/s and 0.83 m at 10 m/s,
and 1.29 m at 10 m/s on a leg that continued one of 100 m, from 0.66 m beyond its start.
"""

SHUNTS_WITHIN = 8.0
"""Turning radii from where a rover stands within which it shunts to get to a place abreast of it.

Measured with ArduRover 4.7-dev and a radius of 1.2 m: legs of 11 m after a corner of 68 degrees, and of 20 to
25 m after up to 90 degrees, took what is planned for driving round, and up to twice that with shunting; one
of 6.6 m after 90 degrees did not end at its target.
"""

ROVER = Pacing(
    step=LegFigures(
        acceleration=1.0,
        corner_radius=0.0,
        acceptance=1.0,
        settling=0.6,
        spread=0.15,
        shunts_within=SHUNTS_WITHIN,
    ),
    mission=LegFigures(
        acceleration=1.0, jerk=1.0, corner_radius=2.0, settling=2.3, spread=0.2, shunts_within=0.0
    ),
    rounds=True,
)
"""ATC_ACCEL_MAX, and WP_JERK, which is the acceleration by default. On missions it never
reverses to turn."""

SUB = Pacing(
    step=LegFigures(acceleration=1.0, jerk=1.0, speed=1.05, corner_radius=0.0, settling=1.0, spread=0.2),
    mission=LegFigures(acceleration=1.0, jerk=1.0, speed=1.05, corner_radius=2.0, settling=1.0, spread=0.2),
)
"""Its simulated hull makes one metre per second on missions, whatever it is commanded."""

PX4_COPTER = Pacing(
    step=LegFigures(
        acceleration=3.0,
        deceleration=1.5,
        jerk=4.0,
        climb=3.0,
        descent=1.5,
        corner_radius=0.0,
        acceptance=1.0,
        settling=6.5,
        spread=0.3,
    ),
    mission=LegFigures(
        acceleration=3.0,
        deceleration=1.5,
        jerk=4.0,
        climb=3.0,
        descent=1.5,
        corner_radius=2.0,
        settling=1.6,
        spread=0.2,
    ),
    launch=3.2,
    recovery=3.0,
    landing_rate=0.7,
    landing_height=10.0,
)
"""MPC_ACC_HOR, MPC_JERK_AUTO, MPC_Z_V_AUTO_UP, MPC_Z_V_AUTO_DN, MPC_LAND_SPEED and MPC_LAND_ALT1."""
