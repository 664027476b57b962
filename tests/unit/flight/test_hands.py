"""Who has a vehicle: the program, whatever its frames meet and the vehicle does by itself; or a pilot."""

from __future__ import annotations

import random

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from still_crew import robot_of, still
from virtual_link import Air

from mmrs_mavlink.program import Policy
from mmrs_mavlink.services.commands import ask
from mmrs_mavlink.vehicles.requests import Requests

KINDS = ("copter", "sub", "rover")
AIRS = (
    Air(),
    Air(delay=0.05, jitter=0.2),
    Air(loss=0.1, double=0.1, delay=0.05, jitter=0.3),
    Air(loss=0.2, double=0.2, delay=0.1, jitter=0.6),
    Air(double=0.3, delay=0.1, jitter=0.6),
)
LOSSLESS = [air for air in AIRS if not air.loss]
"""Where the only words of a failsafe are lost, nobody can tell it from a pilot."""

ORDERS = (
    ("return", "hold", "resume"),
    ("hold", "resume", "hold", "resume"),
    ("hold", "resume", "return", "hold", "resume"),
    ("return", "hold", "resume", "hold", "resume"),
    ("hold", "return", "hold", "resume", "land"),
)
ALONE = (
    (),
    (Policy("LINK_LOST", "HOLD"),),
    (Policy("LINK_LOST", "CONTINUE"),),
    (Policy("LINK_LOST", "RETURN", 3.0),),
)
STICKS = {
    "copter": ("loiter", "alt_hold", "stabilize", "return"),
    "sub": ("manual", "alt_hold", "stabilize"),
    "rover": ("loiter", "manual", "stabilize", "return"),
}
"""What pilots choose, and programs never ask for."""


def order_at_random(made, chance: random.Random, begun: float) -> float:
    """Have things ordered one after the other, and, whatever was ordered, the robot go on; return when."""
    for name in chance.choice(ORDERS):
        made.order(name, begun)
        begun += chance.uniform(0.0, chance.choice((1.0, 4.0, 12.0)))
    for _ in range(2):
        begun += 60.0
        made.order("resume", begun)
    made.order("land", begun + 60.0)
    return begun


def stall_at_random(world, chance: random.Random) -> None:
    """Have either side, or both, stand still at times, and be slow after that to read what has come."""

    def stall() -> None:
        which, end = chance.randrange(1, 4), world.clock.time + chance.uniform(0.3, 4.0)
        if which & 1:
            world.ours, world.most = end, chance.choice((1, 3, 1000))
            world.at(end + chance.uniform(0.1, 1.0), lambda: setattr(world, "most", 1000))
        if which & 2:
            world.its = end

    for _ in range(chance.choice((0, 3, 8))):
        world.at(chance.uniform(4.0, 60.0), stall)


def when_it_moves(world, do) -> None:
    """Have something done once the vehicle is on its way."""

    def look() -> None:
        pilot = world.vehicle.autopilot
        if pilot.armed and (pilot.airborne or not pilot.flies):
            do()
        else:
            world.at(world.clock.time + 1.0, look)

    look()


def fly_without_a_pilot(folder, kind: str, seed: int, airs=AIRS) -> None:
    chance = random.Random(seed)
    robot = robot_of(kind, *chance.choice(ALONE))
    with still(folder, robot, chance.choice(airs), seed) as made:
        order_at_random(made, chance, chance.uniform(4.0, 30.0))
        stall_at_random(made.world, chance)
        made.fly()
        assert not made.says("taken over"), made.said


