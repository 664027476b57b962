"""Movement primitives on the whole vehicle, in current and noise."""

from collections.abc import Callable
from dataclasses import replace
from math import hypot
from random import Random

import pytest
from sample_vessels import heavy_sheet, pool_sheet, torpedo_sheet
from vessel_rig import Rig, changed

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.hosting import WireFault
from auv_vessel.movement import guidance
from auv_vessel.movement.guidance import DEPTH, HEADING, PLACE, SETTLED, SPEED
from auv_vessel.sheet import Sheet

pytestmark = pytest.mark.long

SHEETS = {"six thrusters": pool_sheet, "no sway": torpedo_sheet, "eight thrusters": heavy_sheet}


def begun(
    sheet: Sheet, current: tuple[float, float] = (0.0, 0.0), seed: int = 1, other: Sheet | None = None
) -> Rig:
    """Return a vehicle two metres deep that is to stay there."""
    rig = Rig(
        replace(sheet, home=(0.0, 0.0, 2.0)), Surroundings(current=current, bottom=20.0), seed, other=other
    )
    rig.run(0.5)
    return rig


def away(rig: Rig, north: float, east: float) -> float:
    truth = rig.vehicle.truth
    return hypot(truth.north - north, truth.east - east)


SEEDS = [1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(2, 8))]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("make", SHEETS.values(), ids=SHEETS)
def test_it_goes_to_a_place_in_a_current(make: object, seed: int) -> None:
    random = Random(seed)
    rig = begun(make(), (random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15)), seed)
    north, east, heading = random.uniform(3.0, 6.0), random.uniform(-6.0, -3.0), random.uniform(0.0, 360.0)
    rig.craft.go_to(north, east, 3.0, heading=None if make is torpedo_sheet else heading)
    rig.reach(150.0)
    state = rig.state
    assert hypot(state.north - north, state.east - east) <= PLACE
    assert away(rig, north, east) <= PLACE + 3.0 * state.uncertainty
    assert abs(rig.vehicle.truth.depth - 3.0) <= DEPTH + 0.02
    if make is not torpedo_sheet:
        assert abs((rig.vehicle.truth.heading - heading + 180.0) % 360.0 - 180.0) <= HEADING + 3.0


def test_it_holds_its_place_and_depth_in_a_current_of_a_third_of_a_metre_a_second() -> None:
    rig = begun(pool_sheet(), (-0.24, 0.18))
    rig.craft.hold(0.0, 0.0, 2.0, 0.0)
    rig.reach()
    rig.run(10.0)
    for _ in range(20):
        rig.run(0.5)
        assert away(rig, 0.0, 0.0) <= 0.3 + 2.0 * rig.state.uncertainty
        assert abs(rig.vehicle.truth.depth - 2.0) <= 0.1


def test_it_holds_without_thrust_to_the_side_by_heading_into_the_current() -> None:
    rig = begun(torpedo_sheet(), (-0.2, 0.0))
    rig.craft.hold(0.0, 0.0, 2.0, 0.0)
    rig.reach()
    rig.run(15.0)
    assert away(rig, 0.0, 0.0) < 0.5 + 2.0 * rig.state.uncertainty


@pytest.mark.thorough
def test_a_step_of_depth_overshoots_less_than_its_tolerance() -> None:
    rig = begun(pool_sheet())
    rig.craft.hold(0.0, 0.0, 4.0, 0.0)
    deepest = 0.0
    for _ in range(200):
        rig.run(0.1)
        deepest = max(deepest, rig.vehicle.truth.depth)
    assert 4.0 - 0.1 < rig.vehicle.truth.depth < 4.0 + 0.1
    assert deepest < 4.0 + 0.1


