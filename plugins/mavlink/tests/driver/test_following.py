"""Whether what a vehicle says of its mission is true: it must have been where it says that it has been."""

import pytest

from mmrs_mavlink import Local
from mmrs_mavlink.vehicles.following import Following
from mmrs_runtime.faults import FaultError

PLACES = {2: Local(50.0, 0.0, 20.0), 3: Local(100.0, 0.0, 20.0), 4: Local(100.0, 50.0, 20.0)}


class Vehicle:
    """Says at which item it is, and then where."""

    def __init__(self) -> None:
        self.begun = Local(0.0, 0.0, 20.0)
        self.item = 1
        self.sent = 0
        self.places: list[Local] = []

    def passed(self) -> list[Local]:
        places, self.places = self.places, []
        return places

    def place_order(self) -> int:
        return self.sent

    def item_order(self) -> int:
        return self.sent - 1


@pytest.fixture
def flight():
    """Return a function that moves a vehicle, says its item, and gives the item that is believed."""
    vehicle = Vehicle()
    following = Following(vehicle, PLACES, lambda: vehicle.item, 1)

    def move(north: float, east: float, item: int) -> int:
        vehicle.places, vehicle.item = [Local(north, east, 20.0)], item
        vehicle.sent += 2
        return following.look()

    return move


def test_items_that_were_passed_are_believed(flight):
    assert [flight(n, 0.0, 2) for n in (10.0, 30.0, 49.0)] == [2, 2, 2]
    assert flight(51.0, 0.0, 3) == 3
    assert flight(98.5, 1.0, 4) == 4
    assert flight(100.0, 49.0, 5) == 5


def test_an_item_is_believed_a_little_later_where_its_place_was_passed_between_two_positions(flight):
    assert flight(30.0, 0.0, 2) == 2
    assert flight(40.0, 0.0, 3) == 2
    assert flight(60.0, 0.0, 3) == 3


def test_an_item_that_is_nowhere_is_believed_at_once(flight):
    assert flight(0.0, 0.0, 2) == 2


def test_a_mission_that_was_set_ahead_is_a_fault_before_anything_is_believed(flight):
    assert flight(10.0, 0.0, 2) == 2
    assert flight(10.1, 0.1, 4) == 2
    with pytest.raises(FaultError, match="set ahead to item 4: the vehicle has not been near item 2"):
        flight(12.0, 1.0, 4)


def test_a_mission_that_was_set_back_is_a_fault(flight):
    assert flight(51.0, 0.0, 3) == 3
    for north in (52.0, 51.0, 50.0):
        flight(north, 0.0, 1)
    with pytest.raises(FaultError, match="set back from item 3 to 1"):
        flight(49.0, 0.0, 1)


def test_a_vehicle_that_starts_anew_has_time_to_tell_so_before_its_mission_counts_as_set_back(flight):
    assert flight(51.0, 0.0, 3) == 3
    assert [flight(north, 0.0, 0) for north in (52.0, 52.1, 52.2)] == [3, 3, 3]


def test_a_mission_that_was_set_back_for_a_moment_is_none(flight):
    assert flight(51.0, 0.0, 3) == 3
    for north in (52.0, 53.0, 54.0, 55.0):
        assert flight(north, 0.0, 1) == flight(north + 0.5, 0.0, 3) == 3


def test_an_item_that_is_not_known_for_a_moment_is_none(flight):
    assert flight(51.0, 0.0, 3) == 3
    assert flight(60.0, 0.0, -1) == 3


def test_a_corner_may_be_cut_as_vehicles_do(flight):
    flight(51.0, 0.0, 3)
    assert flight(98.0, 2.0, 3) == 3
    assert flight(99.0, 4.0, 4) == 4


def test_over_a_poor_link_a_place_may_lie_beside_the_way_between_two_positions(flight):
    flight(51.0, 0.0, 3)
    flight(85.0, 0.0, 3)
    flight(100.0, 15.0, 4)
    assert flight(100.0, 20.0, 4) == 4


def test_a_vehicle_that_stands_still_where_it_was_set_ahead_to_is_not_waited_for():
    vehicle = Vehicle()
    following = Following(vehicle, PLACES, lambda: vehicle.item, 1)
    vehicle.item, vehicle.sent = 4, 2
    assert following.look() == 2
    vehicle.sent += 2
    with pytest.raises(FaultError, match="has not been near item 2"):
        following.look()


def test_positions_that_were_sent_before_an_item_was_left_behind_do_not_count_against_it():
    vehicle = Vehicle()
    following = Following(vehicle, PLACES, lambda: vehicle.item, 1)
    vehicle.item_order = lambda: 10
    vehicle.item = 3
    for vehicle.sent, north in ((4, 20.0), (6, 30.0), (8, 40.0)):
        vehicle.places = [Local(north, 0.0, 20.0)]
        assert following.look() == 2
    vehicle.sent, vehicle.places = 12, [Local(60.0, 0.0, 20.0)]
    assert following.look() == 3


def test_places_that_were_passed_while_nobody_looked_are_believed():
    vehicle = Vehicle()
    following = Following(vehicle, PLACES, lambda: vehicle.item, 1)
    vehicle.places = [Local(50.0, 0.0, 20.0), Local(100.0, 0.0, 20.0), Local(100.0, 30.0, 20.0)]
    vehicle.item, vehicle.sent = 4, 2
    assert following.look() == 4


@pytest.fixture
def kept():
    """Return a function that moves a vehicle that is to stay within eight metres of its legs."""
    vehicle = Vehicle()
    following = Following(vehicle, PLACES, lambda: vehicle.item, 1, 8.0)
    vehicle.item = 2

    def move(north, east, up=20.0):
        vehicle.places = [Local(north, east, up)]
        vehicle.sent += 2
        following.look()

    return move


def test_a_vehicle_that_leaves_its_legs_is_a_fault_as_soon_as_it_is_sure(kept):
    kept(10.0, 7.0)
    kept(20.0, 9.0)
    with pytest.raises(FaultError, match="11 m off all legs of its run"):
        kept(20.0, 11.0)


def test_a_vehicle_that_climbs_away_is_a_fault(kept):
    kept(10.0, 0.0, 29.0)
    with pytest.raises(FaultError, match="10 m off"):
        kept(10.0, 0.0, 30.0)


def test_one_position_elsewhere_is_none(kept):
    for _ in range(5):
        kept(20.0, 30.0)
        kept(20.0, 0.0)


def test_a_leg_may_be_flown_before_the_vehicle_says_so(kept):
    for north, east in ((40.0, 0.0), (99.0, 0.0), (100.0, 30.0), (100.0, 49.0)):
        kept(north, east)
