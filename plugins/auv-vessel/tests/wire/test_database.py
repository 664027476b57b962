"""The DBC of a vehicle says to other tools what our codec does."""

from pathlib import Path
from typing import Any

import cantools
import pytest
from cantools.database import Database
from counts import many
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from vessel_sheets import sheet, sheets, thruster

from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import CHECK, NODES, SEQUENCE, messages_of
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.database import WATCHDOG, database_of, dbc_of


def loaded(vehicle: Sheet) -> Database:
    return cantools.database.load_string(dbc_of(vehicle), "dbc")


@given(sheets())
@settings(max_examples=many(50, fast=3), deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_the_text_loads_to_the_same_database(vehicle: Sheet) -> None:
    found, own = loaded(vehicle), database_of(vehicle)
    assert [shown(message) for message in found.messages] == [shown(message) for message in own.messages]
    assert found.version == own.version
    assert [node.name for node in found.nodes] == list(NODES)
    assert found.buses[0].baudrate == vehicle.bit_rate
    assert dbc_of(vehicle) == found.as_dbc_string().replace("\r\n", "\n")


def shown(message: Any) -> tuple[Any, ...]:
    return (
        message.frame_id, message.name, message.length, message.comment, message.cycle_time,
        sorted(message.senders),
        {name: each.value for name, each in message.dbc.attributes.items() if name == WATCHDOG},
        [
            (each.name, each.start, each.length, each.is_signed, each.byte_order, each.scale, each.offset,
             each.minimum, each.maximum, each.unit, each.choices, each.comment, sorted(each.receivers))
            for each in message.signals
        ],
    )  # fmt: skip


@given(sheets(), st.data())
@settings(max_examples=many(100, fast=5), deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_cantools_reads_the_same_values_by_the_file(vehicle: Sheet, data: st.DataObject) -> None:
    codec, database = Codec(vehicle), loaded(vehicle)
    message = data.draw(st.sampled_from(messages_of(vehicle)))
    values = {
        field.name: data.draw(
            st.sampled_from(field.names) if field.names else st.floats(field.low, field.high)
        )
        for field in message.fields
    }
    frame = codec.encode(message.name, **values)
    heard, read = codec.decode(frame), dict(database.decode_message(frame.id, frame.data))
    assert heard is not None
    assert read.pop(SEQUENCE, None) == heard.sequence
    read.pop(CHECK, None)
    assert {
        name: str(value) if isinstance(heard.values[name], str) else value for name, value in read.items()
    } == {
        name: pytest.approx(value) if isinstance(value, float) else value
        for name, value in heard.values.items()
    }
    for field in message.fields:
        signal = database.get_message_by_name(message.name).get_signal_by_name(field.name)
        assert signal.minimum <= field.low + field.scale
        assert field.names or signal.maximum == pytest.approx(field.high, abs=field.scale)


def test_cycle_times_and_the_watchdog_are_in_milliseconds() -> None:
    database = loaded(sheet(watchdog=0.4))
    command, status = (database.get_message_by_name(f"Thruster2{each}") for each in ("Command", "Status"))
    assert (command.cycle_time, status.cycle_time) == (50, 100)
    assert command.dbc.attributes[WATCHDOG].value == 400
    assert WATCHDOG not in status.dbc.attributes
    assert database.get_message_by_name("DecisionEmergency").cycle_time is None
    assert database.get_message_by_name("VehicleBeat").cycle_time == 500


def test_bits_are_where_they_are_documented() -> None:
    command = loaded(sheet()).get_message_by_name("Thruster0Command")
    assert {each.name: (each.start, each.length) for each in command.signals} == {
        "Thrust": (0, 16), "Enable": (16, 1), SEQUENCE: (24, 8), CHECK: (32, 8),
    }  # fmt: skip
    assert command.length == 5


def test_ranges_come_from_peak_thrust() -> None:
    database = loaded(sheet(thrusters=(thruster(0, max_thrust=85.3), thruster(1, max_thrust=50.0))))
    first, second = (
        database.get_message_by_name(f"Thruster{each}Command").get_signal_by_name("Thrust") for each in (0, 1)
    )
    assert (first.scale, first.minimum, first.maximum) == (0.003, -85.299, 85.299)
    assert (second.scale, second.minimum, second.maximum) == (0.002, -50.0, 50.0)


def test_a_wrench_holds_all_that_thrusters_give() -> None:
    strong = [
        thruster(number, direction=direction, position=(2.0, 1.0, 0.0), max_thrust=2000.0)
        for number, direction in enumerate(
            ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
        )
    ]
    usual, great = (
        {
            f"{name}.{each.name}": each.maximum
            for name in ("WrenchForce", "WrenchMoment")
            for each in loaded(vehicle).get_message_by_name(name).signals
        }
        for vehicle in (sheet(), sheet(thrusters=tuple(strong)))
    )
    assert usual["WrenchForce.Surge"] == 655.34
    assert great["WrenchForce.Surge"] >= 4000.0
    assert great["WrenchForce.Heave"] >= 2000.0
    assert great["WrenchMoment.Pitch"] >= 4000.0
    assert great["WrenchMoment.Yaw"] >= 8000.0


def test_named_values_have_their_names_in_value_tables() -> None:
    reason = loaded(sheet()).get_message_by_name("DecisionEmergency").get_signal_by_name("Reason")
    assert reason.choices is not None
    assert str(reason.choices[4]) == "LEAK"


def test_comments_say_which_thruster_it_is_in_ascii() -> None:
    text = dbc_of(sheet(thrusters=(thruster(0, id="aft 水"),)))
    assert 'CM_ BO_ 256 "thruster aft \\u6c34";' in text
    assert text.isascii()


def test_identifiers_stay_when_thrusters_are_added() -> None:
    few, many = (
        {message.name: message.frame_id for message in loaded(sheet(count)).messages} for count in (4, 32)
    )
    assert few.items() <= many.items()


def test_a_file_of_it_loads_as_any_other(tmp_path: Path) -> None:
    path = tmp_path / "sub1.dbc"
    path.write_text(dbc_of(sheet()), encoding="ascii")
    assert cantools.database.load_file(path).get_message_by_name("Thruster5Status").frame_id == 0x145
