"""Settings of the owner of a vehicle: its fences, whose heartbeats it counts, where its failsafe acts."""

import pytest
from flight_crew import manned
from mavlink_peer import ARDUPILOT, PX4, linked, value

from mmrs_mavlink import Geographic
from mmrs_mavlink.driving.lost_link import LostLink
from mmrs_mavlink.profiles import ARDUCOPTER, ARDUROVER, profile_for
from mmrs_mavlink.program import Policy
from mmrs_mavlink.services.items import Item
from mmrs_mavlink.vehicles.owner_settings import check_listening, enclose, end_exemption
from mmrs_runtime.faults import RefusedError

HOME = Geographic(42.37, 13.35, 0.0)
USUAL = {"FENCE_ENABLE": 0.0, "FENCE_TYPE": 7.0, "FENCE_RADIUS": 300.0, "FENCE_ALT_MAX": 100.0}


def place(north: float = 0.0, height: float = 20.0) -> Geographic:
    return Geographic(42.37 + north / 111_073.0, 13.35, height)


def told(*places, polygons: bool = True, rally=(), autopilot: int = ARDUPILOT, profile=None, **values: float):
    """Return what people are told, and the vehicle's parameters afterwards."""
    kept = dict(values)

    def answer(message):
        kind = message.get_type()
        if kind == "PARAM_SET" and message.param_id in kept:
            kept[message.param_id] = message.param_value
        if kind in ("PARAM_SET", "PARAM_REQUEST_READ") and message.param_id in kept:
            yield value(message.param_id, kept[message.param_id])

    with linked(answer, autopilot=autopilot) as (link, _):
        if profile is not None:
            link.expect(profile)
        return list(enclose(link, HOME, places, rally, polygons=polygons)), kept


def test_a_fence_that_was_off_heeds_nothing_but_the_areas_of_the_program():
    lines, kept = told(place(1000.0, 150.0), **USUAL)
    assert kept["FENCE_TYPE"] == 4.0
    assert lines == ["FENCE_TYPE = 4, which was 7: its fence is the areas of the program alone"]


def test_a_fence_that_was_off_stays_as_it_is_where_there_are_no_areas():
    lines, kept = told(place(1000.0), polygons=False, **USUAL)
    assert (lines, kept) == ([], USUAL)


def test_a_rover_halts_no_farther_from_its_fence_than_its_path_leads():
    here = USUAL | {"FENCE_TYPE": 4.0, "FENCE_MARGIN": 2.0}
    lines, kept = told(place(10.0, 0.0), profile=ARDUROVER, **here)
    assert kept["FENCE_MARGIN"] == pytest.approx(0.1)
    assert lines == ["FENCE_MARGIN = 0.1, which was 2: its path leads nearer to its fence"]


@pytest.mark.parametrize(
    "more", [{"profile": ARDUCOPTER}, {"profile": ARDUROVER, "polygons": False}], ids=["copter", "no areas"]
)
def test_the_margin_of_a_fence_that_halts_no_program_stays(more):
    here = USUAL | {"FENCE_TYPE": 4.0, "FENCE_MARGIN": 2.0}
    lines, kept = told(place(10.0, 0.0), **more, **here)
    assert (lines, kept) == ([], here)


@pytest.mark.parametrize(
    ("where", "words"),
    [
        (place(299.0), r"ends 300 m from home \(FENCE_RADIUS\), and its program goes 299 m"),
        (place(0.0, 99.0), r"ends 100 m above home \(FENCE_ALT_MAX\), and its program goes to 99 m"),
    ],
)
def test_a_program_that_leaves_a_fence_that_was_on_is_refused(where, words):
    with pytest.raises(RefusedError, match=words):
        told(where, **USUAL | {"FENCE_ENABLE": 1.0})


def test_a_program_inside_a_fence_that_was_on_is_not_and_the_fence_stays():
    lines, kept = told(place(290.0, 90.0), **USUAL | {"FENCE_ENABLE": 1.0})
    assert (lines, kept["FENCE_TYPE"]) == ([], 7.0)


def test_only_what_a_fence_heeds_counts_and_areas_are_added():
    lines, kept = told(place(1000.0, 90.0), **USUAL | {"FENCE_ENABLE": 1.0, "FENCE_TYPE": 1.0})
    assert kept["FENCE_TYPE"] == 5.0
    assert lines == ["FENCE_TYPE = 5, which was 1: its fence obeys the areas of the program, too"]


def test_a_px4_heeds_its_distances_unless_they_are_zero():
    assert told(place(500.0), autopilot=PX4, GF_MAX_HOR_DIST=0.0, GF_MAX_VER_DIST=0.0)[0] == []
    with pytest.raises(RefusedError, match="GF_MAX_HOR_DIST"):
        told(place(500.0), autopilot=PX4, GF_MAX_HOR_DIST=400.0, GF_MAX_VER_DIST=0.0)


def test_a_vehicle_that_tells_nothing_is_not_refused():
    assert told(place(500.0))[0] == []


def test_rally_points_that_are_too_far_are_told():
    point = Item(5100, x=423_700_000, y=133_500_000, z=20.0)
    usual = USUAL | {"FENCE_TYPE": 4.0, "RALLY_LIMIT_KM": 0.3}
    (line,) = told(place(800.0), rally=[point], **usual)[0]
    assert "from 800 m away it goes home" in line
    assert told(place(200.0), rally=[point], **usual)[0] == []


