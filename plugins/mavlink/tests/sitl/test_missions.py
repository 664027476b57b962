"""Missions: corners, holds, photos, jumps, what is reported, and what never starts."""

from math import hypot

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from simulated import Bench

from mmrs_mavlink.sitl.items import StoredItem
from mmrs_mavlink.sitl.telemetry import mission_current
from mmrs_mavlink.sitl.telemetry import photo as photo_report

CORNER = (0.0, 60.0, 20.0)
LEGS = ((0.0, 10.0, 20.0), CORNER, (60.0, 60.0, 20.0), (60.0, 100.0, 20.0))
LOITER, LAND, SPEED, PHOTO, TRIGGER = 17, 21, 178, 203, 206
SET_CURRENT = 224


def plain(command: int, *params: float, x: int = 0) -> StoredItem:
    return StoredItem(2, command, (*params, *[0.0] * 4)[:4], x, 0, 0.0)


@pytest.fixture
def bench():
    return Bench()


def flown(bench: Bench, *items: StoredItem, until: int, height: float = 20.0) -> Bench:
    """Fly a mission from the air to the item with that number."""
    bench.load(*items)
    bench.fly_up(height)
    assert bench.mode("auto") == 0
    assert bench.wait_for(lambda: bench.pilot.item >= until)
    return bench


def visited(bench: Bench) -> list[int]:
    return [item for _, item in bench.pilot.visited]


def test_a_corner_without_a_hold_is_cut_as_by_arducopter_and_the_leg_rejoined(bench):
    flown(bench, *bench.go_to(*LEGS), bench.item(LOITER, LEGS[-1]), until=4)
    assert 1.6 <= bench.closest_to(CORNER) <= 2.0
    aside = [abs(east - 60.0) for _, north, east, _ in bench.pilot.track if 8.0 < north < 50.0]
    assert max(aside) < 0.6


def test_a_corner_with_a_hold_is_reached(bench):
    first, _, *rest = bench.go_to(*LEGS)
    flown(bench, first, bench.item(16, CORNER, 1.0), *rest, bench.item(LOITER, LEGS[-1]), until=4)
    assert bench.closest_to(CORNER) <= 0.2


def test_a_lower_speed_cuts_less(bench):
    flown(bench, plain(SPEED, 1, 2.0), *bench.go_to(*LEGS), bench.item(LOITER, LEGS[-1]), until=5)
    # Half of the turn is over as both legs are √2 · v √(v / j) / 6 from the corner.
    assert bench.closest_to(CORNER) == pytest.approx(0.7, abs=0.05)


@pytest.mark.parametrize("speed", [2.0, 6.0])
def test_a_leg_that_begins_without_a_stop_is_flown_at_its_own_speed(bench, speed):
    first, second, third = bench.go_to((0.0, 40.0, 20.0), (0.0, 80.0, 20.0), (0.0, 120.0, 20.0))
    items = (plain(SPEED, 1, 4.0), first, plain(SPEED, 1, speed), second, third)
    flown(bench, *items, bench.item(LOITER, (0.0, 120.0, 20.0)), until=5)
    times = {item: time for time, item in bench.pilot.visited}
    assert times[4] - times[2] == pytest.approx(40.0 / speed, rel=0.1)


def test_speed_is_kept_between_straight_legs(bench):
    straight = [(0.0, 20.0 * n, 20.0) for n in range(1, 7)]
    flown(bench, *bench.go_to(*straight), bench.item(LOITER, straight[-1]), until=6)
    track = [point for point in bench.pilot.track if 20.0 < point[2] < 80.0]
    seconds, metres = track[-1][0] - track[0][0], track[-1][2] - track[0][2]
    # A leg of 20 m reaches a speed v of v (2 √(v / 1 m/s³) + 0.3 s) = 20 m, as the jerk comes and goes.
    assert metres / seconds == pytest.approx(4.51, abs=0.1)


def test_a_hold_lasts_its_seconds(bench):
    items = (*bench.go_to((0.0, 20.0, 20.0), hold=3.0), bench.item(LOITER, (0.0, 40.0, 20.0)))
    flown(bench, *items, until=1)
    assert bench.wait_for(lambda: bench.pilot.held > 0.0)
    began = bench.pilot.time
    assert bench.wait_for(lambda: bench.pilot.item == 2)
    assert bench.pilot.time - began == pytest.approx(3.0, abs=0.2)


def test_a_leg_that_ends_with_a_hold_takes_as_long_as_is_planned(bench):
    """Measured on ArduCopter 4.7-dev: 11.8 s, the hold of a second included."""
    flown(bench, plain(SPEED, 1, 6.0), *bench.go_to((0.0, 30.0, 20.0), hold=1.0), until=1)
    assert bench.wait_for(lambda: bench.pilot.finished)
    times = {item: time for time, item in bench.pilot.visited}
    assert times[2] - times[1] == pytest.approx(11.8, rel=0.05)


def test_items_that_end_at_once_are_passed_in_order(bench):
    items = (bench.item(22, (0.0, 0.0, 5.0)), plain(SPEED, 1, 4.0), bench.item(LOITER, (0.0, 30.0, 5.0)))
    flown(bench, *items, until=3, height=5.0)
    assert visited(bench) == [1, 2]


