"""Heights, depths, ranges, equipment and weather against hand-made figures."""

from dataclasses import replace

import pytest
from checking import FLYER, finding, findings, given, kind, land, rover, square, strange, take_off

from mmrs_core.analysis.envelope import ATMOSPHERE, GRAVITY
from mmrs_core.behaviour.program import Heading, MoveTarget
from mmrs_core.contributions.checks import Status
from mmrs_core.scene import DeviceAction, Part
from mmrs_core.testing.small_programs import go, hold, robot, use

AWAY = go("away", (30.0, 40.0, 0.0))


def flight(height=10.0, over=None):
    return robot("a", [take_off("up", height), go("over", over or (5.0, 0.0, height)), land("down")])


def flyer(**more):
    return kind(launches=True, **more)


@pytest.mark.parametrize(
    ("over", "limits", "status", "margin"),
    [
        pytest.param(14.0, {"ceiling": 12.0}, Status.VIOLATED, -2.0, id="above the ceiling"),
        pytest.param(10.0, {"floor": 2.0, "ceiling": 30.0}, Status.SAFE, 8.0, id="take-off and landing"),
        pytest.param(1.5, {"floor": 2.0}, Status.VIOLATED, -0.5, id="below the floor"),
        pytest.param(10.0, {}, Status.NOT_CHECKED, None, id="no limits"),
    ],
)
def test_altitudes_stay_between_floor_and_ceiling(over, limits, status, margin):
    verdict = finding("altitude", given(flight(10.0, (5.0, 0.0, over)), robot_kind=flyer(**limits)))
    assert verdict.status is status
    assert verdict.margin == (None if margin is None else pytest.approx(margin))
    assert (verdict.move, verdict.unit) == ("over", "m") or status is not Status.VIOLATED


def test_an_unknown_robot_kind_is_unknown():
    verdict = finding("altitude", given(flight(), robot_kind=kind(FLYER)))
    assert verdict.status is Status.UNKNOWN
    assert "no plug-in provides a robot kind for type 'plain'" in verdict.message


def dive(depth, *, surface=0.0, type=None, robot_kind=None, density=None):
    moves = [go("down", (0.0, 0.0, -depth))]
    environment = {} if density is None else {"waterDensity": density}
    return given(
        robot("a", moves), type=type, robot_kind=robot_kind, surface=surface, environment=environment
    )


@pytest.mark.parametrize(
    ("surface", "status", "spare"), [(0.0, Status.SAFE, 2.0), (3.0, Status.VIOLATED, -1.0)]
)
def test_pressure_follows_from_density_and_the_depth_below_the_surface(surface, status, spare):
    deep = rover(attributes={"maxOperatingPressure": ATMOSPHERE + 1000.0 * GRAVITY * 12.0})
    verdict = finding("depth", dive(10.0, surface=surface, type=deep, density=1000.0))
    assert (verdict.status, verdict.unit, verdict.move) == (status, "Pa", "down")
    assert verdict.margin == pytest.approx(1000.0 * GRAVITY * spare)


def test_a_dive_to_the_limit_is_safe_though_its_coordinates_are_rounded():
    deep = rover(attributes={"maxOperatingPressure": ATMOSPHERE + 1000.0 * GRAVITY * 10.0})
    assert finding("depth", dive(10.0 + 2e-7, type=deep, density=1000.0)).status is Status.SAFE
    assert finding("depth", dive(10.0 + 2e-6, type=deep, density=1000.0)).status is Status.VIOLATED


def test_a_dive_without_figures_is_unknown_and_says_which():
    verdict = finding("depth", dive(10.0))
    assert verdict.status is Status.UNKNOWN
    assert verdict.message == (
        "a: goes 10.00 m under the surface, the maxOperatingPressure of robot type 'plain'"
        " and the environment's waterDensity not given"
    )


def test_a_type_for_less_than_the_pressure_of_the_air_is_violated_wherever_it_goes():
    made = given(robot("a", [strange("dig")]), type=rover(attributes={"maxOperatingPressure": 1000.0}))
    assert [verdict.status for verdict in findings("depth", made)] == [Status.VIOLATED, Status.UNKNOWN]


