"""Simulated vehicles take legs as S-curves, and keep to them, however steep these are."""

from dataclasses import asdict, replace
from itertools import pairwise
from math import dist

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from mmrs_core.scene.timing import LegTiming, Rates
from mmrs_mavlink.profiles import ARDUCOPTER, ARDUROVER, ARDUSUB, PX4_MULTICOPTER
from mmrs_mavlink.sitl.body import STEP, Body, Vector

PACING = ARDUCOPTER.pacing
level, height = st.floats(-60.0, 60.0), st.floats(3.0, 40.0)
places = st.tuples(level, level, height)
speeds = st.floats(1.0, 6.0)


def flown(places: list[Vector], speed: float, *, curved: bool = True) -> list[Vector]:
    """Return where a vehicle is at each step, from the first place to the last."""
    body = Body(PACING.mission if curved else PACING.step, places[0], speed=speed, curved=curved)
    ahead, track = list(places[1:]), [places[0]]
    while len(track) < 20_000:
        body.target, body.onward = ahead[0], ahead[1] if len(ahead) > 1 else None
        body.advance(STEP)
        track.append(body.position)
        if body.onward is not None and body.passes_target():
            ahead.pop(0)
        elif body.onward is None and dist(body.position, places[-1]) < 0.02 and body.pace < 0.1:
            return track
    raise AssertionError("it does not arrive")


def off(place: Vector, a: Vector, b: Vector) -> float:
    """Return the metres from a place to a leg."""
    leg, way = [y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, place, strict=True)]
    part = sum(x * y for x, y in zip(leg, way, strict=True)) / sum(x * x for x in leg)
    part = min(1.0, max(0.0, part))
    return dist(way, [part * x for x in leg])


@given(places, places, speeds)
@example((30.0, -10.0, 8.0), (40.0, -20.0, 12.0), 6.0)
@settings(max_examples=25, deadline=None)
def test_a_vehicle_keeps_to_a_leg_that_climbs_or_descends(a, b, speed):
    assume(dist(a, b) > 1.0)
    assert max(off(place, a, b) for place in flown([a, b], speed)) < 0.05


@given(st.lists(places, min_size=3, max_size=5), speeds)
@settings(max_examples=15, deadline=None)
def test_a_vehicle_passes_corners_within_its_radius(places, speed):
    legs = list(pairwise(places))
    assume(all(dist(a, b) > 20.0 for a, b in legs))
    assert max(min(off(place, a, b) for a, b in legs) for place in flown(places, speed)) < 2.1


@pytest.mark.parametrize(("length", "speed", "seconds"), [(12.0, 5.0, 7.3), (12.0, 12.0, 7.3)])
def test_a_short_leg_of_a_mission_takes_as_long_as_arducopters(length, speed, seconds):
    """Measured on ArduCopter 4.7-dev, whose WPNAV_JERK is 1 m/s³: 12 m take about 7.3 s."""
    track = flown([(0.0, 0.0, 10.0), (0.0, length, 10.0)], speed)
    assert len(track) * STEP == pytest.approx(seconds, rel=0.1)


@pytest.mark.parametrize(
    ("length", "speed", "beyond"), [(66.6, 8.7, 0.63), (24.5, 6.0, 0.53), (11.5, 4.1, 0.36)]
)
def test_a_vehicle_overshoots_single_targets_as_arducopter(length, speed, beyond):
    """Measured on recorded flights of ArduCopter 4.7-dev in GUIDED, by the peak speed of the leg."""
    track = flown([(0.0, 0.0, 10.0), (0.0, length, 10.0)], speed, curved=False)
    assert max(place[1] for place in track) - length == pytest.approx(beyond, abs=0.12)


