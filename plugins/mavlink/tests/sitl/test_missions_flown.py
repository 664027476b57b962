"""How missions are flown: corners, holds, what is told, and what never starts."""

from __future__ import annotations

from itertools import pairwise
from math import hypot

import pytest
from simulated import Bench

from mmrs_mavlink.sitl.items import Item
from mmrs_mavlink.sitl.telemetry import mission_current

CORNER = (0.0, 60.0, 20.0)
LEGS = ((0.0, 10.0, 20.0), CORNER, (60.0, 60.0, 20.0), (60.0, 100.0, 20.0))
LOITER, LAND, RETURN, SPEED, PHOTO, TRIGGER, JUMP = 17, 21, 20, 178, 203, 206, 177
SET_CURRENT = 224


def plain(command: int, *params: float, x: int = 0, y: int = 0, z: float = 0.0) -> Item:
    return Item(2, command, (*params, *[0.0] * 4)[:4], x, y, z)


@pytest.fixture
def bench():
    return Bench()


def flown(bench: Bench, *items: Item, until: int) -> Bench:
    bench.load(*items)
    bench.fly_up(20.0)
    assert bench.mode("auto") == 0
    assert bench.wait_for(lambda: bench.pilot.item >= until)
    return bench


def test_a_corner_without_a_hold_is_cut_as_on_arducopter(bench):
    flown(bench, *bench.go_to(*LEGS), bench.item(LOITER, LEGS[-1]), until=4)
    assert 1.64 <= bench.closest_to(CORNER) <= 1.70


def test_a_corner_with_a_hold_is_reached(bench):
    first, _, *rest = bench.go_to(*LEGS)
    flown(bench, first, bench.item(16, CORNER, 1.0), *rest, bench.item(LOITER, LEGS[-1]), until=4)
    assert bench.closest_to(CORNER) <= 0.2


def test_a_smaller_radius_cuts_less(bench):
    bench.pilot.parameters["WPNAV_RADIUS"] = 50.0
    flown(bench, *bench.go_to(*LEGS), bench.item(LOITER, LEGS[-1]), until=4)
    assert 0.3 < bench.closest_to(CORNER) < 0.5


def test_the_slower_it_goes_the_less_it_cuts(bench):
    flown(bench, plain(SPEED, 1, 2.0), *bench.go_to(*LEGS), bench.item(LOITER, LEGS[-1]), until=5)
    assert bench.closest_to(CORNER) < 0.7


def test_nothing_is_lost_of_the_speed_where_the_way_goes_straight_on(bench):
    straight = [(0.0, 20.0 * n, 20.0) for n in range(1, 7)]
    flown(bench, *bench.go_to(*straight), bench.item(LOITER, straight[-1]), until=6)
    track = [point for point in bench.pilot.track if 20.0 < point[2] < 80.0]
    seconds, metres = track[-1][0] - track[0][0], track[-1][2] - track[0][2]
    assert metres / seconds == pytest.approx(5.0, rel=0.02)


def test_it_comes_back_on_its_leg_after_a_corner(bench):
    flown(bench, *bench.go_to(*LEGS), bench.item(LOITER, LEGS[-1]), until=4)
    aside = [abs(east - 60.0) for _, north, east, _ in bench.pilot.track if 8.0 < north < 50.0]
    assert max(aside) < 0.6


@pytest.mark.parametrize("hold", [3.0, 3.9])
def test_a_hold_lasts_its_whole_seconds(bench, hold):
    bench.load(*bench.go_to((0.0, 20.0, 20.0), hold=float(int(hold))), bench.item(LOITER, (0.0, 40.0, 20.0)))
    bench.fly_up(20.0)
    bench.mode("auto")
    assert bench.wait_for(lambda: bench.pilot.held > 0.0)
    began = bench.pilot.time
    assert bench.wait_for(lambda: bench.pilot.item == 2)
    assert bench.pilot.time - began == pytest.approx(3.0, abs=0.2)


def test_the_last_of_items_that_end_at_once_is_the_one_that_is_told(bench):
    bench.load(bench.item(22, (0.0, 0.0, 5.0)), plain(SPEED, 1, 4.0), bench.item(LOITER, (0.0, 30.0, 5.0)))
    bench.fly_up(5.0)
    bench.mode("auto")
    assert bench.wait_for(lambda: bench.pilot.item == 3)
    assert bench.pilot.pending == 2
    assert [item for _, item in bench.pilot.visited] == [1, 2]


def test_photos_are_taken_in_their_order_and_not_told_as_reached(bench):
    first = bench.go_to((0.0, 20.0, 20.0), hold=1.0)
    bench.load(*first, plain(PHOTO, x=1), bench.item(LOITER, (0.0, 40.0, 20.0)))
    bench.fly_up(20.0)
    bench.mode("auto")
    assert bench.wait_for(lambda: bench.pilot.item == 3)
    assert bench.pilot.pending == 1
    (photo,) = bench.pilot.camera.photos
    assert hypot(photo.place[0], photo.place[1] - 20.0) < 0.5


