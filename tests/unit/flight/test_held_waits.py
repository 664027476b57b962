"""Time in which a robot is held, which nobody that it waits for must answer for."""

from __future__ import annotations

from dataclasses import replace

import pytest
from flight_crew import in_background, manned, robot_of
from patience import until

from mmrs_mavlink.program import Choose, Operate, Policy, Then
from mmrs_runtime.faults import DEVICE_SILENT, PEER_LOST, WAIT_TOO_LONG, Fault
from mmrs_runtime.orders.orders import Order

SECONDS = 40.0
"""For which others may be silent: more than any exchange takes."""

PATIENT = (Policy(WAIT_TOO_LONG, "RETURN", SECONDS), Policy(PEER_LOST, "RETURN", SECONDS))
PHOTO = 203
"""The command that has a camera take a picture."""


@pytest.fixture
def robot(tmp_path):
    """Return a function that gives a robot on the ground that waits for its slot ``go``, set by robots."""
    opened = []

    def man(*policies, senders=("alpha",), **settings):
        more = {"slots": ("go",), "senders": (("go", senders),)}
        given = manned(tmp_path, replace(robot_of(*policies), **more), **settings)
        opened.append(given)
        return given.__enter__()

    yield man
    for each in opened:
        each.__exit__(None, None, None)


def is_held(made, work, *, seconds: float = 2 * SECONDS):
    """Begin some work, and hold the robot in the middle of it for so long; return what it will come to."""
    clock, done = made.crew.desk.clock, in_background(work)
    begun = clock.now()
    until(lambda: clock.now() > begun + SECONDS / 4)
    held = made.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    begun = clock.now()
    until(lambda: clock.now() > begun + seconds)
    resumed = made.inbox.give(Order("resume"))
    until(lambda: resumed.confirmed)
    return done


def is_waiting(made, done, seconds: float = SECONDS / 4) -> bool:
    """Return whether it is still not done after so many seconds."""
    clock = made.crew.desk.clock
    begun = clock.now()
    until(lambda: done.done() or clock.now() > begun + seconds)
    return not done.done()


def fault_of(done) -> str:
    with pytest.raises(Fault) as caught:
        done.result(20.0)
    return caught.value.event


def test_a_wait_for_a_slot_goes_on_after_a_hold_and_ends_by_its_own_seconds(robot):
    made = robot(*PATIENT)
    done = is_held(made, lambda: made.crew.pilot.waits.leave(Then("up", ("go",))))
    assert is_waiting(made, done)
    assert fault_of(done) == WAIT_TOO_LONG


@pytest.mark.thorough
def test_an_answer_of_the_operator_may_come_after_a_hold(robot):
    made = robot(*PATIENT)
    made.crew.desk.conditions["answer:go?"] = lambda state: state.answers.get("go?")
    done = is_held(made, lambda: made.crew.pilot.waits.leave(Choose("answer:go?", "up", "stop")))
    assert is_waiting(made, done)
    assert fault_of(done) == WAIT_TOO_LONG


def test_a_peer_that_is_lost_while_a_robot_is_held_has_its_seconds_afterwards(robot):
    made = robot(PATIENT[1], senders=("beta",))
    slots = made.crew.desk.slots
    lost = []
    slots.lost = lambda robots: next(iter(lost), None)
    waits = made.crew.pilot.waits
    done = in_background(lambda: waits.leave(Then("up", ("go",))))
    held = made.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    clock = made.crew.desk.clock
    begun = clock.now()
    until(lambda: clock.now() > begun + 2 * SECONDS)
    lost.append("beta")
    made.inbox.give(Order("resume"))
    assert is_waiting(made, done)
    assert fault_of(done) == PEER_LOST


@pytest.mark.thorough
def test_owners_that_do_not_answer_have_their_seconds_without_those_of_a_hold(robot):
    made = robot(PATIENT[1])
    check = made.crew.pilot.waits.delivery()

    def deliver() -> None:
        while True:
            check(("beta",))
            made.crew.vehicle.rest(1.0)

    done = is_held(made, deliver)
    assert is_waiting(made, done)
    assert fault_of(done) == PEER_LOST


def test_a_device_is_asked_again_after_a_hold_before_it_counts_as_silent(robot):
    made = robot(Policy(DEVICE_SILENT, "RETURN", 2 * SECONDS), silent=frozenset({PHOTO}))
    doing = made.crew.pilot._doing
    photo = Operate("camera", "photo", PHOTO, ())
    done = is_held(made, lambda: doing.act(photo, "post:0"), seconds=3 * SECONDS)
    asked = len(made.simulated.received)
    assert fault_of(done) == DEVICE_SILENT
    commands = [name for _, name in made.simulated.received[asked:] if name == "COMMAND_LONG"]
    assert len(commands) > made.crew.link.retries.tries