@pytest.mark.parametrize("make", SHEETS.values(), ids=SHEETS)
def test_a_turn_ends_where_it_should_and_does_not_swing(make: object) -> None:
    rig = begun(make())
    rig.craft.turn(150.0)
    most, begin = 0.0, rig.vehicle.truth.heading
    while rig.state.progress != "REACHED":
        rig.run(0.1)
        assert rig.bus.now < 60.0, rig.where()
        most = max(most, rig.vehicle.truth.heading if rig.vehicle.truth.heading < 300.0 else 0.0)
    rig.run(3.0)
    assert begin < 5.0 or begin > 355.0
    assert abs(rig.vehicle.truth.heading - 150.0) < HEADING + 3.0
    assert most < 150.0 + 12.0


def test_it_surfaces_by_thrust_and_takes_a_fix() -> None:
    rig = begun(heavy_sheet())
    rig.craft.surface()
    rig.reach()
    assert rig.afloat
    rig.run(5.0)
    assert rig.afloat
    assert not rig.vehicle.released


def test_a_search_leads_around_its_place_and_outwards() -> None:
    rig = begun(pool_sheet(**{"search.radius": 2.0, "search.spacing": 1.0}))
    rig.craft.search(0.0, 0.0, 2.0)
    quarters, farthest = set(), 0.0
    while rig.state.progress != "REACHED":
        rig.run(0.5)
        truth = rig.vehicle.truth
        farthest = max(farthest, hypot(truth.north, truth.east))
        quarters.add((truth.north > 0.0, truth.east > 0.0))
        assert rig.bus.now < 120.0, rig.where()
    assert len(quarters) == 4
    assert 1.3 < farthest < 2.6


