from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input

from mmrs_core.analysis.clearance import RADIUS
from mmrs_core.behaviour.earth import degrees_of, metres, origin_above_ellipsoid, sea_level_of
from mmrs_core.behaviour.travel import TRAVEL_MARGINS, speed_of, travel_margins_of
from mmrs_core.errors import UnsupportedError
from mmrs_core.planning.corners import LEAST_CUT
from mmrs_core.scene import Capability, Frame
from mmrs_core.testing.programs import L_AQUILA, program
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.plugin.plans.wpl import WPL
from mmrs_mavlink.profiles import ARDUCOPTER, ARDUROVER, ARDUSUB, PX4_MULTICOPTER

DIVER = replace(
    quad(),
    metaclasses=(("urn:mmrs:robot:1.0", "Robot"),),
    capability_metaclasses=(
        ("urn:mmrs:auv:1.1", "AUVMovement"),
        ("urn:mmrs:robot:1.0", "MovementCapability"),
    ),
)
PX4 = quad(**{"mavlink.autopilot": "px4"})
CRAWLER = replace(quad(), metaclasses=(("urn:mmrs:robot:1.0", "Robot"),))


@pytest.mark.parametrize(
    ("type", "expected"),
    [(quad(), ARDUCOPTER), (PX4, PX4_MULTICOPTER), (DIVER, ARDUSUB), (CRAWLER, ARDUROVER)],
)
def test_the_type_says_which_vehicle_a_robot_is(type, expected):
    assert (
        context_of(robot_program("a", []), target_input(program(), [replace(type, name="Quad")])).profile
        == expected
    )


def test_without_a_type_what_takes_off_is_a_copter():
    unknown = target_input(program(), [])
    assert context_of(robot_program("a", [take_off("up", 5.0)]), unknown).profile == ARDUCOPTER
    assert context_of(robot_program("a", []), unknown).profile == ARDUROVER


@pytest.mark.parametrize(("mode", "speed"), [("SAFE", 4.0), ("NORMAL", 6.0), ("AGGRESSIVE", 8.0)])
def test_the_travel_mode_makes_the_speed(mode, speed):
    robot = replace(robot_program("a", []), travel_mode=mode)
    assert speed_of(go_to("m", (0.0, 0.0, 0.0), speed=None), robot, quad()) == speed


def test_the_speed_is_never_below_the_least_possible():
    type = replace(quad(), capabilities=(Capability(0.0, None, (7.0, 8.0)),))
    robot = replace(robot_program("a", []), travel_mode="SAFE")
    assert speed_of(go_to("m", (0.0, 0.0, 0.0), speed=None), robot, type) == 7.0


def test_the_speed_is_that_with_the_payload_carried():
    slow = Capability(0.5, None, (1.0, 4.0))
    type = replace(quad(), capabilities=(*quad().capabilities, slow))
    robot = replace(robot_program("a", []), payload=0.3)
    assert speed_of(go_to("m", (0.0, 0.0, 0.0), speed=None), robot, type) == 3.0


def test_heights_of_what_dives_count_from_the_surface():
    robot = robot_program("a", [], home=(0.0, 0.0, 1.5))
    frame = replace(L_AQUILA, surface=1.0)
    given = target_input(program(robot, frame=frame), [replace(DIVER, name="Quad")])
    assert context_of(robot, given).height((0.0, 0.0, -4.0)) == -5.0


def test_degrees_of_another_crs_are_those_of_wgs84():
    frame = Frame("EPSG:4230", 42.37, 13.35)
    ((latitude, longitude),) = degrees_of([(0.0, 0.0)], frame)
    assert (latitude, longitude) != (42.37, 13.35)
    assert abs(latitude - 42.37) < 0.003
    assert abs(longitude - 13.35) < 0.003


def test_a_local_frame_has_no_degrees():
    with pytest.raises(UnsupportedError, match="is local"):
        degrees_of([(0.0, 0.0)], Frame("EPSG:4326", None, None))


@pytest.mark.parametrize(
    ("frame", "expected"),
    [
        (L_AQUILA, 722.0),
        (Frame("EPSG:4326", 42.37, 13.35, 770.0, "ELLIPSOID", 47.5), 724.5),
        (Frame("EPSG:4326", 42.37, 13.35, 770.0, "ELLIPSOID"), None),
        (Frame("EPSG:4326", 42.37, 13.35, 0.0, "ORIGIN"), None),
        (Frame("EPSG:4326", 42.37, 13.35), None),
    ],
)
def test_the_height_above_the_sea_is_told_only_where_it_is_known(frame, expected):
    assert sea_level_of((0.0, 0.0, 2.0), frame) == expected


@pytest.mark.parametrize(
    ("frame", "expected"),
    [
        (Frame("EPSG:4326", 42.37, 13.35, 770.0, "ELLIPSOID"), 770.0),
        (Frame("EPSG:4326", 42.37, 13.35, 720.0, "MSL", 47.5), 767.5),
        (L_AQUILA, None),
        (Frame("EPSG:4326", 42.37, 13.35, 0.0, "ORIGIN", 47.5), None),
        (Frame("EPSG:4326", 42.37, 13.35), None),
    ],
)
def test_the_height_above_the_ellipsoid_is_told_only_where_it_is_known(frame, expected):
    assert origin_above_ellipsoid(frame) == expected


def test_a_length_is_never_minus_zero():
    assert str(metres(-0.0001)) == "0.0"


@pytest.mark.parametrize(
    ("mode", "error", "acceptance"),
    [
        ("SAFE", 3.0, 0.5),
        ("NORMAL", 3.0, 0.5),
        ("AGGRESSIVE", 0.0, 0.5),
        ("AGGRESSIVE", 0.8, 0.8),
        ("AGGRESSIVE", 3.0, 1.0),
    ],
)
def test_a_place_counts_as_reached_as_near_as_mode_and_position_error_allow(mode, error, acceptance):
    robot = replace(robot_program("alpha", []), travel_mode=mode)
    assert travel_margins_of(robot, error).acceptance == acceptance


def test_no_travel_mode_has_vehicles_cut_corners_farther_than_plans_and_checks_allow_for():
    """Vehicles go by within their radius, which is never made larger than this."""
    most = max(margins.radius for margins in TRAVEL_MARGINS.values())
    assert most <= LEAST_CUT
    assert most <= RADIUS


@pytest.mark.parametrize("target", [MAVLINK_PYTHON, WPL], ids=lambda target: target.name)
@pytest.mark.parametrize(("latitude", "refused"), [(89.5, True), (-89.5, True), (88.5, False)])
def test_at_a_pole_nobody_steers_by_degrees(target, latitude, refused):
    there = Frame("EPSG:4326", latitude, 10.0, 0.0, "MSL")
    given = target_input(program(robot_program("alpha", (take_off("up", 20.0), LAND)), frame=there))
    faults = [fault for fault in target.refusals(given) if "a pole" in fault]
    assert bool(faults) is refused
