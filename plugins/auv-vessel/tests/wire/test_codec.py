"""Values come back as they were said, and nothing corrupted is believed."""

from itertools import combinations
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from vessel_sheets import sheet, sheets

from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import EMERGENCY_BASE, NODES, Field, Message, messages_of
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame, check_of

SHEET = sheet()
CODEC = Codec(SHEET)
MESSAGES = messages_of(SHEET)
GUARDED = [message for message in MESSAGES if message.guarded]


def value_of(field: Field) -> st.SearchStrategy[Any]:
    if field.names:
        return st.sampled_from(field.names)
    return st.booleans() if field.bits == 1 else st.floats(field.low, field.high)


def values_of(message: Message) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries({field.name: value_of(field) for field in message.fields})


@st.composite
def said(draw: st.DrawFn) -> tuple[Sheet, Message, dict[str, Any]]:
    vehicle = draw(sheets())
    message = draw(st.sampled_from(messages_of(vehicle)))
    return vehicle, message, draw(values_of(message))


def any_values(message: Message) -> dict[str, Any]:
    return {field.name: field.names[0] if field.names else field.high / 3 for field in message.fields}


@given(said())
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_values_come_back_to_the_nearest_step(saying: tuple[Sheet, Message, dict[str, Any]]) -> None:
    vehicle, message, values = saying
    codec = Codec(vehicle)
    found = codec.decode(codec.encode(message.name, **values))
    assert found is not None
    assert found.name == message.name
    for field in message.fields:
        expected = values[field.name]
        if field.names or field.bits == 1:
            assert found.values[field.name] == expected
        else:
            assert found.values[field.name] == pytest.approx(expected, abs=field.scale, rel=1e-12)
    assert not codec.faults


@given(st.data())
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_what_was_heard_is_said_again_in_the_same_bytes(data: st.DataObject) -> None:
    message = data.draw(st.sampled_from(MESSAGES))
    values = data.draw(values_of(message))
    frame = CODEC.encode(message.name, **values)
    heard = CODEC.decode(frame)
    assert heard is not None
    again = CODEC.encode(message.name, **heard.values)
    assert (
        again.data[: len(again.data) - 2 * message.guarded]
        == frame.data[: len(frame.data) - 2 * message.guarded]
    )


@pytest.mark.parametrize("message", GUARDED, ids=lambda message: message.name)
def test_every_wrong_bit_and_every_two_wrong_bits_are_noticed(message: Message) -> None:
    codec = Codec(SHEET)
    frame = codec.encode(message.name, **(any_values(message) | _flags(message)))
    number, bits = int.from_bytes(frame.data, "little"), len(frame.data) * 8
    wrong = [1 << bit for bit in range(bits)] + [1 << a | 1 << b for a, b in combinations(range(bits), 2)]
    for mask in wrong:
        data = (number ^ mask).to_bytes(len(frame.data), "little")
        assert codec.decode(Frame(frame.id, data)) is None
    assert codec.faults == {message.name: len(wrong)}


@pytest.mark.parametrize("message", GUARDED, ids=lambda message: message.name)
def test_one_message_is_not_taken_for_another(message: Message) -> None:
    codec = Codec(SHEET)
    data = codec.encode(message.name, **(any_values(message) | _flags(message))).data
    others = [1 << bit for bit in range(11)] + [1 << a | 1 << b for a, b in combinations(range(11), 2)]
    guarded = {other.id for other in GUARDED}
    wrong = [Frame(message.id ^ mask, data) for mask in others if message.id ^ mask in guarded]
    assert [codec.decode(frame) for frame in wrong] == [None] * len(wrong)


def _flags(message: Message) -> dict[str, Any]:
    return {field.name: True for field in message.fields if field.bits == 1}


@given(st.binary(max_size=8), st.sampled_from(MESSAGES))
@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_anything_at_all_is_heard_without_an_error(data: bytes, message: Message) -> None:
    CODEC.decode(Frame(message.id, data))
    assert CODEC.decode(Frame(message.id, data, extended=True)) is None


def test_other_identifiers_and_extended_ones_are_none_of_this_bus() -> None:
    codec = Codec(SHEET)
    frame = codec.encode("VehicleEmergency", Reason="LEAK", Release=True)
    assert codec.decode(Frame(0x7FF, frame.data)) is None
    assert codec.decode(Frame(EMERGENCY_BASE, frame.data, extended=True)) is None
    assert not codec.faults


@pytest.mark.parametrize("length", [0, 4, 5, 8])
def test_a_clock_of_another_length_is_refused(length: int) -> None:
    codec = Codec(SHEET)
    assert codec.decode(Frame(0x001, bytes(length))) is None
    assert codec.faults == {"Clock": 1}


def test_a_number_that_nothing_stands_for_is_refused_though_its_check_is_right() -> None:
    codec = Codec(SHEET)
    said = bytes((200, 0, 7))
    assert codec.decode(Frame(EMERGENCY_BASE, said + bytes((check_of(EMERGENCY_BASE, said),)))) is None
    assert codec.faults == {"VehicleEmergency": 1}


def test_more_thrust_than_there_is_is_refused_though_its_check_is_right() -> None:
    codec = Codec(SHEET)
    said = (25001).to_bytes(2, "little", signed=True) + bytes((1, 7))  # 50.002 N at 0.002 N a step
    assert codec.decode(Frame(0x100, said + bytes((check_of(0x100, said),)))) is None
    assert codec.faults == {"Thruster0Command": 1}


