import pytest
from mmrs_auv.kinds import ATMOSPHERE, AUV_KIND, GRAVITY, kinematics, largest_depth
from mmrs_auv.names import AUV_MOVEMENT

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.errors import InfeasibleError
from mmrs_core.transformation.kinds import PLAIN_ROBOT


def pressure_at(depth, density):
    return ATMOSPHERE + depth * density * GRAVITY


def test_the_weakest_thruster_decides_how_deep_the_vehicle_goes(vehicle, lake):
    assert kinematics(vehicle(depths=(80.0, 50.0, 60.0)), lake()).floor == -53.0


def test_the_hull_decides_where_it_is_weaker_than_the_thrusters(vehicle, lake):
    hull = pressure_at(20.0, 1000.0)
    assert kinematics(vehicle((50.0,), hull), lake()).floor == pytest.approx(-23.0)


def test_the_same_pressure_comes_sooner_in_denser_water(vehicle):
    hull = pressure_at(20.0, 1000.0)
    assert largest_depth(vehicle((), hull).type, 0.0, 1250.0) == pytest.approx(16.0)


def test_water_of_unknown_density_counts_as_sea_water(vehicle, lake):
    hull = pressure_at(20.0, 1025.0)
    assert kinematics(vehicle((), hull), lake(density=None)).floor == pytest.approx(-23.0)


def test_the_surface_is_the_ceiling(vehicle, lake):
    assert kinematics(vehicle((50.0,)), lake(surface=4.0)).ceiling == 4.0


def test_a_vehicle_does_not_launch(vehicle, lake):
    assert kinematics(vehicle((50.0,)), lake()).launches is False
    assert AUV_KIND.launch(5.0) == AUV_KIND.recover() == ()


def test_a_hull_that_bears_less_than_the_atmosphere_keeps_to_the_surface(vehicle, lake):
    assert kinematics(vehicle((50.0,), 90_000.0), lake()).floor == -3.0


def test_a_type_that_says_nothing_of_depth_is_refused(vehicle, lake):
    with pytest.raises(InfeasibleError, match="'Diver' defines no maximum depth"):
        kinematics(vehicle(), lake())


def test_underwater_movement_makes_an_underwater_vehicle_of_a_plain_robot(vehicle):
    kinds = {PLAIN_ROBOT.metaclass: PLAIN_ROBOT, AUV_MOVEMENT: AUV_KIND}
    assert robot_kind_of(vehicle((50.0,)).type, kinds) is AUV_KIND


def test_travel_is_one_go_to_for_each_leg():
    specs = AUV_KIND.travel(((0.0, 0.0, -1.0), (5.0, 0.0, -1.0), (5.0, 0.0, -4.0)))
    assert [(spec.metaclass, spec.target) for spec in specs] == [
        ((BEHAVIOUR, "GoTo"), (5.0, 0.0, -1.0)),
        ((BEHAVIOUR, "GoTo"), (5.0, 0.0, -4.0)),
    ]