def answering(options: float, *, keeps: bool = False):
    """Return how a vehicle answers that has these options, and may not let them be changed."""
    held = [options]

    def answer(message):
        if message.get_type() == "PARAM_SET" and not keeps:
            held[0] = message.param_value
        if message.get_type() == "PARAM_SET" or getattr(message, "param_id", "") == "FS_OPTIONS":
            yield value("FS_OPTIONS", held[0])
        elif message.get_type() == "PARAM_REQUEST_READ":
            yield value("ANOTHER", 0.0, index=message.param_index)

    return answer


def test_a_copter_that_would_go_on_with_its_mission_is_told_otherwise():
    with linked(answering(18.0)) as (link, wire):
        said = end_exemption(link)
    assert said == "FS_OPTIONS = 16, which was 18: it answers a lost link in missions, too"
    assert [each.param_value for each in wire.of("PARAM_SET")] == [16.0]


@pytest.mark.parametrize(("kind", "options"), [("copter", 16.0), ("rover", 2.0)])
def test_others_are_left_as_they_are(kind, options):
    with linked(answering(options)) as (link, wire):
        link.expect(profile_for(kind))
        assert end_exemption(link) == ""
    assert wire.of("PARAM_SET") == []


def test_a_copter_that_insists_on_going_on_is_refused():
    with (
        linked(answering(2.0, keeps=True)) as (link, _),
        pytest.raises(RefusedError, match="does not confirm FS_OPTIONS = 0"),
    ):
        end_exemption(link)


def test_a_px4_that_would_go_on_is_told_otherwise_for_the_modes_of_its_program():
    with manned(firmware="px4", parameters={"COM_DLL_EXCEPT": 13}) as made:
        made.vehicle.answer_lost_link("CONTINUE")
        assert made.simulated.autopilot.parameters["COM_DLL_EXCEPT"] == 13
        made.vehicle.answer_lost_link("RETURN")
        assert made.simulated.autopilot.parameters["COM_DLL_EXCEPT"] == 8


def test_a_robot_with_an_answer_to_a_lost_link_ends_what_its_owner_had_exempted():
    with manned(parameters={"FS_OPTIONS": 2.0}) as made:
        made.vehicle.answer_lost_link("CONTINUE")
        assert made.simulated.autopilot.parameters["FS_OPTIONS"] == 2.0
        made.vehicle.answer_lost_link("RETURN")
        assert made.simulated.autopilot.parameters["FS_OPTIONS"] == 0.0


OTHER = "zzz"
"""The parameter that is asked for by its number."""


def heard_by(values, *, autopilot: int = 3) -> str:
    """Return what is said of a vehicle that tells these parameters."""

    def answer(message):
        if message.get_type() == "PARAM_REQUEST_READ":
            if message.param_index >= 0:
                yield value(OTHER, 0.0, index=message.param_index)
            elif message.param_id in values:
                yield value(message.param_id, values[message.param_id])

    with linked(answer, autopilot=autopilot) as (link, _):
        return check_listening(link)


@pytest.mark.parametrize(
    "values",
    [
        {"SYSID_MYGCS": 255.0},
        {"MAV_GCS_SYSID": 255.0, "MAV_GCS_SYSID_HI": 0.0},
        {"MAV_GCS_SYSID": 250.0, "MAV_GCS_SYSID_HI": 255.0},
    ],
)
def test_a_vehicle_that_counts_our_heartbeats_is_told_of_in_no_word(values):
    assert heard_by(values) == ""


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"SYSID_MYGCS": 254.0}, r"system 254 \(SYSID_MYGCS\).*set SYSID_MYGCS to 255"),
        ({"MAV_GCS_SYSID": 1.0, "MAV_GCS_SYSID_HI": 0.0}, r"system 1 \(MAV_GCS_SYSID\)"),
        ({"MAV_GCS_SYSID": 1.0, "MAV_GCS_SYSID_HI": 254.0}, r"system 1 to 254 \(MAV_GCS_SYSID\)"),
    ],
)
def test_a_vehicle_that_would_never_miss_us_is_refused(values, words):
    with pytest.raises(RefusedError, match=words):
        heard_by(values)


def test_a_vehicle_that_does_not_tell_is_told_of():
    assert "does not tell whose heartbeats it counts" in heard_by({})


def test_a_px4_takes_any_ground_station():
    assert heard_by({}, autopilot=PX4) == ""


def test_a_robot_whose_policy_wants_an_answer_to_a_lost_link_does_not_begin_with_such_a_vehicle(in_the_air):
    made = in_the_air(Policy("LINK_LOST", "RETURN"), parameters={"SYSID_MYGCS": 254.0})
    with pytest.raises(RefusedError, match="would not notice when this program falls silent"):
        LostLink(made.robot, made.vehicle, made.said.append).tell()
    assert made.simulated.autopilot.parameters["FS_GCS_ENABLE"] != 3.0


def test_a_robot_that_carries_on_without_a_link_may_begin_with_it(in_the_air):
    made = in_the_air(Policy("LINK_LOST", "CONTINUE"), parameters={"SYSID_MYGCS": 254.0})
    LostLink(made.robot, made.vehicle, made.said.append).tell()
    assert made.simulated.autopilot.parameters["FS_GCS_ENABLE"] == 0.0