def test_counters_go_on_for_each_message_by_itself_and_begin_again() -> None:
    codec = Codec(SHEET)
    heard = [codec.decode(codec.encode("Position", North=1.0, East=2.0)) for _ in range(258)]
    assert [each.sequence for each in heard if each] == [*range(256), 0, 1]
    other = codec.decode(codec.encode("Fix", North=1.0, East=2.0))
    assert other is not None
    assert other.sequence == 0


def test_halves_are_rounded_away_from_zero() -> None:
    codec = Codec(SHEET)
    frame = codec.encode("DeviceCommand", Device=2.5, Action=0.5, Parameter=-0.0005, Request=1.5)
    assert frame.data[:6] == bytes((3, 1, 0xFF, 0xFF, 0xFF, 2))


@pytest.mark.parametrize("length", range(3, 9))
def test_of_three_wrong_bits_no_more_go_unnoticed_than_is_said(length: int) -> None:
    """The check is linear: what a wrong bit changes of it depends on neither the others nor the data."""
    none = check_of(0, bytes(length - 1))
    of_data = [
        check_of(0, (1 << bit).to_bytes(length - 1, "little")) ^ none for bit in range(8 * (length - 1))
    ]
    of_data += [1 << bit for bit in range(8)]
    of_id = [check_of(1 << bit, bytes(length - 1)) ^ none for bit in range(11)]
    for changes, least in ((of_data, 1 / 196), (of_data + of_id, 1 / 192)):
        unnoticed = [a ^ b == c for a, b, c in combinations(changes, 3)]
        assert 0.0 < sum(unnoticed) / len(unnoticed) < least


def test_the_check_is_that_of_the_standard() -> None:
    """CRC-8 SAE J1850 of the digits 1 to 9 is 0x4B."""
    text = b"123456789"
    assert check_of(int.from_bytes(text[:2], "little"), text[2:]) == 0x4B


@pytest.mark.parametrize(
    ("name", "values", "said"),
    [
        (
            "Thruster0Command",
            {"Thrust": 50.001, "Enable": True},
            "Thruster0Command.Thrust: 50.001: expected -50 to 50 N",
        ),
        ("Thruster0Command", {"Thrust": float("nan"), "Enable": True}, "Thruster0Command.Thrust: nan"),
        ("Thruster0Command", {"Thrust": float("-inf"), "Enable": True}, "Thruster0Command.Thrust: -inf"),
        ("Thruster0Command", {"Thrust": 1.0, "Enable": 2}, "Thruster0Command.Enable: 2: expected 0 to 1"),
        ("Thruster0Command", {"Thrust": "1", "Enable": True}, "Thruster0Command.Thrust: '1'"),
        ("Thruster0Command", {"Thrust": 1.0}, "Thruster0Command: Enable is missing"),
        ("Thruster0Command", {"Thrust": 1.0, "Enable": True, "Trust": 1}, "there is no field Trust"),
        ("Thruster9Command", {"Thrust": 1.0, "Enable": True}, "there is no message 'Thruster9Command'"),
        (
            "VehicleEmergency",
            {"Reason": "BORED", "Release": True},
            "VehicleEmergency.Reason: 'BORED': expected one of NONE, ",
        ),
        (
            "VehicleEmergency",
            {"Reason": 4, "Release": True},
            "VehicleEmergency.Reason: 4: expected one of NONE, ",
        ),
        ("Clock", {"Time": -0.001}, "Clock.Time: -0.001: expected 0 to "),
    ],
)
def test_what_cannot_be_said_is_refused_with_its_place(name: str, values: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said.replace("(", "\\(")):
        Codec(SHEET).encode(name, **values)


def test_a_refused_message_leaves_no_gap_in_the_counter() -> None:
    codec = Codec(SHEET)
    with pytest.raises(ValueError, match="North"):
        codec.encode("Fix", North=1e9, East=0.0)
    heard = codec.decode(codec.encode("Fix", North=0.0, East=0.0))
    assert heard is not None
    assert heard.sequence == 0


def test_what_is_only_checked_is_refused_alike_and_counts_for_nothing() -> None:
    codec = Codec(SHEET)
    codec.check("Fix", North=1.0, East=2.0)
    with pytest.raises(ValueError, match=r"Fix\.North"):
        codec.check("Fix", North=1e9, East=2.0)
    with pytest.raises(ValueError, match="no message"):
        codec.check("Fixx", North=1.0, East=2.0)
    heard = codec.decode(codec.encode("Fix", North=0.0, East=0.0))
    assert heard is not None
    assert heard.sequence == 0


def test_every_node_has_a_heartbeat() -> None:
    codec = Codec(SHEET)
    for node in NODES:
        heard = codec.decode(codec.encode(f"{node}Beat", State="RUNS", Uptime=12.5, Reason="NONE"))
        assert heard is not None
        assert heard.values == {"State": "RUNS", "Uptime": 12.5, "Reason": "NONE"}


@pytest.mark.parametrize(
    ("most", "step"), [(50.0, 0.01), (655.35, 0.01), (655.36, 0.02), (6000.0, 0.1), (8388.607, 0.13)]
)
def test_goals_are_told_down_to_the_vehicles_depth(most: float, step: float) -> None:
    codec = Codec(sheet(max_depth=most))
    goal = {"Heading": 0.0, "Speed": 1.0, "Mode": "GO_TO", "FaceAlong": True, "Goal": 3}
    for depth in (0.0, most / 3, most):
        heard = codec.decode(codec.encode("GoalPose", Depth=depth, **goal))
        assert heard is not None
        assert heard.values["Depth"] == pytest.approx(depth, abs=step / 2 + 1e-9)
