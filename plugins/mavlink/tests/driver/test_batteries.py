"""Batteries of a vehicle, compared with what its program takes before it takes off."""

import pytest
from flight_crew import robot_of
from mavlink_peer import eventually, linked, value
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.program import Charge
from mmrs_mavlink.vehicles.batteries import inspect_batteries
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle

TYPE = Charge(360_000.0, 20.0, least=300.0, most=400.0, longest=400.0)
"""100 Wh, which last 1000 s: the first sortie takes 30 to 40 Wh."""


def inspected(
    *,
    capacity: float = 5000.0,
    volts: float = 21.0,
    left: int = 100,
    at_start: bool = True,
    charge=TYPE,
    monitor: float | None = 4.0,
    second: int | None = None,
    sums: bool = False,
):
    """Return what is found of a battery, by default one of 5 Ah at 20 V, as that of the type."""
    parameters = {
        "BATT_CAPACITY": capacity,
        "BATT_MONITOR": monitor,
        "BATT2_CAPACITY": 3300.0,
        "BATT2_MONITOR": 10.0 if sums else 0.0 if second is None else 4.0,
    }

    def answer(message):
        if message.get_type() == "PARAM_REQUEST_READ" and parameters.get(message.param_id) is not None:
            yield value(message.param_id, parameters[message.param_id])
        elif message.get_type() == "PARAM_REQUEST_READ" and not message.param_id:
            yield value("ANOTHER", 0.0, index=message.param_index)

    robot = robot_of(charge=charge, endurance=1000.0, reserve=0.2)
    with linked(answer) as (link, wire):
        vehicle = MavlinkVehicle(link, robot.profile, robot.home)
        wire.say(
            mavlink.MAVLink_sys_status_message(0, 0, 0, 0, round(volts * 1e3), 0, left, 0, 0, 0, 0, 0, 0)
        )
        eventually(lambda: link.latest("SYS_STATUS"))
        if second is not None:
            volts_of_cells = [65_535] * 10
            wire.say(
                mavlink.MAVLink_battery_status_message(1, 0, 0, 0, volts_of_cells, -1, -1, -1, second, 0, 0)
            )
            eventually(lambda: link.latest("BATTERY_STATUS"))
        return inspect_batteries(link, vehicle.telemetry, robot, at_start=at_start)


def test_the_battery_of_the_type_suffices():
    found = inspected()
    assert not found.defects
    assert found.lines == [
        "battery: 100 Wh are left (100% of 5000 mAh at 20.0 V, BATT_CAPACITY);"
        " the first sortie takes up to 40 Wh"
    ]


def test_a_battery_whose_monitor_is_not_reported_counts():
    assert inspected(monitor=None).lines == inspected().lines


def test_of_two_batteries_neither_counts_as_fuller_than_the_emptier():
    (defect,) = inspected(second=10).defects
    assert "17 Wh are left (10% of 8300 mAh at 20.0 V, BATT_CAPACITY + BATT2_CAPACITY)" in defect
    assert not inspected(second=100).defects


def test_a_monitor_that_sums_others_is_no_second_battery():
    assert inspected(second=100, sums=True).lines == inspected().lines


def test_a_battery_that_is_too_small_is_a_defect_that_names_its_parameter():
    (defect,) = inspected(capacity=1500.0).defects
    assert defect == (
        "battery: 30 Wh are left (100% of 1500 mAh at 20.0 V, BATT_CAPACITY), and full batteries of its type"
        " hold 100 Wh; the first sortie takes up to 40 Wh, with a reserve of 20%"
    )


def test_a_battery_of_a_lower_voltage_holds_less():
    (defect,) = inspected(volts=10.0, capacity=3500.0).defects
    assert "35 Wh are left (100% of 3500 mAh at 10.0 V" in defect


def test_a_battery_that_is_not_charged_is_a_defect():
    (defect,) = inspected(left=45).defects
    assert "45 Wh are left (45% of 5000 mAh" in defect


def test_a_battery_that_may_not_suffice_is_told_with_a_warning():
    found = inspected(left=55)
    assert not found.defects
    assert found.lines[0].endswith("with a reserve of 20% (warning: it may not suffice)")


def test_a_later_sortie_that_takes_more_than_a_full_battery_is_told():
    found = inspected(charge=Charge(360_000.0, 20.0, 100.0, 100.0, 900.0))
    assert found.lines[-1] == (
        "battery: a sortie of the program takes up to 90 Wh (warning: a full battery holds 100 Wh, of which"
        " 20% is the reserve)"
    )


def test_a_sortie_without_a_bound_is_unknown():
    found = inspected(charge=Charge(360_000.0, 20.0, 300.0, None, None))
    assert not found.defects
    assert found.lines[0].endswith("the first sortie takes 30 Wh at least; unknown: how much at most")


def test_nothing_is_compared_in_the_midst_of_a_program():
    found = inspected(left=45, at_start=False)
    assert (found.defects, len(found.lines)) == ([], 1)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"left": -1}, "unknown: battery: the vehicle does not report how much of it is left"),
        (
            {"capacity": 0.0},
            "unknown: battery: 100% is left, and the vehicle does not report the capacity (BATT_CAPACITY)",
        ),
        (
            {"charge": None},
            "battery: 105 Wh are left (100% of 5000 mAh at 21.0 V, BATT_CAPACITY); unknown: what the program"
            " takes, which its robot type does not state",
        ),
    ],
)
def test_what_is_not_told_is_unknown_and_no_defect(given, words):
    found = inspected(**given)
    assert (found.defects, found.lines) == ([], [words])