def test_a_flying_robot_below_the_origin_is_not_taken_to_dive():
    verdict = finding("depth", dive(10.0, robot_kind=flyer()))
    assert verdict.status is Status.NOT_CHECKED
    assert "over land as its type states no operating pressure" in verdict.message


def test_a_robot_above_the_surface_is_not_checked_for_depth():
    assert finding("depth", given(robot("a", [AWAY]))).status is Status.NOT_CHECKED


@pytest.mark.parametrize(("reach", "status"), [(60.0, Status.SAFE), (45.0, Status.VIOLATED)])
def test_range_is_the_largest_distance_from_home(reach, status):
    made = given(robot("a", [AWAY]), type=rover(attributes={"communicationRange": reach}))
    verdict = finding("range", made)
    assert (verdict.status, verdict.move, verdict.margin) == (status, "away", pytest.approx(reach - 50.0))


def test_payload_is_compared_with_what_the_type_carries():
    loaded = replace(robot("a", []), payload=2.0)
    assert finding("payload", given(loaded, type=rover(max_payload=2.5))).margin == pytest.approx(0.5)
    assert finding("payload", given(loaded, type=rover(max_payload=1.5))).status is Status.VIOLATED


def test_a_type_without_a_largest_payload_carries_none():
    assert finding("payload", given(robot("a", []))).status is Status.SAFE
    assert finding("payload", given(replace(robot("a", []), payload=0.1))).status is Status.VIOLATED


@pytest.mark.parametrize(("speed", "margin"), [(3.0, 1.0), (5.0, -1.0), (0.5, -0.5)])
def test_commanded_speed_stays_within_the_capability(speed, margin):
    moves = [go("m1", (9.0, 0.0, 0.0), speed=speed)]
    verdict = finding("speed", given(robot("a", moves), type=rover(speed=(1.0, 4.0))))
    assert verdict.margin == pytest.approx(margin)
    assert verdict.status is (Status.SAFE if margin >= 0 else Status.VIOLATED)


def test_speed_by_travel_mode_is_not_checked():
    assert finding("speed", given(robot("a", [AWAY]))).status is Status.NOT_CHECKED


CAMERA = {"camera": {"shoot": 2.0}}


def photo(**more):
    return hold("photo", after=(replace(use("camera", "shoot"), **more),))


def test_devices_and_actions_that_the_type_has_are_safe():
    assert finding("devices", given(robot("a", [photo()]), type=rover(devices=CAMERA))).status is Status.SAFE


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"device": "lamp"}, "'plain' has no device 'lamp'"),
        ({"name": "zoom"}, "device 'camera' does not support action 'zoom'"),
        ({"parameters": (("iso", "100"),)}, "action 'shoot' of device 'camera' has no parameter 'iso'"),
    ],
)
def test_what_the_type_lacks_is_named(wrong, words):
    verdict = finding("devices", given(robot("a", [photo(**wrong)]), type=rover(devices=CAMERA)))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "photo")
    assert verdict.message == f"a: HoldPosition 'photo': {words}"


def test_parameters_that_the_action_accepts_are_safe():
    type = rover(devices=CAMERA)
    action = DeviceAction("shoot", 2.0, ("iso",))
    camera = replace(type.devices["camera"], actions={"shoot": action})
    made = robot("a", [photo(parameters=(("iso", "100"),))])
    assert (
        finding("devices", given(made, type=replace(type, devices={"camera": camera}))).status is Status.SAFE
    )


def test_a_heading_needs_its_device():
    looking = replace(AWAY, heading=Heading(MoveTarget((0.0, 0.0, 0.0)), "lamp"))
    verdict = finding("devices", given(robot("a", [looking]), type=rover(devices=CAMERA)))
    assert verdict.message == "a: GoTo 'away' points device 'lamp', which 'plain' does not have"


