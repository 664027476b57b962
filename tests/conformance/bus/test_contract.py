"""What every bus keeps, whatever carries it and whatever happens to the robots."""

import time

import pytest

from mmrs_runtime.semantics import Outcome, entry, steps

pytestmark = pytest.mark.real_time("buses")


def check_success(fleet):
    result = fleet.replayed()
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_robots_hand_things_to_each_other_and_their_logs_replay(fleet):
    fleet = fleet("exchange")
    fleet.start("a")
    fleet.start("b")
    assert fleet.ended("a")
    assert fleet.ended("b")
    check_success(fleet)


def test_a_late_joiner_gets_what_it_was_told_before(fleet):
    fleet = fleet("gathering", 3)
    fleet.start("r0")
    fleet.start("r1")
    time.sleep(1.0)
    fleet.start("r2")
    assert all(fleet.ended(robot) for robot in fleet.names)
    check_success(fleet)


def test_a_late_joiner_is_told_by_those_who_are_there_who_has_ended_before_it_came(fleet):
    fleet = fleet("succession", 4)
    fleet.start("stays")
    fleet.start("early")
    time.sleep(1.5)
    fleet.start("other")
    assert fleet.ended("early")
    assert fleet.ended("other")
    fleet.start("late")
    assert fleet.ended("late")
    assert fleet.ended("stays")
    check_success(fleet)


@pytest.mark.parametrize("point", ["applied", "logged", "granted", "acknowledged"])
def test_a_robot_that_is_killed_and_started_again_goes_on_exactly(fleet, point):
    fleet = fleet("exchange", 4)
    number = notifies(fleet, "a")[2]
    fleet.start("a", *([f"{point}:{number}"] if point != "applied" else []))
    fleet.start("b", *([f"applied:{number}"] if point == "applied" else []))
    dead = "b" if point == "applied" else "a"
    assert not fleet.ended(dead)
    fleet.start(dead, again=True)
    assert fleet.ended("a")
    assert fleet.ended("b")
    check_success(fleet)


def test_a_robot_that_is_killed_at_any_moment_and_started_again_goes_on_exactly(fleet):
    fleet = fleet("exchange", 8)
    fleet.start("a", pause=0.01)
    fleet.start("b", pause=0.01)
    for robot, step in (("a", 8), ("b", 20), ("a", 30)):
        fleet.await_steps(robot, step)
        fleet.kill(robot)
        fleet.start(robot, again=True, pause=0.01)
    assert fleet.ended("a")
    assert fleet.ended("b")
    check_success(fleet)


def test_a_frozen_robot_goes_on_exactly_when_it_wakes(fleet):
    fleet = fleet("exchange", 8)
    fleet.start("a", pause=0.02)
    fleet.start("b", pause=0.02)
    fleet.await_steps("b", 12)
    fleet.freeze("b")
    time.sleep(3.0)
    fleet.thaw("b")
    assert fleet.ended("a")
    assert fleet.ended("b")
    check_success(fleet)


def notifies(fleet, robot):
    """Return the numbers of the steps of a robot that are notifies, in its undisturbed run."""
    made = fleet.program.executable.by_id[robot]
    everything = {(robot, name) for name in made.slots}
    point, number, found = entry(made, made.start), 0, []
    while possible := steps(made, point, everything):
        if possible[0].sets:
            found.append(number)
        point, number = possible[0].leads_to, number + 1
    return found


def test_a_split_network_is_bridged_when_it_heals(fleet):
    fleet = fleet("exchange", 8)
    fleet.start("a", pause=0.02)
    fleet.start("b", pause=0.02)
    for step, seconds in ((8, 0.5), (20, 2.5)):
        fleet.await_steps("a", step)
        fleet.split()
        time.sleep(0.3)
        before = len(fleet.records())
        time.sleep(seconds)
        assert len(fleet.records()) == before, "goes on although it is split"
        fleet.heal()
    assert fleet.ended("a")
    assert fleet.ended("b")
    check_success(fleet)
