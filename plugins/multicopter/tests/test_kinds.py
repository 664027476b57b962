from dataclasses import replace

import pytest
from mmrs_multicopter.kinds import (
    MULTICOPTER_KIND,
    SPIN_UP,
    TOUCH_DOWN,
    kinematics,
    land_path,
    land_seconds,
    take_off_path,
    take_off_seconds,
)
from mmrs_multicopter.names import LAND, TAKE_OFF

from mmrs_core.behaviour.program import Move
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Part
from mmrs_core.scene.timing import MoveSeconds

TAKE_OFF_30 = Move("t", (TAKE_OFF,), {"altitude": 30.0})
LANDING = Move("l", (LAND,))


def test_the_ceiling_is_the_largest_altitude_above_home(drone, scene):
    assert kinematics(drone(), scene).ceiling == 105.0


def test_the_floor_is_a_metre_above_home(drone, scene):
    assert kinematics(drone(), scene).floor == 6.0


@pytest.mark.parametrize(("mode", "speed"), [("SAFE", 8.0), ("NORMAL", 12.0), ("AGGRESSIVE", 16.0)])
def test_the_travel_mode_decides_the_cruise_speed(drone, scene, mode, speed):
    assert kinematics(drone(travel_mode=mode), scene).cruise == speed


@pytest.mark.parametrize(("mode", "speed"), [("SAFE", 8.0), ("NORMAL", 10.0), ("AGGRESSIVE", 10.0)])
def test_a_drone_cruises_no_faster_than_it_can_against_the_wind(drone, scene, mode, speed):
    windy = replace(scene, environment={"windSpeed": 6.0})
    found = kinematics(drone(travel_mode=mode), windy)
    assert (found.cruise, found.fastest, found.own_speed) == (speed, 10.0, 16.0)


def test_wind_that_leaves_less_than_the_smallest_speed_is_refused(drone, scene):
    windy = replace(scene, environment={"windSpeed": 13.0})
    with pytest.raises(InfeasibleError, match="4 to 16 m/s, too slow against 13 m/s"):
        kinematics(drone(), windy)


def test_the_reserve_is_taken_off_lifetime_and_energy(drone, scene):
    found = kinematics(drone(), scene)
    assert (found.endurance, found.energy, found.power) == (750.0, 375_000.0, 500.0)


def test_a_drone_launches_and_recharges(drone, scene):
    found = kinematics(drone(), scene)
    assert (found.launches, found.recharge) == (True, 90.0)


def test_a_payload_beyond_every_measured_one_is_refused(drone, scene):
    robot = drone(payload=1.0)
    heavy = replace(robot, payload=2.0)
    assert kinematics(robot, scene).endurance == 750.0
    with pytest.raises(InfeasibleError, match="at most 1 kg"):
        kinematics(heavy, scene)


def test_a_type_without_a_largest_altitude_is_refused(drone, scene):
    robot = drone()
    nameless = replace(robot, type=replace(robot.type, part=Part((), {})))
    with pytest.raises(InfeasibleError, match="'Quad' does not say its maxAltitude"):
        kinematics(nameless, scene)


def test_launching_is_one_take_off_to_the_height_asked_for():
    (spec,) = MULTICOPTER_KIND.launch(25.0)
    assert (spec.metaclass, spec.attributes) == (TAKE_OFF, {"altitude": 25.0})


def test_recovering_is_one_landing():
    (spec,) = MULTICOPTER_KIND.recover()
    assert spec.metaclass == LAND


def test_take_off_climbs_straight_from_where_the_drone_stands():
    assert take_off_path(TAKE_OFF_30, (1.0, 2.0, 5.0), None) == ((1.0, 2.0, 5.0), (1.0, 2.0, 35.0))


def test_landing_at_home_ends_at_the_height_of_home():
    assert land_path(LANDING, (10.0, 20.5, 40.0), (10.0, 20.0, 5.0))[-1] == (10.0, 20.5, 5.0)


def test_landing_elsewhere_ends_at_the_height_of_the_origin():
    assert land_path(LANDING, (90.0, 20.0, 40.0), (10.0, 20.0, 5.0))[-1] == (90.0, 20.0, 0.0)


def test_taking_off_lasts_as_long_as_spinning_up_and_climbing(drone, scene):
    found = kinematics(drone(), scene)
    way = take_off_path(TAKE_OFF_30, (0.0, 0.0, 0.0), None)
    assert take_off_seconds(TAKE_OFF_30, way, found, "NORMAL") == MoveSeconds.exactly(SPIN_UP + 10.0)


def test_landing_lasts_as_long_as_descending_and_stopping_the_motors(drone, scene):
    found = kinematics(drone(), scene)
    way = land_path(LANDING, (0.0, 0.0, 30.0), None)
    assert land_seconds(LANDING, way, found, "NORMAL") == MoveSeconds.exactly(TOUCH_DOWN + 15.0)