def test_wind_is_compared_with_what_a_flying_robot_holds_against():
    windy = given(
        flight(),
        robot_kind=flyer(),
        type=rover(attributes={"positionHold": 8.0}),
        environment={"windSpeed": 9.0},
    )
    verdict = finding("wind", windy)
    assert (verdict.status, verdict.margin, verdict.unit) == (Status.VIOLATED, -1.0, "m/s")


def test_a_wind_in_which_no_robot_of_the_type_holds_is_violated_though_it_has_no_home():
    made = robot("a", [take_off("up", 10.0), land("down")], home=None)
    type = rover(attributes={"positionHold": 8.0})
    found = findings("wind", given(made, type=type, environment={"windSpeed": 9.0}))
    assert [verdict.status for verdict in found] == [Status.VIOLATED, Status.UNKNOWN]
    assert (found[0].move, found[0].margin) == ("up", pytest.approx(-1.0))


def test_wind_does_not_concern_what_stays_on_the_ground():
    idle = given(robot("a", []), robot_kind=flyer(), environment={"windSpeed": 9.0})
    driving = given(robot("a", [AWAY]), environment={"windSpeed": 9.0})
    assert [finding("wind", each).status for each in (idle, driving)] == [Status.NOT_CHECKED] * 2


@pytest.mark.parametrize(("temperature", "margin"), [(5.0, 5.0), (38.0, 2.0), (-3.0, -3.0)])
def test_temperature_stays_within_the_operating_range(temperature, margin):
    bounds = Part((), {"min": 0.0, "max": 40.0})
    made = given(
        robot("a", []),
        type=rover(attributes={"operatingTemperature": bounds}),
        environment={"temperature": temperature},
    )
    verdict = finding("temperature", made)
    assert (verdict.margin, verdict.unit) == (margin, "°C")
    assert verdict.status is (Status.SAFE if margin >= 0 else Status.VIOLATED)


HOLDS = rover(attributes={"positionHold": 8.0})
OPERATES = rover(attributes={"operatingTemperature": Part((), {"min": 0.0, "max": 40.0})})
STANDS, WINDY = robot("a", []), {"windSpeed": 9.0}


@pytest.mark.parametrize(
    ("name", "made", "status", "words"),
    [
        (
            "range",
            given(robot("a", [AWAY])),
            Status.UNKNOWN,
            "the communicationRange of robot type 'plain' is not given",
        ),
        (
            "wind",
            given(flight(), robot_kind=flyer(), environment=WINDY),
            Status.UNKNOWN,
            "the positionHold of robot type 'plain' is not given",
        ),
        (
            "wind",
            given(flight(), robot_kind=flyer(), type=HOLDS),
            Status.NOT_CHECKED,
            "the environment states no windSpeed, the robot holds against 8 m/s",
        ),
        ("wind", given(robot("a", [AWAY])), Status.NOT_CHECKED, "it does not fly"),
        (
            "temperature",
            given(STANDS, environment={"temperature": 20.0}),
            Status.UNKNOWN,
            "the operatingTemperature of robot type 'plain' is not given",
        ),
        (
            "temperature",
            given(STANDS, type=OPERATES),
            Status.NOT_CHECKED,
            "the environment states no temperature, the robot operates from 0 to 40 °C",
        ),
    ],
)
def test_what_is_missing_is_named(name, made, status, words):
    verdict = finding(name, made)
    assert (verdict.status, verdict.message) == (status, f"a: {words}")


@pytest.mark.parametrize("name", ["altitude", "range", "endurance", "energy", "states", "clearance"])
def test_a_move_of_an_unknown_kind_leaves_what_depends_on_it_unknown(name):
    made = given(
        robot("a", [strange("dig")]),
        robot_kind=kind(ceiling=10.0),
        type=rover(attributes={"communicationRange": 60.0}),
        areas=(square(at=(0.0, 50.0)),),
    )
    verdicts = findings(name, made)
    assert [verdict.status for verdict in verdicts] == [Status.UNKNOWN]
    assert "Burrow" in verdicts[0].message
