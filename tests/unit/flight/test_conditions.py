from __future__ import annotations

from dataclasses import replace

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.flight.conditions import is_standard, question_of, standard
from mmrs_core.flight.program import Local
from mmrs_core.flight.vehicles.detections import Detections
from mmrs_core.flight.vehicles.vehicle import State

HERE = State(0.0, Local(0.0, 0.0, 5.0), 0.0, 0.0, None)


@pytest.mark.parametrize(("energy", "holds"), [(0.29, True), (0.3, False), (None, None)])
def test_a_battery_is_below_a_part_or_not_known(energy, holds):
    assert standard("battery-below:0.3")(replace(HERE, energy=energy)) is holds


@pytest.mark.parametrize(("wind", "holds"), [(8.1, True), (8.0, False), (None, None)])
def test_the_wind_is_above_a_speed_or_not_known(wind, holds):
    assert standard("wind-above:8")(replace(HERE, wind=wind)) is holds


def test_what_was_not_detected_yet_was_not_detected():
    assert standard("detected:buoy")(HERE) is False
    assert standard("detected:buoy")(replace(HERE, detected=frozenset({"buoy"}))) is True


@pytest.mark.parametrize("answer", [True, False])
def test_a_question_is_undecided_until_it_is_answered(answer):
    condition = standard("answer:go on: now?")
    assert condition(replace(HERE, answers={"another": True})) is None
    assert condition(replace(HERE, answers={"go on: now?": answer})) is answer


@pytest.mark.parametrize(
    "identifier",
    [
        "calm",
        "battery-below",
        "battery-below:",
        "battery-below:low",
        "wind-above:nan",
        "answer:",
        "Wind-above:8",
    ],
)
def test_other_identifiers_ask_for_no_standard_condition(identifier):
    assert not is_standard(identifier)
    with pytest.raises(ValueError, match="no standard condition"):
        standard(identifier)


def test_only_answers_ask_a_question():
    assert [question_of(name) for name in ("answer:go on?", "calm", "wind-above:8")] == ["go on?", "", ""]


@pytest.mark.parametrize(
    ("message", "names"),
    [
        (mavlink.MAVLink_statustext_message(6, b"Detected buoy 7"), {"buoy 7"}),
        (mavlink.MAVLink_statustext_message(6, b"buoy detected"), set()),
        (mavlink.MAVLink_named_value_float_message(0, b"leak", 1.0), {"leak"}),
        (mavlink.MAVLink_named_value_int_message(0, b"leak", 0), set()),
    ],
)
def test_a_vehicle_tells_by_texts_and_values_what_it_detected(message, names):
    detections = Detections()
    detections(message, False)
    assert detections.names == names


def test_what_is_sent_detects_nothing():
    detections = Detections()
    detections(mavlink.MAVLink_statustext_message(6, b"detected us"), True)
    assert detections.names == set()
