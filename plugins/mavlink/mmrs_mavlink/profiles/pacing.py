"""How long vehicles take for what they do: by their firmware's parameters and source, and as measured.

Measured were ArduCopter, ArduSub and Rover 4.7-dev and PX4 1.15 in their own simulations, with the default
parameters of their classes. Flights calibrated what no source states: settling, overshoot, the
deceleration of single legs, the speed and lag of subs; which ones, and how others agree, is in
``benchmarks/results/flown_times.txt``.
Other parameters, such as WPNAV_ACCEL, make other figures: robot types state theirs.
"""

from __future__ import annotations

from mmrs_runtime.timing import AutopilotTiming, LegTiming

HEARTBEATS = 2.0
"""Seconds within which a vehicle shows what it is: it does so each second, and one message may be lost."""

UNKNOWN = AutopilotTiming()
"""The limits of the robot type demand what is missing."""

COPTER = AutopilotTiming(
    step=LegTiming(
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
        reporting=HEARTBEATS,
    ),
    mission=LegTiming(
        acceleration=2.5,
        vertical_acceleration=1.0,
        jerk=0.9,
        climb=2.5,
        descent=1.5,
        corner_radius=2.0,
        settling=1.55,
        spread=0.18,
        reporting=5.0,
    ),
    launch=3.0,
    recovery=3.0,
    landing_rate=0.5,
    landing_height=10.0,
    turn_rate=60.0,
)
"""WPNAV_ACCEL, WPNAV_ACCEL_Z, WPNAV_SPEED_UP and WPNAV_SPEED_DN, LAND_SPEED and LAND_ALT_LOW; ATC_SLEW_YAW,
of which 52 degrees per second were measured; PSC_JERK_NE where it is commanded leg by leg, WPNAV_JERK and
WPNAV_RADIUS on missions, whose legs hold for a second. WPNAV_JERK is 1 m/s³ and comes and goes within twice
ATC_INPUT_TC, 0.3 s (``AC_WPNav::calc_scurve_jerk_and_snap``), which makes each phase longer by as much, as
0.9 m/s³ do at WPNAV_ACCEL. A mission begins with coming to a stop: one whose first leg has no length took
4.4 to 4.6 s for it.

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

SHUNTS_FOR = 7.0
"""Seconds of a leg up to which it does so, too, if that is farther.

It gets back onto its line by PSC_POS_P, 0.2 per second: after corners of 90 degrees and legs of 12 m at 2
m/s, one stood 0.6 to 0.9 m beside its target, at 1.5 m/s 0.3 m.
"""

ASIDE_DEGREES = 15.0
"""Up to here a rover sets out at once: it is on its leg again within a fifth of its turning radius."""

PIVOT_DEGREES = 115.0
"""WP_PIVOT_ANGLE as drivers set it where it is off: beyond this, a rover on tracks turns before it goes.

Usual corners have other angles: its heading is off by a degree or two, so that at 120, every second corner of
120 degrees was turned on the spot.

Measured with ArduRover 4.7-dev on tracks: without it, legs of 4 m straight back took 17 to 21 s, of which it
stood for 10 to 12 s, since straight back it asks for no acceleration to the side, by which it steers
(``AR_PosControl::update``); with it, 11.0 s, of which turning takes 4.2 s.
"""

ROVER = AutopilotTiming(
    step=LegTiming(
        acceleration=1.0,
        jerk=1.0,
        corner_radius=0.0,
        acceptance=1.0,
        keeps_acceleration=False,
        spread=0.15,
        reporting=HEARTBEATS,
        shunts_within=SHUNTS_WITHIN,
        shunts_for=SHUNTS_FOR,
        aside=ASIDE_DEGREES,
        pivots=PIVOT_DEGREES,
        swerving=0.4,
        closing=6.2,
    ),
    mission=LegTiming(
        acceleration=1.0,
        jerk=1.0,
        corner_radius=2.0,
        corner_seconds=1.9,
        acceptance=0.5,
        settling=2.4,
        starting=1.2,
        keeps_acceleration=False,
        spread=0.2,
        reporting=5.0,
        shunts_within=0.0,
        aside=ASIDE_DEGREES,
        pivots=PIVOT_DEGREES,
        hesitating=10.0,
    ),
    launch=1.0,
    recovery=0.5,
    rounds=True,
    turn_rate=43.0,
)
"""ATC_ACCEL_MAX, and WP_JERK, which is the acceleration by default; neither is commanded, so that of its type
need not hold. On missions it never reverses to turn, and corners count as passed within WP_RADIUS, which is
set. Half of the settling is before it sets out, as the first and last legs of runs show.

