"""Travel modes on simulated vehicles: what is set up before take-off, and what is left to the owner."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off
from ports import free_port

from mmrs_core.testing.programs import program
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import open_port
from mmrs_mavlink.profiles import profile_for
from mmrs_mavlink.program import Travel
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_mavlink.vehicles.owner_settings import set_up
from mmrs_runtime.clock import Clock

pytestmark = pytest.mark.real_time("controllers")

SAFE = Travel("SAFE", radius=1.0, margin=4.0)
AGGRESSIVE = Travel("AGGRESSIVE", radius=2.0, margin=0.0)


@pytest.fixture
def told():
    """Return a function that sets a vehicle up, and gives its parameters then, and what was said."""

    def after(travel, kind="copter", speed=0.0, **settings):
        port = free_port()
        vehicle = SimulatedVehicle(port, Settings(kind, 42.37, 13.35, **settings), speedup=10.0)
        vehicle.start()
        link = Link(open_port(f"udpin:127.0.0.1:{port}"), Clock(10.0))
        try:
            assert link.wait(lambda: link.component, 30.0)
            link.expect(profile_for(kind))
            return vehicle.autopilot.parameters, list(set_up(link, travel, speed=speed))
        finally:
            link.close()
            vehicle.stop()

    return after


def test_a_safe_robot_passes_places_more_closely_and_keeps_further_from_obstacles(told):
    found, said = told(SAFE, parameters={"WPNAV_RADIUS": 200.0, "AVOID_MARGIN": 2.0})
    assert (found["WPNAV_RADIUS"], found["AVOID_MARGIN"]) == (100.0, 4.0)
    assert "WPNAV_RADIUS = 100, which was 200: it travels SAFE" in said


def test_an_owner_who_is_more_careful_is_left_so(told):
    found, said = told(SAFE, parameters={"WPNAV_RADIUS": 50.0, "AVOID_MARGIN": 6.0, "OA_MARGIN_MAX": 5.0})
    assert (found["WPNAV_RADIUS"], found["AVOID_MARGIN"]) == (50.0, 6.0)
    assert said == []


@pytest.mark.parametrize(("kind", "obeys"), [("copter", True), ("sub", False)])
def test_a_vehicle_climbs_descends_and_turns_no_faster_than_its_type(told, kind, obeys):
    found, said = told(Travel(climb=0.4, descent=2.0, turn_rate=20.0), kind)
    assert (found["WPNAV_SPEED_UP"], found["WPNAV_SPEED_DN"]) == (40.0, 150.0)
    turns = "ATC_SLEW_YAW = 2000, which was 6000: it turns at 20°/s, as its type states"
    assert said == [
        "WPNAV_SPEED_UP = 40, which was 250: it climbs at 0.4 m/s, as its type states",
        *([turns] if obeys else []),
    ]


@pytest.mark.parametrize(("was", "found"), [(0.0, 115.0), (60.0, 60.0)])
def test_a_rover_turns_on_the_spot_to_what_is_behind_it_unless_its_owner_has_set_from_which_angle(
    told, was, found
):
    parameters, said = told(Travel(), "rover", parameters={"WP_PIVOT_ANGLE": was})
    assert parameters["WP_PIVOT_ANGLE"] == found
    changed = "WP_PIVOT_ANGLE = 115, which was 0: it turns on the spot where it turns by over 115°"
    assert said == ([] if was else [changed])


@pytest.mark.parametrize(
    ("limit", "speed", "warns"), [(3.0, 5.0, True), (5.0, 5.0, False), (12.0, 15.0, False)]
)
def test_an_owner_who_limits_the_level_speed_is_left_so_and_operators_are_warned(told, limit, speed, warns):
    found, said = told(Travel(), speed=speed, firmware="px4", parameters={"MPC_XY_VEL_MAX": limit})
    assert found["MPC_XY_VEL_MAX"] == limit
    slower = (
        "MPC_XY_VEL_MAX = 3: slower than the 5 m/s of its program (warning: it takes longer than planned)"
    )
    assert said == ([slower] if warns else [])


def test_an_aggressive_robot_leaves_the_owners_margin(told):
    found, said = told(AGGRESSIVE, parameters={"WPNAV_RADIUS": 150.0, "AVOID_MARGIN": 0.5})
    assert (found["WPNAV_RADIUS"], found["AVOID_MARGIN"]) == (150.0, 0.5)
    assert said == []


@pytest.mark.parametrize(
    ("kind", "settings", "name"),
    [
        ("rover", {"parameters": {"WP_RADIUS": 2.0}}, "WP_RADIUS"),
        ("copter", {"parameters": {"WP_RADIUS_M": 2.0}}, "WP_RADIUS_M"),
        ("copter", {"firmware": "px4", "parameters": {"NAV_ACC_RAD": 2.0}}, "NAV_ACC_RAD"),
    ],
)
def test_the_radius_has_another_name_in_other_firmware(told, kind, settings, name):
    found, _ = told(SAFE, kind, **settings)
    assert found[name] == 1.0


def test_a_controller_sets_its_vehicle_up_before_take_off(controllers, hangar):
    land = LAND
    drone = robot_program("alpha", [take_off("up", 5.0), go_to("a", (0.0, 12.0, 5.0)), land])
    made = program(replace(drone, travel_mode="SAFE"))
    vehicles, links = hangar(made)
    code, said = controllers(made).run("fleet.py", *links)
    assert code == 0, said
    assert vehicles["alpha"].autopilot.parameters["AVOID_MARGIN"] == 4.0
