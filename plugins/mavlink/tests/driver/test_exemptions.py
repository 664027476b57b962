"""Vehicles answer a lost link in whatever mode programs use, where a policy has them answer."""

from __future__ import annotations

import pytest
from flight_crew import manned
from mavlink_peer import linked, value

from mmrs_mavlink.profiles import profile_for
from mmrs_mavlink.vehicles.owner_settings import end_exemption
from mmrs_runtime.faults import RefusedError


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