def test_a_photo_is_taken_in_sequence(bench):
    first = bench.go_to((0.0, 20.0, 20.0), hold=1.0)
    flown(bench, *first, plain(PHOTO, x=1), bench.item(LOITER, (0.0, 40.0, 20.0)), until=3)
    (photo,) = bench.pilot.photos
    assert hypot(photo[0], photo[1] - 20.0) < 0.5
    report = photo_report(bench.pilot, 1)
    above = report.relative_alt * 1e-3 if bench.pilot.px4 else report.alt_rel
    assert above == pytest.approx(20.0, abs=0.5)


def test_photos_by_distance_are_taken_in_passing_and_once_more_at_their_end(bench):
    begin, end = plain(TRIGGER, 10.0, 0.0, 1.0), plain(TRIGGER, 0.0, 0.0, 1.0)
    first, last = bench.go_to((0.0, 20.0, 20.0), hold=1.0), bench.go_to((0.0, 55.0, 20.0), hold=1.0)
    flown(bench, *first, begin, *last, end, bench.item(LOITER, (0.0, 90.0, 20.0)), until=5)
    bench.wait_for(lambda: bench.pilot.body.position[1] > 85.0)
    assert [photo[1] for photo in bench.pilot.photos] == pytest.approx(
        [20.0, 30.0, 40.0, 50.0, 55.0], abs=1.0
    )


def test_a_mission_without_a_take_off_is_accepted_and_never_leaves_the_ground(bench):
    bench.load(*bench.go_to(*LEGS))
    bench.mode("guided")
    bench.command(400, 1)
    assert bench.command(300) == 0
    assert not bench.wait_for(lambda: bench.pilot.airborne, 20.0)


def test_a_mission_with_a_take_off_is_flown_from_the_ground_to_its_landing(bench):
    leg = bench.go_to((0.0, 30.0, 10.0))
    bench.load(bench.item(22, (0.0, 0.0, 10.0)), *leg, bench.item(LAND, (20.0, 30.0, 0.0)))
    bench.mode("guided")
    bench.command(400, 1)
    assert bench.command(300) == 0
    assert bench.wait_for(lambda: bench.pilot.airborne, 10.0)
    assert bench.wait_for(lambda: not bench.pilot.armed)
    assert bench.pilot.body.distance_to((20.0, 30.0, 0.0)) < 1.0
    assert bench.pilot.item == 0


def test_a_mission_that_ends_in_the_air_holds_there(bench):
    flown(bench, *bench.go_to((0.0, 20.0, 20.0)), until=1)
    assert mission_current(bench.pilot).mission_state == mavlink.MISSION_STATE_ACTIVE
    assert bench.wait_for(lambda: bench.pilot.finished)
    assert mission_current(bench.pilot).mission_state == mavlink.MISSION_STATE_COMPLETE
    bench.wait(20.0)
    assert bench.pilot.body.distance_to((0.0, 20.0, 20.0)) < 0.5
    assert visited(bench) == [1]


def test_a_mission_resumes_at_its_item(bench):
    flown(bench, *bench.go_to(*LEGS, hold=1.0), until=2)
    bench.mode("loiter")
    bench.wait(5.0)
    bench.mode("auto")
    assert bench.pilot.item == 2


def reported(bench: Bench) -> int:
    return int(mission_current(bench.pilot).seq)


def test_the_current_item_can_be_set_if_it_exists_and_something_is_flown_after_it(bench):
    bench.load(*bench.go_to(*LEGS), plain(SPEED, 1, 3.0))
    assert bench.command(SET_CURRENT, 3) == 0
    assert bench.pilot.item == 3
    assert bench.command(SET_CURRENT, 9) == 2
    assert bench.command(SET_CURRENT, 5) == 4


def test_arducopter_reports_the_next_item_that_is_flown_and_executes_those_before(bench):
    bench.load(plain(SPEED, 1, 2.0), *bench.go_to(*LEGS), plain(SPEED, 1, 3.0))
    bench.fly_up(20.0)
    assert bench.command(SET_CURRENT, 1) == 0
    assert reported(bench) == 2
    bench.mode("auto")
    bench.wait(1.0)
    assert bench.pilot.body.speed == 2.0


def test_px4_reports_the_item_that_was_set():
    bench = Bench(firmware="px4")
    bench.pilot.stores[0] = [plain(SPEED, 1, 2.0), *bench.go_to(*LEGS)]
    assert bench.command(SET_CURRENT, 0) == 0
    assert reported(bench) == 0


@pytest.mark.parametrize(("restarts", "item"), [(0.0, 3), (1.0, 1)])
def test_a_mission_resumes_or_restarts_as_configured(bench, restarts, item):
    bench.pilot.parameters["MIS_RESTART"] = restarts
    bench.load(*bench.go_to(*LEGS))
    bench.fly_up(20.0)
    assert bench.command(SET_CURRENT, 3) == 0
    bench.mode("auto")
    assert reported(bench) == item


def test_a_finished_mission_restarts(bench):
    flown(bench, *bench.go_to(*LEGS[:2]), until=2)
    assert bench.wait_for(lambda: bench.pilot.finished)
    bench.mode("guided")
    bench.mode("auto")
    assert reported(bench) == 1
