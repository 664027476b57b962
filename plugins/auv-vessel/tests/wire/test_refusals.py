"""What no bus can be made of is refused before anything is generated, all of it, each with its place."""

import json
from math import inf, nan

import pytest
from vessel_sheets import sheet, thruster

from auv_vessel import refusals
from auv_vessel.refusals import SheetError
from auv_vessel.sheet import from_json, to_json
from auv_vessel.wire.catalogue import messages_of
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.database import database_of, dbc_of


def refused(**changes: object) -> tuple[str, ...]:
    with pytest.raises(SheetError) as caught:
        dbc_of(sheet(2, **changes))
    return caught.value.faults


def refused_thruster(**changes: object) -> str:
    (fault,) = refused(thrusters=(thruster(0), thruster(1, **changes)))
    return fault


@pytest.mark.parametrize(
    "what", ["operating_thrust", "max_thrust", "operating_power", "max_power", "max_depth"]
)
@pytest.mark.parametrize("value", [nan, inf, -inf, -1.0, "40", None, True])
def test_figures_of_thrusters_that_are_no_figures(what: str, value: object) -> None:
    assert refused_thruster(**{what: value}).startswith(f"thruster 1 ('T2'): {what}: {value!r} is ")


@pytest.mark.parametrize("what", ["operating_thrust", "max_thrust"])
def test_no_thrust(what: str) -> None:
    assert refused_thruster(**{what: 0.0}) == f"thruster 1 ('T2'): {what}: 0.0 is less than 0.01"


def test_more_than_messages_carry() -> None:
    assert "max_thrust: 40000.0 is more than 32767" in refused_thruster(max_thrust=40000.0)
    assert "max_power: 7000.0 is more than 6553.5" in refused_thruster(max_power=7000.0)


def test_operating_thrust_above_peak_thrust() -> None:
    assert (
        refused_thruster(operating_thrust=60.0)
        == "thruster 1 ('T2'): operating_thrust: 60.0 is more than max_thrust"
    )


@pytest.mark.parametrize("direction", [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (nan, 0.0, 1.0), (1.0, 0.0), "xyz"])
def test_directions_that_are_none(direction: object) -> None:
    assert refused_thruster(direction=direction).startswith("thruster 1 ('T2'): direction")


@pytest.mark.parametrize("name", ["", "  ", 'a"b', "a\nb", "a\\b", "a\0b", "\ud800", "x" * 65, "a\u2028b", 7])
def test_odd_names(name: object) -> None:
    assert refused_thruster(id=name).startswith(f"thruster 1 ({name!r}): id: {name!r}")
    assert refused(robot=name)[0].startswith(f"robot: {name!r}")
    assert refused(devices=("torpedo", name))[0].startswith(f"device 1: {name!r}")


def test_names_that_are_there_twice() -> None:
    assert refused(thrusters=(thruster(0), thruster(0))) == ("thrusters: 'T1' is there 2 times",)
    assert refused(devices=("arm", "eye", "arm")) == ("devices: 'arm' is there 2 times",)


def test_more_thrusters_than_identifiers() -> None:
    many = tuple(thruster(number) for number in range(33))
    assert refused(thrusters=many) == ("thrusters: 33, there are identifiers for 32",)
    Codec(sheet(32))


@pytest.mark.parametrize(
    "what",
    [
        "length",
        "width",
        "height",
        "mass",
        "water_density",
        "battery",
        "speed",
        "max_depth",
        "bit_rate",
        "watchdog",
    ],
)
@pytest.mark.parametrize("value", [nan, inf, 10**400, 0.0, -1.0, "1", None])
def test_figures_of_the_hull_that_are_no_figures(what: str, value: object) -> None:
    (fault,) = refused(**{what: value})
    assert fault.startswith(f"{what}: {value!r}")


def test_places_out_of_reach() -> None:
    assert refused(home=(0.0, 9000.0, 0.0)) == (
        "home[1]: 9000.0 is more than 8388.607, the most that there is room for",
    )


@pytest.mark.parametrize(
    ("what", "value"),
    [("length", 1e-300), ("height", 1e300), ("mass", 1e308), ("water_density", 1e5), ("bit_rate", 1)],
)
def test_figures_that_no_vehicle_has(what: str, value: float) -> None:
    (fault,) = refused(**{what: value})
    assert fault.startswith(f"{what}: {value!r} is ")


@pytest.mark.parametrize("what", ["weight_in_water", "drop_weight"])
def test_weights_that_leave_nothing_of_the_vehicle(what: str) -> None:
    assert refused(mass=19.0, **{what: 19.0}) == (f"{what}: 19.0 is not below the mass, 19.0",)


@pytest.mark.parametrize("key", ["search.spacing", "turn.rate"])
def test_further_figures_that_have_to_be_above_0(key: str) -> None:
    assert refused(extra={key: 0.0}) == (f"extra {key!r}: 0.0 is not above 0",)
    assert refused(extra={"log.noise": 1e300})[0].startswith("extra 'log.noise': 1e+300 is more than ")


@pytest.mark.parametrize("extra", [[1], "x", None])
def test_a_file_whose_further_figures_are_none(extra: object) -> None:
    text = json.dumps({**json.loads(to_json(sheet())), "extra": extra})
    with pytest.raises(ValueError, match="no sheet of a vehicle"):
        from_json(text)


def test_all_that_is_wrong_is_told_at_once() -> None:
    wrong = (thruster(0, max_thrust=nan), thruster(0, id="T1", direction=(0.0, 0.0, 0.0)))
    assert [fault.partition(":")[0] for fault in refused(thrusters=wrong, mass=-1.0)] == [
        "mass", "thruster 0 ('T1')", "thruster 1 ('T1')", "thrusters",
    ]  # fmt: skip


@pytest.mark.parametrize("make", [messages_of, database_of, dbc_of, Codec])
def test_nothing_is_made_of_it(make: type) -> None:
    with pytest.raises(SheetError, match="mass: nan is not a finite number"):
        make(sheet(mass=nan))


def test_limits_are_what_the_fields_hold() -> None:
    fields = {
        f"{message.name}.{field.name}": field.high
        for message in messages_of(sheet())
        for field in message.fields
    }
    assert fields["Thruster0Status.Power"] == pytest.approx(refusals.MOST_POWER)
    assert fields["Depth.Depth"] == pytest.approx(refusals.MOST_DEPTH)
    assert fields["GoalPose.Speed"] == pytest.approx(refusals.MOST_SPEED)
    assert fields["Position.North"] == pytest.approx(refusals.MOST_PLACE)
    assert fields["DeviceCommand.Device"] == refusals.MOST_DEVICES - 1
