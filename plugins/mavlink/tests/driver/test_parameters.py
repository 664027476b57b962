"""Parameters: asked for together, written with read-back, and in each autopilot's coding."""

import time

import pytest
from mavlink_peer import ARDUPILOT, PX4, bytewise, linked, value
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.retries import Retries
from mmrs_mavlink.profiles import ARDUROVER, PROFILES, profile_for
from mmrs_mavlink.services import parameters
from mmrs_mavlink.vehicles import preparation
from mmrs_runtime.faults import RefusedError

pytestmark = pytest.mark.real_time("parts of flights")

REAL, INT = mavlink.MAV_PARAM_TYPE_REAL32, mavlink.MAV_PARAM_TYPE_INT32


class Values:
    """A vehicle's parameter service."""

    def __init__(self, deaf: int = 0, stubborn: bool = False, **values: float) -> None:
        self.values = values
        self.deaf = deaf
        self.stubborn = stubborn

    def __call__(self, message):
        if message.get_type() not in ("PARAM_REQUEST_READ", "PARAM_SET"):
            return
        if self.deaf:
            self.deaf -= 1
            return
        name = message.param_id
        if message.get_type() == "PARAM_REQUEST_READ" and 0 <= message.param_index < len(self.values):
            name = list(self.values)[message.param_index]
            yield value(name, self.values[name], index=message.param_index)
        elif message.get_type() == "PARAM_REQUEST_READ" and message.param_index >= 0:
            yield value(f"OTHER_{message.param_index}", 0.0, index=message.param_index)
        elif name in self.values:
            if message.get_type() == "PARAM_SET" and not self.stubborn:
                self.values[name] = message.param_value
            yield value(name, self.values[name])


def test_all_are_asked_for_at_once_and_those_that_are_not_there_are_left_out():
    with linked(Values(A=1.0, B=2.5)) as (link, wire):
        assert parameters.read(link, ["A", "NONE", "B"]) == {"A": 1.0, "B": 2.5}
        asked = [message.param_id for message in wire.of("PARAM_REQUEST_READ")]
        assert asked == ["A", "NONE", "B", "", *["NONE", ""] * (parameters.ROUNDS - 1)]


def test_what_has_not_come_before_a_parameter_that_was_asked_for_last_is_not_waited_for():
    first = {f"FIRST_{number}": 7.0 for number in range(parameters.MARKS)}
    with linked(Values(**first, A=1.0)) as (link, _):
        link.retries = Retries(answer=10.0)
        begun = time.monotonic()
        assert parameters.read(link, ["A", "NONE"]) == {"A": 1.0}
        assert time.monotonic() - begun < 5.0


@pytest.mark.parametrize("copies", [1, 2])
def test_an_answer_that_was_lost_or_doubled_on_the_way_makes_no_parameter_unknown(copies):
    values, lost = Values(FIRST=7.0, SECOND=8.0, A=1.0, B=2.0), ["A"]

    def answer(message):
        if message.param_id in lost:
            lost.remove(message.param_id)
        else:
            yield from (reply for reply in values(message) for _ in range(copies))

    with linked(answer) as (link, _):
        assert parameters.read(link, ["A", "NONE", "B"]) == {"A": 1.0, "B": 2.0}


def test_an_answer_to_one_reading_that_comes_in_the_next_is_no_answer_to_that():
    values, late = Values(A=1.0, B=2.0), []

    def answer(message):
        replies = list(values(message))
        if message.get_type() == "PARAM_REQUEST_READ" and message.param_index >= 0 and not late:
            late.extend(replies)
            return
        if message.param_id == "B":
            yield from late
            time.sleep(0.05)
        yield from replies

    with linked(answer) as (link, wire):
        assert parameters.read(link, ["A"]) == {"A": 1.0}
        assert parameters.read(link, ["B"]) == {"B": 2.0}
        asked = [message.param_id for message in wire.of("PARAM_REQUEST_READ")]
        assert asked == ["A", "", "B", ""]


def test_a_vehicle_that_tells_none_is_asked_once():
    with linked() as (link, wire):
        assert parameters.read(link, ["A", "B"]) == {}
        assert [message.param_id for message in wire.of("PARAM_REQUEST_READ")] == ["A", "B", ""]


def test_a_lost_answer_is_asked_for_again():
    with linked(Values(deaf=1, A=1.0, B=2.0)) as (link, _):
        assert parameters.read(link, ["A", "B"]) == {"A": 1.0, "B": 2.0}


def test_a_value_is_written_and_confirmed():
    values = Values(deaf=1, A=1.0)
    with linked(values) as (link, _):
        assert parameters.write(link, "A", 3.3)
    assert values.values["A"] == pytest.approx(3.3)


def test_a_value_that_the_vehicle_does_not_take_is_not_confirmed():
    with linked(Values(stubborn=True, A=1.0)) as (link, _):
        assert not parameters.write(link, "A", 3.0)