def fly_until_a_pilot_comes(folder, kind: str, seed: int) -> None:
    chance = random.Random(seed)
    with still(folder, robot_of(kind), chance.choice(AIRS), seed) as made:
        world, vehicle = made.world, made.world.vehicle
        stick, wait, ahead = chance.choice(STICKS[kind]), chance.uniform(0.0, 25.0), chance.uniform(0.0, 12.0)
        number, taken = vehicle.autopilot.numbers[stick], []

        def take() -> None:
            vehicle.faults.take_stick(stick)
            taken.append(world.clock.time)
            world.at(world.clock.time + 40.0, vehicle.autopilot.disarm)

        def begin() -> None:
            order_at_random(made, chance, world.clock.time + max(0.0, wait - ahead))
            world.at(world.clock.time + wait, take)

        when_it_moves(world, begin)
        made.fly()
        heard = [time for time, mode in world.shown if taken and time >= taken[0] and mode == number]
        if not heard:
            return
        assert not [each for each in world.told if each[0] > heard[0]], made.said
        assert made.says("taken over"), made.said


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(6))
def test_what_is_late_or_doubled_or_done_by_the_vehicle_itself_is_no_pilots(tmp_path, kind, seed):
    fly_without_a_pilot(tmp_path, kind, seed)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(6))
def test_a_vehicle_that_a_pilot_takes_is_told_nothing_any_more(tmp_path, kind, seed):
    fly_until_a_pilot_comes(tmp_path, kind, seed)


@pytest.mark.parametrize(("kind", "stick"), [("copter", "loiter"), ("sub", "alt_hold"), ("rover", "loiter")])
def test_a_pilot_is_noticed_whom_a_mode_that_was_on_its_way_has_overtaken(tmp_path, kind, stick):
    """Both heartbeats come while the program stands still, so that it sees the second mode only."""
    with still(tmp_path, robot_of(kind), Air(delay=0.2)) as made:
        world, vehicle = made.world, made.world.vehicle

        def order() -> None:
            made.order("hold", world.clock.time)
            world.at(world.clock.time + 0.1, take)

        def take() -> None:
            world.ours = world.clock.time + 0.8
            vehicle.faults.take_stick(stick)
            world.at(world.clock.time + 40.0, vehicle.autopilot.disarm)

        world.at(20.0, lambda: when_it_moves(world, order))
        made.fly()
        modes = [mode for _, mode in vehicle.autopilot.modes]
        after = modes[modes.index(vehicle.autopilot.numbers[stick]) + 1 :]
        assert after
        assert vehicle.autopilot.numbers[stick] not in [mode for _, mode in world.shown]
        assert made.says("taken over"), made.said


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.thorough
def test_what_is_late_is_no_pilots_and_a_pilot_is_left_alone(tmp_path, kind):
    for seed in range(100, 250):
        fly_without_a_pilot(tmp_path / f"{seed}", kind, seed, LOSSLESS)
        fly_until_a_pilot_comes(tmp_path / f"{seed}-pilot", kind, seed)


def test_an_order_that_comes_as_the_vehicles_own_failsafe_is_answered_finds_no_pilot(tmp_path):
    fly_without_a_pilot(tmp_path, "sub", 240, LOSSLESS)


@pytest.mark.parametrize("words", ["GCS Failsafe", "MYGCS: 255, heartbeat lost"])
def test_a_submarine_that_misses_us_while_it_is_told_to_hold_is_no_pilots(tmp_path, words):
    with still(tmp_path, robot_of("sub", Policy("LINK_LOST", "HOLD")), Air(delay=0.3)) as made:
        pilot, second = made.world.vehicle.autopilot, 20.0

        def miss_us() -> None:
            pilot.say(4, words)
            pilot.enter("alt_hold")

        made.order("hold", second)
        made.world.at(second + 0.15, miss_us)
        made.order("land", second + 30.0)
        made.fly()
        assert made.says("LINK_LOST")
        assert not made.says("taken over"), made.said


def test_every_copy_of_a_request_counts_and_stays_the_programs_until_the_vehicle_is_back(tmp_path):
    hold = 17
    with still(tmp_path, robot_of("copter")) as made:
        link = made.crew.link
        requests = Requests(link)

        def ask_again_after(seconds: float) -> None:
            link.wait(lambda: None, seconds)
            ask(link, mavlink.MAV_CMD_DO_SET_MODE, 1.0, float(hold))

        ask_again_after(0.0)
        ask_again_after(3.0)
        requests.shows(9)
        link.wait(lambda: None, 1.0)
        assert requests.own(hold)
        link.wait(lambda: None, 1.0)
        assert requests.own(hold)
        requests.is_back()
        assert not requests.own(hold)