On missions the path waits for a rover that lags (``AR_WPNav::advance_wp_target``), so that it saves less at
corners than the S-curves tell: between turns by 90 degrees, legs of 30 m at 3 m/s took 11.1 s, and between
turns by 60 degrees, legs of 15 and 40 m at 4 m/s took 5.4 and 11.5 s.

In GUIDED the target of one that steers like a car moves on while it turns round, and is made up by PSC_POS_P,
0.2 per second, at the end (``AR_WPNav::update_psc_input_shaping``): legs of 30 m at 1.5 m/s took 2.5, 5.0,
7.2, 12.9 and 14.8 s longer for turns by 135, 150, 160, 170 and 175 degrees, and up to 120 degrees not half a
second. On missions the target waits; but where it is straight behind, it may drive on before it turns: of
five legs back of 6 m, the first took 21.3 s and the others 11.5 s.

WP_PIVOT_RATE is 60 degrees per second, and 43 with speeding up and slowing down: it turned by 180 degrees in
4.2 s, and by 139 degrees in 3.3 s. In GUIDED, legs took 0.3 to 0.6 s longer than that after turns by 90 and
120 degrees, at 1.0 to 1.5 m/s.

Whether it is armed is known by the next heartbeat: after 0.9 s, and 0.2 to 0.9 s."""

SUB = AutopilotTiming(
    step=LegTiming(
        acceleration=1.0,
        jerk=1.0,
        speed=1.35,
        climb=1.05,
        descent=1.5,
        corner_radius=0.0,
        acceptance=1.0,
        settling=-0.75,
        lag=7.0,
        lag_within=17.0,
        keeps_acceleration=False,
        spread=0.2,
        reporting=HEARTBEATS,
    ),
    mission=LegTiming(
        acceleration=1.0,
        jerk=1.0,
        speed=1.35,
        climb=1.05,
        descent=1.5,
        corner_radius=2.0,
        passes=False,
        settling=0.55,
        lag=7.0,
        lag_within=17.0,
        stall=50.0,
        stall_within=2.0,
        keeps_acceleration=False,
        spread=0.2,
        reporting=5.0,
    ),
    launch=1.0,
    recovery=0.5,
    turn_rate=60.0,
)
"""WPNAV_JERK: legs are S-curves, of which the driver takes the last 0.75 s, below 0.3 m/s, as arrived;
missions hold for a second. No acceleration is commanded, so that of its type need not hold.

Against the drag of its hull it makes 0.6 to 0.7 of the commanded speed at first: so much comes from
PSC_VELXY_P, the rest from PSC_VELXY_I, and the path waits for the vehicle meanwhile
(``AC_WPNav::advance_wp_target_along_track``). The time constant is (PSC_VELXY_P + drag) / PSC_VELXY_I; 17 s
were measured, and 7 s more on legs at 0.8 m/s; legs at 0.6 to 1.35 m/s agree, and nothing faster was
measured. It turned at 49 to 57 degrees per second, also with ATC_SLEW_YAW at 20.

