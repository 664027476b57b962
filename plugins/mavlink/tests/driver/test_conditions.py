from dataclasses import replace

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.program import Geographic, Local
from mmrs_mavlink.vehicles.detections import Detections
from mmrs_runtime.conditions import is_standard, question_of, standard
from mmrs_runtime.controllers.state import State

GEOGRAPHIC = Geographic(42.0, 13.0, 20.0)
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


def text(words):
    return mavlink.MAVLink_statustext_message(6, words.encode())


@pytest.mark.parametrize(
    ("words", "name", "place"),
    [
        ("detected buoy 7", "buoy 7", GEOGRAPHIC),
        ("detected buoy at 42.5,-13.25", "buoy", Geographic(42.5, -13.25, 0.0)),
        ("detected buoy at 92.5,13.25", "buoy at 92.5,13.25", GEOGRAPHIC),
        ("detected man at sea", "man at sea", GEOGRAPHIC),
    ],
)
def test_what_was_detected_is_where_the_vehicle_says_or_was(words, name, place):
    detections = Detections(lambda: GEOGRAPHIC)
    detections(text(words), False)
    assert detections.places == {name: place}


def test_a_vehicle_without_a_place_on_earth_detects_where_it_is():
    detections = Detections(lambda: HERE.place)
    detections(text("detected buoy at 42.5,13.25"), False)
    assert detections.places == {"buoy": HERE.place}


def test_what_notifies_told_was_found():
    assert standard("found:buoy")(HERE) is False
    assert standard("found:buoy")(replace(HERE, found=frozenset({"buoy"}))) is True
