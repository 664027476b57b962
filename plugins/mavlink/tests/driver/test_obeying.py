"""When each kind of vehicle is seen to carry out a response."""

from contextlib import contextmanager

import pytest
from flight_crew import HOME, NORTH, robot_of
from mavlink_peer import ARDUPILOT, PX4, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import PROFILES, profile_for
from mmrs_mavlink.steps.obeying import obeying, undone
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle

NUMBERS = {
    (each.vehicle, each.autopilot.number): {name: mode.number for name, mode in each.modes.items()}
    for each in PROFILES.values()
}


@contextmanager
def vehicle_of(kind: str, autopilot: int = ARDUPILOT):
    """Give a vehicle that stands at home with its motors on, and a function by which it shows a mode."""
    with linked(autopilot=autopilot) as (link, wire):
        numbers = NUMBERS[kind, autopilot]

        def show(mode: str, *, armed: bool = True) -> None:
            before = link.clock.now()
            wire.beat(autopilot=autopilot, mode=numbers[mode], armed=armed)
            eventually(lambda: link.clock.now() - link.since("HEARTBEAT") > before)

        vehicle = MavlinkVehicle(link, profile_for(kind), HOME)
        at = (round(HOME.latitude * 1e7), round(HOME.longitude * 1e7), 720_000, 0)
        wire.say(mavlink.MAVLink_global_position_int_message(1, *at, 0, 0, 0, 36_000))
        eventually(lambda: link.latest("GLOBAL_POSITION_INT"))
        show("guided")
        yield vehicle, show


@pytest.mark.parametrize(
    ("kind", "response", "before", "then"),
    [
        ("copter", "LAND", ("hold", "guided"), "land"),
        ("copter", "HOLD", ("land", "guided", "auto"), "hold"),
        ("copter", "SURFACE", ("land", "guided"), "hold"),
        ("copter", "RETURN", ("hold", "guided"), "land"),
        ("sub", "LAND", ("hold", "guided"), "surface"),
        ("sub", "SURFACE", ("hold", "guided"), "surface"),
        ("sub", "HOLD", ("surface", "guided"), "hold"),
        ("sub", "RETURN", ("surface", "guided"), "hold"),
        ("rover", "LAND", ("guided", "auto"), "hold"),
        ("rover", "HOLD", ("guided", "auto"), "hold"),
        ("rover", "RETURN", ("guided", "auto"), "hold"),
    ],
)
@pytest.mark.parametrize("autopilot", [ARDUPILOT, PX4])
def test_a_response_is_shown_by_the_mode_that_it_ends_in_and_by_no_other(
    kind, response, before, then, autopilot
):
    numbers = NUMBERS[kind, autopilot]
    then = then if then in numbers else "hold"
    with vehicle_of(kind, autopilot) as (vehicle, show):
        seen = obeying(response, robot_of(vehicle=kind), vehicle, ())
        assert not seen()
        for mode in before:
            if mode in numbers and mode != then:
                show(mode)
                assert not seen(), mode
        show(then)
        assert seen()


def test_a_stop_of_the_motors_is_shown_by_nothing_else():
    with vehicle_of("copter") as (vehicle, show):
        show("land", armed=False)
        seen = obeying("STOP_THRUST", robot_of(), vehicle, ())
        assert not seen(), "what was shown before proves nothing"
        show("hold")
        assert not seen()
        show("hold", armed=False)
        assert seen()


@pytest.mark.parametrize(("near", "why"), [(25.0, ""), (20.0, "it stands 22 m from its home")])
def test_who_stands_too_far_from_home_has_not_returned(near, why):
    with vehicle_of("copter") as (vehicle, show):
        show("land", armed=False)
        assert undone("RETURN", robot_of(home=NORTH), vehicle, near) == why
        assert undone("LAND", robot_of(home=NORTH), vehicle, near) == ""