Four fifths of what the integrator has built up are left when it stops: legs of 20 to 30 m back took 5 to 6 s
longer than from rest, one that led further 5 s less, and those of 10 m in line 11.7 to 12.6 s. After a long
leg the path of a short one back waits at its very end, too, with the vehicle at rest within 0.05 m of the
target: by 0.05 + (v - PSC_POSXY_P e) / w, an error e of 0.02 m stops it where its speed w is less than that,
until PSC_VELXY_I has moved the vehicle. Legs of 1 m took 22 to 31 s longer, of 2 m 12 to 17 s, and of 5 m 3
s; one of 1 m further none."""

PX4_COPTER = AutopilotTiming(
    step=LegTiming(
        speed=12.0,
        climb=3.0,
        descent=1.5,
        corner_radius=0.0,
        passes=False,
        acceptance=1.5,
        settling=4.35,
        keeps_acceleration=False,
        overshoot=0.34,
        returning=0.4,
        trailing=1.05,
        swinging=3.7,
        spread=0.5,
        reporting=10.0,
    ),
    mission=LegTiming(
        acceleration=3.0,
        jerk=4.0,
        speed=12.0,
        climb=3.0,
        descent=1.5,
        corner_radius=2.0,
        turning=0.5,
        level_within=0.8,
        acceptance=2.0,
        settling=0.35,
        lag=3.8,
        lag_within=6.3,
        lag_halved=1.9,
        spread=0.4,
        reporting=5.0,
    ),
    upright=LegTiming(
        acceleration=3.0,
        deceleration=1.5,
        jerk=4.0,
        climb=1.5,
        descent=1.5,
        corner_radius=0.0,
        spread=1.1,
        reporting=10.0,
    ),
    launch=6.1,
    recovery=3.8,
    noticing=2.3,
    guiding=1.8,
    landing_rate=0.7,
    landing_height=6.9,
    turn_rate=45.0,
)
"""MPC_ACC_HOR, MPC_JERK_AUTO, MPC_XY_VEL_MAX, MPC_Z_V_AUTO_UP, MPC_Z_V_AUTO_DN, MPC_TKO_SPEED,
MPC_LAND_SPEED and MPC_YAWRAUTO_MAX. Between MPC_LAND_ALT1 (10 m) and MPC_LAND_ALT2 (5 m) it descends ever
more slowly, from MPC_Z_V_AUTO_DN to MPC_LAND_SPEED: that takes as long as if it were slow from 6.9 m on.
Then its land detector wants the estimated climb within LNDMC_Z_VEL_MAX for a second. 8 landings of missions
from 12 m took 13.4 to 15.7 s, 14.5 s in the mean, with a standard deviation of 0.7 s, and 18 of programs
16.3 to 21.2 s, 18.6 s in the mean, with 1.3 s; four at the end of a second sortie took 19.9 to 23.6 s. That
was with LNDMC_Z_VEL_MAX = 0.5 and MPC_LAND_CRWL = 0.6, which is to be larger. By default it is 0.25 m/s,
less than the estimate of its simulation wanders by on the ground, and 45 landings took up to 32.3 s: so the
bounds of launch and landing are wider than those of legs.

Leg by leg its set-point goes at the commanded speed from the first to the last metre (``vehicles/px4.py``),
and its own controllers are linear (``PositionControl.cpp``). So it trails by 1 / MPC_XY_P, 0.95 per second;
and since MPC_XY_VEL_I_ACC has come to hold it against its drag by then, it goes beyond the target, which is
left slowly. The overshoot and its time constant are those of the drag of its simulation, 1 N per m/s and
kilogram, from which 0.9 m at 3 m/s, 1.2 to 1.9 m at 5 m/s and 2.5 m at 8 m/s follow, and were measured.
It counts as settled once it has been within 1.5 m for 4 s in all, since it may estimate all that time that
it moves, or that it stands still before.
It makes no more than 9.8 m/s there. A first leg begins 1.8 s late, since OFFBOARD wants set-points before
(guiding).

On missions an item at which it stops is over once it has been within its radius for a second. Against its
drag it comes near to its speed only after some time, and its path waits for it (``PositionSmoothing.cpp``,
``_getMaxXYSpeed`` and MPC_XY_ERR_MAX): legs of 12 m at 5 m/s took 5.5 to 6.9 s, of 30 m 10.0 to 12.1 s, and
of 100 m 25.6 to 25.9 s. The last leg of a mission was reported as done up to 3.6 s late, and a take-off 5 s
late where the vehicle refused to be armed at first.

A place that it passes it passes no faster than on a circle of MPC_XY_TRAJ_P · MPC_ACC_HOR, 1.5 m/s² to the
side, that touches both legs within its radius, and no faster than it may be to stop at the next one
(``TrajectoryConstraints.hpp``); one that is higher or lower by NAV_MC_ALT_RAD it comes to a stop for. Legs of
30 m at 5 m/s between turns by 45°, 90° and 135° took 8.1, 9.5 and 10.4 s in the mean, 5.2 s at 9 m/s between
turns by 20°, and 9.5 s by 135°; in one direction, legs of 5 m at 5 m/s took 1.8 s, of 10 and 15 m at 9 m/s
2.2 and 2.4 s, and of 15 m with 3 m up or down at 5 m/s 5.3 s; legs of 12 m at 3 m/s between turns right round
6.4 s; and in one direction legs of 20 m at 9 and at 2 m/s by turns 4.3 and 6.3 s.

By its controllers the lag is 1 / MPC_XY_VEL_I_ACC, 2.5 s, times v / (v + 2 MPC_XY_P), and its time constant
6.3 s. The lag, of which that is two thirds, and settling are fitted to 56 flights.
"""