@pytest.mark.parametrize(("autopilot", "sent"), [(ARDUPILOT, (3.0, REAL)), (PX4, (bytewise(3), INT))])
def test_whole_numbers_are_coded_as_each_autopilot_wants_them(autopilot, sent):
    def answer(message):
        if message.get_type() == "PARAM_SET":
            yield value("NAV_DLL_ACT", message.param_value, INT)

    with linked(answer, autopilot=autopilot) as (link, wire):
        assert parameters.write(link, "NAV_DLL_ACT", 3)
        (message,) = wire.of("PARAM_SET")
        assert (message.param_value, message.param_type) == sent


@pytest.mark.parametrize(("autopilot", "coded"), [(ARDUPILOT, 5.0), (PX4, bytewise(5))])
def test_whole_numbers_are_understood_from_each_autopilot(autopilot, coded):
    with linked(lambda message: [value("A", coded, INT)], autopilot=autopilot) as (link, _):
        assert parameters.read(link, ["A"]) == {"A": 5.0}


def test_failsafes_are_told_in_words_with_a_warning_where_there_is_cause():
    values = Values(
        FS_GCS_ENABLE=0.0, BATT_FS_LOW_ACT=0.0, FENCE_ACTION=1.0, DISARM_DELAY=2.0, RTL_ALT=1500.0
    )
    with linked(values) as (link, _):
        told = list(preparation.report_failsafes(link))
    assert told == [
        "FS_GCS_ENABLE = 0: no heartbeats from the ground: nothing",
        "BATT_FS_LOW_ACT = 0: battery low: nothing (warning: no failsafe set)",
        "FENCE_ACTION = 1: fence broken: return, or land",
        "RTL_ALT = 1500: height at which it returns: 1500 cm",
        "DISARM_DELAY = 2: seconds on the ground until it disarms: 2 s"
        " (warning: it may disarm before its take-off command)",
    ]


def test_a_vehicle_that_tells_no_failsafes_is_told():
    with linked() as (link, _):
        link.expect(ARDUROVER)
        (line,) = preparation.report_failsafes(link)
    assert line == "the vehicle reports none of its failsafe parameters: check its failsafes yourself"


@pytest.mark.parametrize(
    ("autopilot", "response", "expected"),
    [
        (ARDUPILOT, "RETURN", {"FS_GCS_ENABLE": 3.0, "FS_GCS_TIMEOUT": 20.0}),
        (
            ARDUPILOT,
            "EMERGENCY_AREA",
            {"RALLY_INCL_HOME": 0.0, "RALLY_LIMIT_KM": 0.0, "FS_GCS_ENABLE": 1.0, "FS_GCS_TIMEOUT": 20.0},
        ),
        (
            PX4,
            "LAND",
            {
                "COM_OBL_RC_ACT": bytewise(4),
                "NAV_DLL_ACT": bytewise(3),
                "COM_OF_LOSS_T": 20.0,
                "COM_DL_LOSS_T": bytewise(20),
            },
        ),
    ],
)
def test_a_lost_link_is_answered_by_parameters(autopilot, response, expected):
    def answer(message):
        if message.get_type() == "PARAM_SET":
            yield value(message.param_id, message.param_value, message.param_type)

    with linked(answer, autopilot=autopilot) as (link, wire):
        assert preparation.answer_lost_link(link, response, 20.0) == ""
        assert {message.param_id: message.param_value for message in wire.of("PARAM_SET")} == expected


def test_seconds_that_no_vehicle_can_be_told_are_told_to_people():
    def answer(message):
        if message.get_type() == "PARAM_SET":
            yield value(message.param_id, message.param_value)

    with linked(answer) as (link, _):
        otherwise = preparation.answer_lost_link(link, "LAND", 500.0)
    assert otherwise == "the vehicle responds to a lost link after 120 s, not 500 s"


def test_a_response_that_a_vehicle_cannot_give_by_itself_is_refused():
    with linked() as (link, _), pytest.raises(RefusedError, match="a copter cannot do SURFACE as a failsafe"):
        preparation.answer_breach(link, "SURFACE")


def test_a_response_that_the_vehicle_does_not_confirm_is_refused():
    with (
        linked() as (link, _),
        pytest.raises(RefusedError, match=r"a broken fence: .* confirm FENCE_ACTION = 2"),
    ):
        preparation.answer_breach(link, "LAND")


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_every_parameter_that_is_set_is_one_that_is_told_or_of_little_account(profile):
    told = {each.name for each in profile.safeguards} | {"RALLY_INCL_HOME", "RALLY_LIMIT_KM", "RTL_TYPE"}
    answers = [*profile.lost_link.answers.values(), *profile.breach.values()]
    assert {name for values in answers for name in values} <= told


def test_a_rover_that_is_to_flee_returns_to_a_rally_point_and_not_home_by_its_way():
    told = ARDUROVER.lost_link.answers["EMERGENCY_AREA"]
    assert told == {"RALLY_INCL_HOME": 0, "RALLY_LIMIT_KM": 0, "FS_ACTION": 1, "FS_GCS_ENABLE": 1}


def test_a_submarine_that_stops_when_a_joystick_falls_silent_is_told_of():
    values = Values(FS_PILOT_INPUT=2.0)
    with linked(values) as (link, _):
        link.expect(profile_for("sub"))
        (line,) = preparation.report_failsafes(link)
    assert line.startswith("FS_PILOT_INPUT = 2: a pilot's sticks, once used, fall silent: disarm (warning: ")