def test_a_trigger_by_distance_takes_a_photo_every_so_many_metres(bench):
    items = [plain(TRIGGER, 5.0, 0.0, 1.0), *bench.go_to((0.0, 51.0, 20.0), hold=1.0), plain(TRIGGER, 0.0)]
    flown(bench, *items, bench.item(LOITER, (0.0, 100.0, 20.0)), until=4)
    bench.wait(10.0)
    places = [photo.place[1] for photo in bench.pilot.camera.photos]
    assert len(places) == 10
    assert all(4.9 < b - a < 5.6 for a, b in pairwise(places))


def test_a_mission_without_a_take_off_is_kept_and_not_begun_on_the_ground(bench):
    bench.load(*bench.go_to((0.0, 20.0, 20.0)))
    bench.mode("guided")
    bench.command(400, 1)
    assert bench.command(300) != 0
    assert bench.pilot.said[-1][2] == "Auto: Missing Takeoff Cmd"
    assert not bench.wait_for(lambda: bench.pilot.airborne, 20.0)


def test_a_mission_with_a_take_off_is_flown_from_the_ground_to_its_landing(bench):
    bench.load(
        bench.item(22, (0.0, 0.0, 10.0)), *bench.go_to((0.0, 30.0, 10.0)), bench.item(LAND, (20.0, 30.0, 0.0))
    )
    bench.mode("guided")
    bench.command(400, 1)
    assert bench.command(300) == 0
    assert bench.wait_for(lambda: bench.pilot.airborne, 10.0)
    assert bench.wait_for(lambda: not bench.pilot.armed)
    assert bench.pilot.body.distance_to((20.0, 30.0, 0.0)) < 1.0
    assert bench.pilot.item == 0


def test_a_mission_that_ends_in_the_air_stays_there(bench):
    flown(bench, *bench.go_to((0.0, 20.0, 20.0)), until=1)
    assert bench.wait_for(lambda: bench.pilot.finished)
    bench.wait(20.0)
    assert bench.pilot.body.distance_to((0.0, 20.0, 20.0)) < 0.5
    assert [item for _, item in bench.pilot.visited] == [1]


def test_a_jump_repeats_what_it_is_told_to(bench):
    bench.load(*bench.go_to((0.0, 10.0, 20.0), hold=1.0), plain(JUMP, 1, 2), plain(RETURN))
    bench.fly_up(20.0)
    bench.mode("auto")
    assert bench.wait_for(lambda: bench.pilot.item == 3)
    assert [item for _, item in bench.pilot.visited] == [1, 2, 1, 2, 1, 2]


def test_a_mission_goes_on_where_it_was_left(bench):
    flown(bench, *bench.go_to(*LEGS, hold=1.0), until=2)
    bench.mode("loiter")
    bench.wait(5.0)
    bench.mode("auto")
    assert bench.pilot.item == 2


def test_the_next_item_can_be_chosen_and_one_that_is_not_there_cannot(bench):
    bench.load(*bench.go_to(*LEGS))
    assert bench.command(224, 3) == 0
    assert bench.pilot.item == 3
    assert bench.command(224, 9) == 2


def telling(bench: Bench) -> int:
    return int(mission_current(bench.pilot).seq)


def test_an_arducopter_that_does_not_fly_its_mission_goes_on_to_the_next_item_that_is_flown(bench):
    bench.load(plain(SPEED, 1, 2.0), *bench.go_to(*LEGS), plain(SPEED, 1, 3.0))
    bench.fly_up(20.0)
    assert bench.command(SET_CURRENT, 1) == 0
    assert telling(bench) == 2
    bench.mode("auto")
    bench.wait(1.0)
    assert bench.pilot.body.speed == 2.0, "what stands before the item that is flown is done, too"


def test_a_mission_does_not_go_on_where_nothing_is_flown_any_more(bench):
    bench.load(*bench.go_to(*LEGS), plain(SPEED, 1, 3.0))
    assert bench.command(SET_CURRENT, 5) == 4


def test_a_px4_tells_the_item_that_was_chosen_whatever_it_is():
    bench = Bench(firmware="px4")
    bench.pilot.stores[0] = [plain(SPEED, 1, 2.0), *bench.go_to(*LEGS)]
    assert bench.command(SET_CURRENT, 0) == 0
    assert telling(bench) == 0


@pytest.mark.parametrize(("restarts", "item"), [(0.0, 3), (1.0, 1)])
def test_a_mission_goes_on_where_it_was_told_or_begins_anew_as_its_owner_has_set_it(bench, restarts, item):
    bench.pilot.parameters["MIS_RESTART"] = restarts
    bench.load(*bench.go_to(*LEGS))
    bench.fly_up(20.0)
    assert bench.command(SET_CURRENT, 3) == 0
    bench.mode("auto")
    assert telling(bench) == item


def test_a_mission_that_is_over_begins_anew_when_auto_is_entered_again(bench):
    flown(bench, *bench.go_to(*LEGS[:2]), until=2)
    assert bench.wait_for(lambda: bench.pilot.finished)
    bench.mode("guided")
    bench.mode("auto")
    assert telling(bench) == 1