def test_a_search_with_a_heading_is_a_turn_about_on_the_spot() -> None:
    rig = begun(pool_sheet())
    rig.craft.search(0.0, 0.0, 2.0, heading=0.0)
    seen = set()
    while rig.state.progress != "REACHED":
        rig.run(0.5)
        seen.add(int(rig.vehicle.truth.heading // 45.0))
        assert rig.bus.now < 60.0, rig.where()
        assert away(rig, 0.0, 0.0) < 0.5
    assert seen == set(range(8))


@pytest.mark.parametrize("part", [pytest.param(0.7, marks=pytest.mark.thorough), 1.4])
def test_a_body_that_is_not_what_its_sheet_says_gets_there_too(part: float) -> None:
    sheet = pool_sheet()
    extra = {f"quadratic_drag.{axis}": 80.0 * part for axis in ("surge", "sway", "heave")}
    extra |= {f"added_mass.{axis}": 10.0 * part for axis in ("surge", "sway", "heave")}
    body = changed(replace(sheet, mass=19.0 * (0.9 + 0.15 * part), home=(0.0, 0.0, 2.0)), **extra)
    rig = begun(sheet, (0.1, 0.1), other=body)
    rig.craft.go_to(4.0, 2.0, 3.0, heading=45.0)
    rig.reach()
    assert away(rig, 4.0, 2.0) < 0.3 + 3.0 * rig.state.uncertainty
    assert abs(rig.vehicle.truth.depth - 3.0) < 0.12


@pytest.mark.thorough
def test_a_goal_that_a_current_keeps_it_from_is_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guidance, "ALLOWANCE", 4.0)
    rig = begun(pool_sheet(), (1.5, 0.0))
    rig.craft.go_to(-2.0, 0.0, 2.0)
    took = rig.until(lambda: rig.state.progress == "FAILED", 120.0, 1.0)
    assert 4.0 < took < 40.0
    assert rig.vehicle.truth.north > 5.0


def test_it_says_reached_only_when_it_has_been_there_and_still_for_a_while() -> None:
    rig = begun(pool_sheet(), (0.1, 0.0))
    rig.craft.go_to(2.0, 0.0, 2.5, heading=90.0)
    since: float | None = None
    while rig.state.progress != "REACHED":
        rig.run(0.05)
        assert rig.bus.now < 60.0
        motion = rig.movement.motion
        there = hypot(motion.north - 2.0, motion.east) <= PLACE and abs(motion.depth - 2.5) <= DEPTH
        still = hypot(motion.surge, motion.sway) <= SPEED + 0.05 and abs(motion.heading - 90.0) <= HEADING
        since = (since or rig.bus.now) if there and still else None
    assert since is not None
    assert rig.bus.now - since >= SETTLED - 0.1


def test_it_goes_no_deeper_than_it_may() -> None:
    rig = begun(replace(pool_sheet(), max_depth=2.5))
    rig.craft.hold(0.0, 0.0, 8.0, 0.0)
    rig.run(10.0)
    assert rig.vehicle.truth.depth < 2.6
    assert rig.emergencies == []
    assert rig.state.progress == "ACTIVE"
    assert rig.state.distance == pytest.approx(5.5, abs=0.2)


def test_goals_whose_halves_do_not_belong_together_are_not_pursued() -> None:
    rig = begun(pool_sheet())
    rig.craft.go_to(6.0, 0.0, 2.0)
    rig.run(1.0)
    rig.bus.disturb(WireFault(loss=1.0, ids=frozenset({0x400})))
    rig.craft.go_to(-20.0, 0.0, 2.0)
    rig.run(8.0)
    assert rig.vehicle.truth.north < 1.5
    assert rig.movement.goal is not None
    assert rig.movement.goal.north == pytest.approx(6.0)


def test_it_keeps_to_the_line_to_its_goal() -> None:
    rig = begun(pool_sheet(), (0.0, 0.2))
    rig.craft.go_to(8.0, 0.0, 2.0)
    aside = []
    while rig.state.progress != "REACHED":
        rig.run(0.25)
        assert rig.bus.now < 60.0, rig.where()
        aside.append(abs(rig.state.east))
    assert max(aside) < 0.6
    assert max(aside[len(aside) // 2 :]) < 0.35


def deepest(rig: Rig, seconds: float) -> float:
    """Return how deep the vehicle truly gets in a time, metres."""
    found = 0.0
    for _ in range(round(seconds / 0.1)):
        rig.run(0.1)
        found = max(found, rig.vehicle.truth.depth)
    return found


@pytest.mark.parametrize(
    ("make", "extra"),
    [
        *(
            pytest.param(make, {}, id=name, marks=() if make is heavy_sheet else pytest.mark.thorough)
            for name, make in SHEETS.items()
        ),
        *(
            pytest.param(
                make,
                {"bottom.clearance": 1.0},
                id=f"{name}, as the sheet says",
                marks=() if make is pool_sheet else pytest.mark.thorough,
            )
            for name, make in SHEETS.items()
        ),
    ],
)
def test_it_keeps_clear_of_the_bottom_whatever_the_goal(
    make: Callable[[], Sheet], extra: dict[str, float]
) -> None:
    sheet = changed(replace(make(), home=(0.0, 0.0, 2.0)), **extra)
    rig = Rig(sheet, Surroundings(current=(0.1, 0.0), bottom=3.5))
    rig.run(0.5)
    rig.craft.go_to(3.0, 0.0, 4.5, heading=None)
    least = extra.get("bottom.clearance", sheet.height / 2.0 + 0.2)
    assert deepest(rig, 40.0) <= 3.5 - least + 0.1
    assert rig.vehicle.truth.depth == pytest.approx(3.5 - least, abs=DEPTH)
    assert rig.state.progress == "ACTIVE"


def test_it_goes_as_deep_as_it_is_told_where_no_log_tells_how_high_it_is() -> None:
    rig = Rig(replace(pool_sheet(), home=(0.0, 0.0, 2.0)), Surroundings(bottom=3.5))
    rig.vehicle.faults.silent.add("Altitude")
    rig.run(0.5)
    rig.craft.go_to(0.0, 0.0, 3.2, heading=None)
    rig.reach()
    assert rig.vehicle.truth.depth == pytest.approx(3.2, abs=DEPTH + 0.05)
