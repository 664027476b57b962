"""Whose heartbeats a vehicle counts, by its parameters."""

from __future__ import annotations

import pytest
from mavlink_peer import PX4, linked, value

from mmrs_mavlink.driving.lost_link import LostLink
from mmrs_mavlink.program import Policy
from mmrs_mavlink.vehicles.owner_settings import check_listening
from mmrs_runtime.faults import RefusedError

OTHER = "zzz"
"""The parameter that is asked for by its number."""


def told(values, *, autopilot: int = 3) -> str:
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
    assert told(values) == ""


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
        told(values)


def test_a_vehicle_that_does_not_tell_is_told_of():
    assert "does not tell whose heartbeats it counts" in told({})


def test_a_px4_takes_any_ground_station():
    assert told({}, autopilot=PX4) == ""


def test_a_robot_whose_policy_wants_an_answer_to_a_lost_link_does_not_begin_with_such_a_vehicle(in_the_air):
    made = in_the_air(Policy("LINK_LOST", "RETURN"), parameters={"SYSID_MYGCS": 254.0})
    with pytest.raises(RefusedError, match="would not notice when this program falls silent"):
        LostLink(made.robot, made.vehicle, made.said.append).tell()
    assert made.simulated.autopilot.parameters["FS_GCS_ENABLE"] != 3.0


def test_a_robot_that_carries_on_without_a_link_may_begin_with_it(in_the_air):
    made = in_the_air(Policy("LINK_LOST", "CONTINUE"), parameters={"SYSID_MYGCS": 254.0})
    LostLink(made.robot, made.vehicle, made.said.append).tell()
    assert made.simulated.autopilot.parameters["FS_GCS_ENABLE"] == 0.0
