"""Gusts: their statistics, their seed, and how far they displace a copter."""

from __future__ import annotations

from itertools import pairwise
from math import exp, hypot
from statistics import fmean, pstdev

import pytest
from simulated import Bench

from mmrs_mavlink.sitl.commands import steer
from mmrs_mavlink.sitl.gusts import Gusts
from mmrs_mavlink.sitl.settings import Settings

LEG = 300.0


def hovering(seconds: float, **settings) -> list[float]:
    """Return the displacement of a hovering copter over time."""
    bench = Bench(**settings)
    bench.fly_up(10.0)
    bench.mode("brake")
    bench.wait(5.0)
    before = len(bench.pilot.track)
    bench.wait(seconds)
    return [hypot(north, east) for _, north, east, _ in bench.pilot.track[before:]]


def along_a_leg(**settings) -> Bench:
    """Return a copter that has flown a leg to the east."""
    bench = Bench(**settings)
    bench.fly_up(10.0)
    bench.command(178, 1, 5.0)
    steer(bench.pilot, (0.0, LEG, 10.0), None)
    assert bench.wait_for(lambda: bench.pilot.body.distance_to((0.0, LEG, 10.0)) < 1.0, 120.0)
    return bench


def blown(strength: float, lasting: float, seconds: float) -> list[float]:
    gusts, found = Gusts(strength, lasting, "test"), []
    for _ in range(round(seconds)):
        gusts.advance(1.0)
        found.append(gusts.air[0])
    return found


def test_gusts_have_the_requested_deviation_and_correlation_time():
    air = blown(2.0, 5.0, 8_000.0)
    assert fmean(air) == pytest.approx(0.0, abs=0.15)
    assert pstdev(air) == pytest.approx(2.0, rel=0.06)
    alike = fmean(a * b for a, b in pairwise(air)) / fmean(a * a for a in air)
    assert alike == pytest.approx(exp(-1.0 / 5.0), abs=0.03)


def test_gusts_depend_on_their_seed_and_not_on_how_time_is_divided():
    one, other = Gusts(2.0, 5.0, "7"), Gusts(2.0, 5.0, "7")
    for _ in range(100):
        one.advance(0.1)
    for _ in range(250):
        other.advance(0.04)
    assert one.air == other.air != (0.0, 0.0)
    assert one.push == other.push


def test_another_seed_or_vehicle_has_other_gusts():
    tracks = [
        along_a_leg(gusts=(2.0, 5.0), seed=seed, system=system).pilot.track
        for seed, system in ((1, 1), (1, 1), (2, 1), (1, 2))
    ]
    assert tracks[0] == tracks[1]
    assert tracks[0] != tracks[2]
    assert tracks[0] != tracks[3]


@pytest.mark.parametrize(("strength", "most"), [(1.0, 0.25), (2.0, 0.5), (4.0, 1.0)])
def test_gusts_displace_a_copter_as_far_as_the_documentation_says(strength, most):
    away = hovering(200.0, gusts=(strength, 5.0))
    assert most / 4.0 < max(away) <= most
    aside = max(abs(point[1]) for point in along_a_leg(gusts=(strength, 5.0)).pilot.track)
    assert most / 4.0 < aside <= most


def test_the_reported_speed_includes_gusts():
    bench = Bench(gusts=(4.0, 5.0))
    bench.fly_up(10.0)
    bench.mode("brake")
    bench.wait(20.0)
    assert bench.pilot.body.pace > 0.01
    assert bench.pilot.body.motion != bench.pilot.body.velocity


def test_without_gusts_a_copter_keeps_its_position():
    assert max(hovering(60.0)) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("kind", ["rover", "sub"])
def test_gusts_displace_neither_rovers_nor_submarines(kind):
    bench = Bench(kind=kind, gusts=(5.0, 5.0))
    bench.wait(60.0)
    assert hypot(*bench.pilot.body.position) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("gusts", [(-1.0, 5.0), (2.0, 0.0)])
def test_invalid_gusts_are_refused(gusts):
    with pytest.raises(ValueError, match="not a speed of 0 to 20 m/s"):
        Settings(gusts=gusts)
