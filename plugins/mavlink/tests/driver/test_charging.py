"""Charging: until the battery is full, or an operator confirms its change."""

import pytest
from flight_crew import HOME
from mavlink_peer import acknowledged, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.driving.charging import Charging
from mmrs_mavlink.profiles import profile_for
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_mavlink.vehicles.vehicle import Vehicle
from mmrs_runtime.controllers.state import State
from mmrs_runtime.faults import FaultError


class HandClock:
    """A clock that goes on only where something waits."""

    def __init__(self) -> None:
        self.time = 0.0

    def now(self) -> float:
        return self.time


class AtCharger(Vehicle):
    """A vehicle that gains a part of its charge in each second, and may refuse to count a new battery."""

    def __init__(self, clock: HandClock, energy: float | None, gain: float = 0.0, refusal: str = "") -> None:
        self.clock, self.energy, self.gain, self.refusal = clock, energy, gain, refusal
        self.at = {}

    def rest(self, seconds: float) -> None:
        self.clock.time += seconds
        self.energy = None if self.energy is None else min(1.0, self.energy + self.gain * seconds)
        for time in [each for each in self.at if each <= self.clock.time]:
            self.at.pop(time)()

    def renew_battery(self) -> str:
        self.energy = 1.0 if not self.refusal else self.energy
        return self.refusal

    def state(self) -> State:
        return State(self.clock.time, HOME, 0.0, 0.0, self.energy)


def charging(energy: float | None, gain: float = 0.0, *, seconds: float = 100.0, refusal: str = ""):
    clock, said = HandClock(), []
    vehicle = AtCharger(clock, energy, gain, refusal)
    return Charging(vehicle, clock, seconds, said.append), vehicle, said


def test_a_battery_that_gets_full_in_time_ends_it_without_a_word():
    stay, vehicle, said = charging(0.3, 0.01)
    stay.stay()
    assert (vehicle.clock.time, stay.is_over, said) == (100.0, True, [])


def test_a_battery_that_is_full_at_once_stays_for_the_whole_time():
    stay, vehicle, _ = charging(1.0)
    stay.stay()
    assert vehicle.clock.time == 100.0


def test_what_it_waits_for_is_said_and_again_every_minute():
    stay, _, said = charging(0.27, 0.001)
    with pytest.raises(FaultError, match="after 300 s of charging the battery is at 57%"):
        stay.stay()
    assert said[0] == (
        "waits for the battery: 37% of at least 99%, for 200 s at most;"
        " if it was changed, order battery-changed"
    )
    assert len([each for each in said if each.startswith("waits for")]) == 4


def test_a_charge_that_lasts_longer_than_checks_count_is_said_once():
    stay, _, said = charging(0.27, 0.005)
    stay.stay()
    assert [each for each in said if "than checks count" in each] == [
        "charges for longer than checks count, 120 s: robots that keep apart by time alone may meet"
    ]


def test_a_change_that_is_confirmed_as_the_battery_gets_full_is_answered():
    stay, _, _ = charging(1.0)
    stay.stay()
    answers = []
    stay.confirm(answers.append)
    assert answers == [""]


def test_a_change_that_is_confirmed_when_charging_has_failed_is_answered_with_that():
    stay, _, _ = charging(0.27, seconds=10.0, refusal="its vehicle still reports 27%")
    answers = []
    with pytest.raises(FaultError, match="after 30 s"):
        stay.stay()
    stay.confirm(answers.append)
    assert answers == ["it has stopped charging"]


@pytest.mark.parametrize("when", [10.0, 150.0])
def test_a_change_that_an_operator_confirms_ends_it(when):
    stay, vehicle, _ = charging(0.27)
    answers = []
    vehicle.at[when] = lambda: stay.confirm(answers.append)
    stay.stay()
    assert (vehicle.clock.time, answers) == (when, [""])


def test_a_change_that_the_vehicle_does_not_count_goes_on_waiting():
    stay, vehicle, _ = charging(0.27, refusal="its vehicle still reports 27%")
    answers = []
    vehicle.at[10.0] = lambda: stay.confirm(answers.append)
    with pytest.raises(FaultError, match="after 300 s"):
        stay.stay()
    assert answers == ["its vehicle still reports 27%"]


def test_a_battery_that_is_not_reported_is_charged_for_its_time():
    stay, vehicle, said = charging(None)
    stay.stay()
    assert (vehicle.clock.time, said) == (100.0, ["charged for 100 s; its range is unknown"])


def battery(left: int):
    return mavlink.MAVLink_sys_status_message(0, 0, 0, 0, 12_600, 0, left, 0, 0, 0, 0, 0, 0)


def renewed(left: int, *, result: int = 0, after: int = 100) -> tuple[str, list[tuple[int, float, float]]]:
    """Return why a vehicle with so much left does not count its battery as full, and its commands."""

    def answer(message):
        if message.get_type() == "COMMAND_LONG":
            yield acknowledged(message.command, result)
            if not result:
                yield battery(after)

    with linked(answer, speedup=20.0) as (link, wire):
        vehicle = MavlinkVehicle(link, profile_for("copter"), HOME)
        wire.say(battery(left))
        eventually(lambda: link.latest("SYS_STATUS"))
        why = vehicle.renew_battery()
        return why, [(each.command, each.param1, each.param2) for each in wire.of("COMMAND_LONG")]


def test_a_vehicle_that_integrates_its_current_counts_a_new_battery():
    assert renewed(27) == ("", [(42_651, 65_535.0, 100.0)])


def test_a_vehicle_with_a_full_battery_is_not_commanded():
    assert renewed(100) == ("", [])


@pytest.mark.parametrize(
    ("given", "why"),
    [
        (
            {"result": 3},
            "its vehicle still reports 27% (BATTERY_RESET: the vehicle answers 'unsupported'):"
            " restart it with its new battery",
        ),
        ({"after": 27}, "its vehicle still reports 27%: restart it with its new battery"),
    ],
)
def test_a_vehicle_that_counts_on_is_to_be_restarted(given, why):
    assert renewed(27, **given)[0] == why