def test_a_rover_on_a_mission_sets_out_as_late_as_real_ones():
    """Half of what an ArduRover settles on missions is before its first leg."""
    figures, place = ARDUROVER.pacing.mission, (0.0, 20.0, 0.0)
    body = Body(figures, speed=1.5, curved=True)
    body.target = place
    body.advance(figures.starting)
    assert body.position == (0.0, 0.0, 0.0)
    body.advance(1.0)
    assert body.position[1] > 0.1
    planned = Rates(1.5, 1.0, 1.0, figures).from_stop_to_stop((0.0, 0.0, 0.0), place)
    seconds = figures.starting + 1.0
    while body.rested <= 0.0:
        body.advance(STEP)
        seconds += STEP
    assert seconds == pytest.approx(planned - figures.settling + figures.starting, abs=0.2)


@pytest.mark.parametrize(
    ("length", "speed", "settles"), [(30.0, 5.0, 5.4), (30.0, 3.0, 4.9), (15.0, 2.0, 4.4)]
)
def test_a_px4_that_trails_a_set_point_is_near_as_soon_as_is_planned(length, speed, settles):
    """Measured with PX4 1.15: 1.4 and 0.9 s after its set-point has stopped, it is within 1.5 m."""
    figures = PX4_MULTICOPTER.pacing.step
    body = Body(figures, (0.0, 0.0, 10.0), speed=12.0)
    seconds = near = 0.0
    while near < figures.settling:
        seconds += STEP
        body.target = (min(length, speed * seconds), 0.0, 10.0)
        body.advance(STEP)
        there = body.distance_to((length, 0.0, 10.0)) <= figures.acceptance and seconds >= length / speed
        near = near + STEP if there else 0.0
    planned = Rates(speed, 3.0, 1.5, figures).from_stop_to_stop((0.0, 0.0, 10.0), (length, 0.0, 10.0))
    assert seconds == pytest.approx(planned, abs=0.6)
    assert seconds - length / speed == pytest.approx(settles, abs=0.6)


@pytest.mark.parametrize(
    ("figures", "length", "speed", "entering", "seconds"),
    [
        (ARDUROVER.pacing.mission, 7.21, 1.0, 2.0, 6.58),
        (ARDUROVER.pacing.mission, 11.66, 0.7, 1.8, 15.78),
        (ARDUROVER.pacing.mission, 6.08, 1.8, 1.8, 3.16),
        (PX4_MULTICOPTER.pacing.mission, 6.0, 3.0, None, 3.70),
        (replace(ARDUSUB.pacing.step, still=ARDUSUB.still), 2.0, 0.3, None, 5.60),
    ],
)
def test_the_earliest_end_of_a_leg_is_no_later_than_measured(figures, length, speed, entering, seconds):
    """Measured on ArduRover, which came from faster legs and passed corners, PX4 1.15, and ArduSub."""
    soonest, leg = Rates(speed, 3.0, 1.5, figures).soonest(), ((0.0, 0.0, 10.0), (length, 0.0, 10.0))
    least = soonest.from_stop_to_stop(*leg) if entering is None else soonest.eased(*leg, entering)
    assert 0.5 * seconds < least < seconds


@given(level, level, height, height, speeds, st.booleans())
@settings(max_examples=40, deadline=None)
def test_a_leg_takes_as_long_as_planning_and_checks_believe(north, east, start, end, speed, curved):
    a, b = (0.0, 0.0, start), (north, east, end)
    assume(dist(a, b) > 5.0 and abs(end - start) < dist(a, b) / 4.0)
    figures = PACING.mission if curved else PACING.step
    rates = Rates(speed, figures.climb, figures.descent, LegTiming(**asdict(figures) | {"settling": 0.0}))
    planned = rates.from_stop_to_stop(a, b)
    track = flown([a, b], speed, curved=curved)
    near = [
        n for n, place in enumerate(track) if dist(place, b) < 1.0 and dist(place, track[n - 1]) < 0.3 * STEP
    ]
    taken = STEP * (len(track) - 1 if curved else near[0])
    assert taken == pytest.approx(planned, rel=figures.spread, abs=1.0)
