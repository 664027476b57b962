"""What goes wrong while a run goes on in real time."""

import threading
import time
from math import inf
from types import SimpleNamespace

import pytest
from hub import Hub
from live_runs import TWO, WALK, Script, do
from signals_elsewhere import broken_off
from stalls import Stalls

from mmrs_core.errors import MmrsError
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import hold, notify, program, robot
from mmrs_runtime.bus import CommandId, Node, NoJournal
from mmrs_runtime.bus.program_bus import ProgramBus, members_of
from mmrs_runtime.engine.connecting import let_go
from mmrs_runtime.orders.orders import HOLD, LAND, RESUME, RETURN, STOP
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("parts of flights")


def test_a_fault_is_answered_by_its_policy_and_the_run_waits_for_it(live):
    behaviour = program(robot("r", [do("walk")], policies=(Policy("OBSTACLE", "RETURN"),)))
    run = live(behaviour, Script(walk=inf, stop_RETURN=0.3))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].fail("OBSTACLE")
    ending = run.end()
    assert run.script.robots["r"].stops == ["RETURN"]
    assert run.records[-1].detail == "OBSTACLE"
    assert ending.outcome is Outcome.FAILED
    assert ending.unconfirmed == ()
    assert "'r': has done RETURN" in run.said


def test_a_robot_that_cannot_confirm_its_stop_is_named(live):
    run = live(WALK, Script(walk=inf, stop_HOLD=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].fail("NO_PROGRESS")
    run.wait_for(lambda: run.script.robots["r"].stops)
    run.script.robots["r"].fail("LINK_LOST")
    assert run.end().unconfirmed == ("r",)


def test_a_pilot_who_takes_over_is_left_alone_whatever_the_policies_say(live):
    behaviour = program(robot("r", [do("walk")], policies=(Policy("TAKEN_OVER", "LAND"),)))
    run = live(behaviour, Script(walk=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].fail("TAKEN_OVER")
    run.end()
    assert run.script.robots["r"].stops == ["NOTHING"]


def test_a_robot_that_holds_after_a_fault_is_watched_until_somebody_stops_it(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].watched_for = True
    run.script.robots["r"].fail("NO_PROGRESS")
    time.sleep(0.3)
    assert run.ending is None
    assert run.order(STOP).refused == {}
    assert run.end().faults["r"].which == "NO_PROGRESS"


def test_a_pilot_who_takes_a_robot_that_holds_is_noticed_and_obeyed(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    held = run.script.robots["r"]
    held.watched_for = True
    held.fail("OBSTACLE")
    run.wait_for(lambda: "'r': has done HOLD" in run.said)
    held.fail("TAKEN_OVER")
    run.wait_for(lambda: held.stops == ["HOLD", "NOTHING"])
    for kind in (RETURN, LAND, HOLD, RESUME, STOP):
        assert run.order(kind).refused == {"r": "a pilot has taken over"}
    assert held.stops == ["HOLD", "NOTHING"]
    assert run.ending is None
    held.watched_for = False
    run.end()


def test_a_log_that_cannot_be_written_ends_the_program_without_the_step(live):
    logged = []

    def full(record):
        logged.append(record)
        if record.label == "begin" and record.move == "walk":
            raise OSError(28, "no space left on device")

    behaviour = program(robot("r", [do("walk")], policies=(Policy("LOG_FAILED", "LAND"),)))
    run = live(behaviour, Script(), observe=full)
    assert run.end().faults["r"].which == "LOG_FAILED"
    assert run.script.robots["r"].stops == ["LAND"]
    assert "r begin walk" not in run.shown()
    lost, fault = logged[-2:]
    assert fault == lost._replace(label="fault", detail="LOG_FAILED")


def test_a_fault_that_cannot_be_written_is_answered_as_that_fault(live):
    def full(record):
        if record.label == "fault":
            raise OSError(28, "no space left on device")

    policies = (Policy("LOG_FAILED", "LAND"), Policy("DEVICE_SILENT", "RETURN"))
    run = live(program(robot("r", [do("walk")], policies=policies)), Script(walk=inf), observe=full)
    run.wait_for_step("r begin walk")
    run.script.robots["r"].fail("DEVICE_SILENT")
    assert run.end().faults["r"].which == "DEVICE_SILENT"
    assert run.script.robots["r"].stops == ["RETURN"]
    assert "'r': the fault is not in the log: no space left on device" in run.said


class Full:
    """A journal on a disk that is full."""

    def lines(self):
        return iter(())

    def keep(self, line):
        if "started" not in line:
            raise OSError(28, "No space left on device")


@pytest.mark.parametrize("response", ["LAND", "CONTINUE"])
def test_a_robot_that_cannot_keep_what_others_tell_it_does_as_its_policy_says(live, response):
    robots = (
        robot("r", [do("walk")], slots=("s",), policies=(Policy("LOG_FAILED", response),)),
        robot("other", [hold("h", 0.0, after=(notify("r.s"),))]),
    )
    behaviour, hub = program(*robots), Hub()
    members = members_of(behaviour.executable)
    here, there = (
        Node([members[id]], "run-0", carrier=hub.plug(), journals=journals, tell=lambda line: None)
        for id, journals in (("r", lambda id: Full()), ("other", lambda id: NoJournal()))
    )
    run = live(behaviour, Script(walk=1.0), bus=ProgramBus(here, behaviour.executable), here=["r"])
    run.wait_for_step("r begin walk")
    delivery = there.prepare(CommandId("run-0", "other", "", 1), (("r", "s"),), True)
    delivery.send(delivery.lamport)
    ending = run.end()
    here.close()
    there.close()
    assert ("r" in ending.faults) == (response == "LAND")
    assert response == "CONTINUE" or ending.faults["r"].which == "LOG_FAILED"


def test_robots_are_let_go_of_at_the_same_time(live):
    run, met = live(TWO, Script(walk=inf)), threading.Barrier(2)
    run.wait_for_step("b begin walk")
    for walker in run.script.robots.values():
        walker.close = lambda: met.wait(10.0)
    run.abort()
    run.end()
    assert not met.broken


def test_a_robot_that_cannot_be_let_go_of_does_not_keep_the_others_and_is_told(live):
    run = live(TWO, Script(walk=inf))
    run.wait_for_step("b begin walk")
    broken, other = run.script.robots["a"], run.script.robots["b"]

    def close():
        raise MmrsError("says the test")

    broken.close = close
    run.abort()
    assert (str(run.error), other.closed) == ("says the test", True)


def test_an_interrupt_ends_the_waiting_for_a_robot_that_is_slow_to_be_let_go_of():
    free, stalls, begun = threading.Event(), Stalls(), time.monotonic()
    with broken_off(rescue=free.set):
        let_go({"a": SimpleNamespace(close=free.wait)})
    free.set()
    assert time.monotonic() - begun < 3.0 + stalls.seconds
