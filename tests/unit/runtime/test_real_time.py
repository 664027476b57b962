"""Runs in real time: who is woken by what, how orders are obeyed, and how runs are resumed."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from math import inf

import pytest

from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.contributions.backends import BackendFactory, BackendInput
from mmrs_core.contributions.execution import Fault, RobotState
from mmrs_core.errors import LinkLostError, MmrsError
from mmrs_core.flight.bus import CommandId, Hub, Node, NoJournal
from mmrs_core.runtime.clock import RealClock
from mmrs_core.runtime.conditions import standard_conditions
from mmrs_core.runtime.live import Venture, run_live
from mmrs_core.runtime.orders import HOLD, LAND, RESUME, RETURN, STOP, Orders
from mmrs_core.runtime.resuming import restore
from mmrs_core.runtime.run import inputs_of
from mmrs_core.runtime.simulation import SIMULATION
from mmrs_core.runtime.slots import InProcessBus, ProgramBus, members_of
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, hold, notify, program, robot, robot_type

FAST = 100.0


class Walker:
    """A robot that does each thing until it is told that it is done; it wakes the interpreter itself."""

    def __init__(self, given: BackendInput, script):
        self.given, self.script = given, script
        self.done, self.trouble, self.stops, self.begun = True, None, [], []
        self.halted = self.closed = self.watched_for = self.doubted = False
        self.recovered = None
        script.robots[given.robot.id] = self

    def _go(self, what):
        self.begun.append(what)
        seconds = self.script.seconds.get(what, 0.0)
        self.done = seconds == 0.0
        if 0.0 < seconds < inf:
            threading.Timer(seconds, self._finish, (what,)).start()

    def _finish(self, what):
        if self.begun[-1] == what:
            self.done = True
            self.given.live.wake()

    def fail(self, which):
        self.trouble = Fault(which, "says the test")
        self.given.live.wake()

    def prepare(self, now):
        self._go("ready")

    def begin(self, move, now, *, through=False):
        self._go(move.id)

    def act(self, action, now):
        self._go(action.name)

    def finished(self, now):
        return self.done

    def fault(self, now):
        return self.trouble

    def next_event(self, now):
        return inf

    def wait(self, now):
        pass

    def state(self, now):
        return RobotState(now, (0.0, 0.0, 0.0), 0.0, 0.0, None, charge=self.script.charge)

    def stop(self, now, response="HOLD"):
        self.stops.append(response)
        self.trouble = None
        self._go(f"stop {response}")

    def obeys(self, now):
        return self.begun[-1].startswith("stop")

    def in_doubt(self, now):
        return self.doubted or (self.trouble is not None and self.trouble.which == "TAKEN_OVER")

    def watched(self, now):
        return self.watched_for and self.trouble is None

    def pause(self, now):
        self.halted = True

    def resume(self, now):
        self.halted = False

    def paused(self, now):
        return self.halted

    def recover(self, passed, begun, now):
        self.recovered = (tuple(passed), begun)
        self._go("recovered")

    def close(self):
        self.closed = True


class Script:
    """How long things take, in real seconds; what is not named takes none, and inf never ends."""

    def __init__(self, **seconds):
        self.seconds = {name.replace("_", " "): value for name, value in seconds.items()}
        self.robots, self.charge = {}, 0.5

    @property
    def factory(self):
        return BackendFactory("walker", "a robot of the test", lambda given: Walker(given, self))


@pytest.fixture
def live(kinds):
    """Return a function that begins a run in real time, and gives what it is steered and judged by."""
    runs = []

    def begin(behaviour, script, **more):
        runs.append(Flight(behaviour, script, kinds, **more))
        return runs[-1]

    yield begin
    for run in runs:
        run.abort()


class Flight:
    """A run in a thread of its own."""

    def __init__(self, behaviour, script, kinds, speedup=1.0, here=None, **more):
        self.behaviour, self.script, self.records, self.said = behaviour, script, [], []
        self.orders = Orders()
        inputs = inputs_of(
            behaviour, types={ROBOT_TYPE: robot_type()}, options={}, environment={}, areas=(), **kinds
        )
        inputs = {id: given for id, given in inputs.items() if here is None or id in here}
        factory = script.factory if isinstance(script, Script) else script
        given = {"bus": InProcessBus(behaviour), "conditions": {}, **more}
        self.venture = Venture(
            behaviour,
            inputs,
            clock=RealClock(speedup),
            orders=self.orders,
            say=self.said.append,
            **given,
        )
        self.ending = self.error = None
        self._thread = threading.Thread(target=self._go, args=(factory,), daemon=True)
        self._thread.start()

    def _go(self, factory):
        steps = run_live(self.venture, factory)
        try:
            while True:
                self.records.append(next(steps))
        except StopIteration as stop:
            self.ending = stop.value
        except (MmrsError, KeyboardInterrupt) as error:
            self.error = error

    def wait_for(self, test, seconds=20.0):
        until = time.monotonic() + seconds
        while not test():
            assert time.monotonic() < until, (self.shown(), self.said)
            time.sleep(0.002)

    def wait_for_step(self, words):
        self.wait_for(lambda: words in self.shown())

    def shown(self):
        return [f"{r.robot} {r.label} {r.move} {r.detail}".strip() for r in list(self.records)]

    def order(self, kind, *robots):
        order = self.orders.give(kind, robots or [each.id for each in self.behaviour.robots])
        assert order.settled.wait(20.0), (kind, order.open)
        return order

    def end(self, seconds=20.0):
        self._thread.join(seconds)
        assert not self._thread.is_alive(), (self.shown(), self.said)
        return self.ending

    def abort(self):
        """End the thread of a test that has failed, or does not wait for the end."""
        while self._thread.is_alive():
            self.orders.give(STOP, [each.id for each in self.behaviour.robots])
            for each in self.script.robots.values() if isinstance(self.script, Script) else ():
                each._finish(each.begun[-1])
            self._thread.join(0.2)


def do(id, **more):
    """Return a move that may last as long, or as short, as it likes."""
    return hold(id, 0.0, **more)


WALK = program(robot("r", [do("walk"), do("rest")]))


def test_simulated_robots_run_in_real_time_too(live):
    behaviour = program(
        robot("a", [go("g", (12, 0, 0), after=(notify("b.s"),))]),
        robot("b", [hold("h", 1.0)], waits={"h": ["s"]}),
    )
    run = live(behaviour, SIMULATION, speedup=FAST)
    assert run.end().outcome is Outcome.SUCCESS
    result = replay(behaviour, run.records)
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_what_ends_while_it_is_looked_at_is_not_missed(live):
    """A movement of a hundredth of a millisecond ends between two looks at the clock."""
    behaviour = program(robot("r", [hold(f"h{number}", 1e-3) for number in range(200)]))
    run = live(behaviour, SIMULATION, speedup=FAST)
    assert run.end().outcome is Outcome.SUCCESS


def test_a_step_follows_the_backends_wake_at_once(live):
    run = live(WALK, Script(walk=0.2))
    run.wait_for_step("r begin walk")
    begun = next(r.time for r in run.records if r.label == "begin" and r.move == "walk")
    run.end()
    ended = next(r.time for r in run.records if r.label == "end" and r.move == "walk")
    assert 0.2 <= ended - begun < 0.2 + 0.5


def test_a_notify_wakes_the_robot_that_waits_for_it(live):
    behaviour = program(
        robot("a", [do("h", after=(notify("b.s"),))]), robot("b", [do("h")], waits={"h": ["s"]})
    )
    run = live(behaviour, Script(h=0.0))
    assert run.end().outcome is Outcome.SUCCESS


def test_no_robot_begins_before_all_are_ready(live):
    behaviour = program(robot("a", [do("h")]), robot("b", [do("h")]))
    run = live(behaviour, Script(ready=inf))
    time.sleep(0.2)
    assert run.records == []
    run.script.robots["a"]._finish("ready")
    time.sleep(0.2)
    assert run.records == []
    run.script.robots["b"]._finish("ready")
    assert run.end().outcome is Outcome.SUCCESS


TWO = program(robot("a", [do("walk")]), robot("b", [do("walk")]))


def test_a_robot_that_is_held_before_anything_moves_stays_until_it_may_go_on(live):
    run = live(TWO, Script(ready=0.3))
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert list(run.order(HOLD, "a").confirmed) == ["a"]
    run.wait_for(lambda: "b end walk" in run.shown())
    assert "a end walk" not in run.shown()
    run.order(RESUME, "a")
    assert run.end().outcome is Outcome.SUCCESS


def test_a_hold_before_anything_moves_can_be_taken_back(live):
    run = live(TWO, Script(ready=0.3))
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert run.order(RESUME, "a").refused == {"a": "has nothing to resume"}
    run.order(HOLD, "a")
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert run.end().outcome is Outcome.SUCCESS


def test_a_robot_that_is_to_come_home_before_it_left_does_not_leave(live):
    run = live(TWO, Script(ready=0.3))
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert list(run.order(RETURN, "a").confirmed) == ["a"]
    assert run.end().faults == {"a": Fault("ORDERED", "order to return")}
    assert "a begin walk" not in run.shown()
    assert "b end walk" in run.shown()


def test_orders_while_robots_of_other_processes_are_waited_for_end_nothing_else(live):
    met = threading.Event()

    def meet(look):
        while not met.wait(0.01):
            look()
        return {}

    run = live(TWO, Script(), meet=meet)
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert list(run.order(RETURN, "a").confirmed) == ["a"]
    assert run.records == []
    met.set()
    assert run.end().faults == {"a": Fault("ORDERED", "order to return")}
    assert "b end walk" in run.shown()


def test_nothing_begins_once_every_robot_was_told_to_stop(live):
    run = live(TWO, Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.orders.give(STOP, ["a"])
    run.orders.give(STOP, ["b"])
    run.end()
    assert isinstance(run.error, KeyboardInterrupt)
    assert run.records == []
    assert "stopped before anything moved" in run.said


def test_an_answer_that_comes_before_the_question_counts(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:q", "x", "stop")}))
    run = live(behaviour, Script(ready=0.3), conditions=standard_conditions(["answer:q"]))
    run.wait_for(lambda: run.script.robots)
    run.orders.give("answer", ["r"], question="q", answer=True)
    assert run.end().outcome is Outcome.SUCCESS
    assert "r choose h true" in run.shown()


@pytest.mark.parametrize(("which", "error"), [("LINK_LOST", LinkLostError), ("REFUSED", MmrsError)])
def test_a_robot_that_does_not_get_ready_ends_the_run_before_anything_moves(live, which, error):
    run = live(program(robot("a", [do("h")]), robot("b", [do("h")])), Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.script.robots["b"].fail(which)
    run.end()
    assert isinstance(run.error, error)
    assert "robot 'b'" in str(run.error)
    assert run.records == []
    assert all(each.closed for each in run.script.robots.values())


def test_links_are_closed_at_the_end(live):
    run = live(WALK, Script())
    run.end()
    assert run.script.robots["r"].closed


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


@pytest.mark.parametrize(
    ("kind", "response", "fault"),
    [(STOP, "HOLD", "STOPPED"), (RETURN, "RETURN", "ORDERED"), (LAND, "LAND", "ORDERED")],
)
def test_an_order_ends_the_program_and_is_confirmed(live, kind, response, fault):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    order = run.order(kind)
    assert run.end().outcome is Outcome.FAILED
    assert list(order.confirmed) == ["r"]
    assert run.script.robots["r"].stops == [response]
    assert (run.records[-1].label, run.records[-1].detail) == ("fault", fault)


@pytest.mark.parametrize("kind", [HOLD, RESUME, LAND, STOP])
def test_no_order_is_obeyed_while_nobody_knows_whether_a_pilot_has_the_robot(live, kind):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    walker = run.script.robots["r"]
    walker.doubted = True
    order = run.orders.give(kind, ["r"])
    time.sleep(0.2)
    assert not walker.halted
    assert walker.stops == []
    walker.fail("TAKEN_OVER")
    walker.doubted = False
    assert order.settled.wait(20.0)
    assert list(order.confirmed) == []
    assert walker.stops == ["NOTHING"]


def test_a_robot_that_waits_for_slots_obeys_too(live):
    behaviour = program(
        robot("a", [do("h")], waits={"h": ["s"]}), robot("b", [do("walk", after=(notify("a.s"),))])
    )
    run = live(behaviour, Script(walk=inf))
    run.wait_for_step("a end h")
    assert list(run.order(LAND, "a").confirmed) == ["a"]


def test_a_robot_that_holds_makes_no_step_and_then_goes_on(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    assert list(run.order(HOLD).confirmed) == ["r"]
    run.script.robots["r"]._finish("walk")
    time.sleep(0.2)
    assert "r end walk" not in run.shown()
    assert list(run.order(RESUME).confirmed) == ["r"]
    assert run.end().outcome is Outcome.SUCCESS
    assert replay(WALK, run.records).accepted


def test_orders_that_make_no_sense_are_refused_with_the_reason(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    assert run.order(RESUME).refused == {"r": "has nothing to resume"}
    assert run.order(HOLD, "somebody").refused == {"somebody": "no such robot here"}


def test_orders_that_come_too_late_are_refused(live):
    run = live(WALK, Script())
    run.end()
    assert run.order(HOLD).refused == {"r": "the run has ended"}


def test_a_question_waits_for_the_operators_answer(live):
    behaviour = program(robot("r", [do("h"), do("x"), do("y")], choices={"h": ("answer:go left?", "x", "y")}))
    run = live(behaviour, Script(), conditions=standard_conditions(["answer:go left?"]))
    run.wait_for_step("r end h")
    time.sleep(0.2)
    assert "r choose h true" not in run.shown()
    run.orders.give("answer", ["r"], question="go left?", answer=False)
    assert run.end().outcome is Outcome.SUCCESS
    assert "r choose h false" in run.shown()


def test_a_question_nobody_answers_ends_by_the_policy_of_long_waits(live):
    policy = Policy("WAIT_TOO_LONG", "LAND", 0.2)
    behaviour = program(
        robot(
            "r",
            [do("h"), do("x")],
            choices={"h": ("answer:q", "x", "stop")},
            wait_policies={"h": (policy,)},
        )
    )
    run = live(behaviour, Script(), conditions=standard_conditions(["answer:q"]))
    assert run.end().faults["r"] == Fault("WAIT_TOO_LONG", "waits for answer:q")


def test_a_log_that_cannot_be_written_ends_the_program_without_the_step(live):
    def full(record):
        if record.label == "begin" and record.move == "walk":
            raise OSError(28, "no space left on device")

    behaviour = program(robot("r", [do("walk")], policies=(Policy("LOG_FAILED", "LAND"),)))
    run = live(behaviour, Script(), observe=full)
    assert run.end().faults["r"].which == "LOG_FAILED"
    assert run.script.robots["r"].stops == ["LAND"]
    assert "r begin walk" not in run.shown()


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
    members = members_of(behaviour)
    here, there = (
        Node([members[id]], "run-0", carrier=hub.plug(), journals=journals, tell=lambda line: None)
        for id, journals in (("r", lambda id: Full()), ("other", lambda id: NoJournal()))
    )
    run = live(behaviour, Script(walk=1.0), bus=ProgramBus(here, behaviour), here=["r"])
    run.wait_for_step("r begin walk")
    delivery = there.prepare(CommandId("run-0", "other", "", 1), (("r", "s"),), True)
    delivery.send(delivery.lamport)
    ending = run.end()
    here.close()
    there.close()
    assert ("r" in ending.faults) == (response == "LAND")
    assert response == "CONTINUE" or ending.faults["r"].which == "LOG_FAILED"


LOW = (Policy("BATTERY_LOW", "RETURN"),)
SURVEY = program(
    robot("a", [do("one"), do("two", after=(notify("b.s"),)), do("three")], policies=LOW),
    robot("b", [do("h")], waits={"h": ["s"]}),
)


def suspended(live, **more):
    run = live(SURVEY, Script(two=inf), **more)
    run.wait_for_step("a begin two")
    run.script.robots["a"].fail("BATTERY_LOW")
    return run


def test_a_low_battery_breaks_the_program_off_without_a_fault_in_the_log(live):
    run = suspended(live)
    ending = run.end()
    assert ending.suspended == ("a",)
    assert ending.responses["a"] == "RETURN"
    assert ending.outcome is Outcome.INCOMPLETE
    assert run.script.robots["a"].stops == ["RETURN"]
    assert all(record.label != "fault" for record in run.records)
    assert replay(SURVEY, run.records, partial=True).accepted


def test_a_low_battery_that_is_answered_in_the_air_is_a_fault(live):
    behaviour = program(robot("r", [do("walk")], policies=(Policy("BATTERY_LOW", "HOLD"),)))
    run = live(behaviour, Script(walk=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].fail("BATTERY_LOW")
    assert run.end().faults["r"].which == "BATTERY_LOW"


def test_a_changed_battery_lets_the_program_go_on_in_the_same_process(live):
    run = suspended(live, patience=20.0)
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    run.script.seconds["two"] = 0.0
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert run.end().outcome is Outcome.SUCCESS
    assert run.script.robots["a"].recovered == (("start", "one"), "two")
    assert replay(SURVEY, run.records).accepted


def test_a_battery_that_was_not_changed_is_told_and_nothing_moves(live):
    run = suspended(live, patience=20.0)
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    run.script.charge = 0.15
    assert run.order(RESUME, "a").refused == {"a": "its battery is still at 15%"}
    assert run.script.robots["a"].recovered is None


def test_a_run_is_resumed_from_its_log(live):
    first = suspended(live)
    first.end()
    records = tuple(first.records)
    bus = InProcessBus(SURVEY)
    restore(bus, SURVEY, records)
    second = live(SURVEY, Script(), resumed=records, bus=bus)
    assert second.end().outcome is Outcome.SUCCESS
    assert second.script.robots["a"].recovered == (("start", "one"), "two")
    assert second.script.robots["a"].begun[:3] == ["ready", "recovered", "two"]
    result = replay(SURVEY, [*records, *(replace(r, time=r.time + 1e3) for r in second.records)])
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_a_robot_that_cannot_be_taken_up_again_can_be_tried_again_later(live):
    first = suspended(live)
    first.end()
    records = tuple(first.records)
    bus = InProcessBus(SURVEY)
    restore(bus, SURVEY, records)
    second = live(SURVEY, Script(recovered=inf), resumed=records, bus=bus)
    second.wait_for(lambda: len(second.script.robots) == 2 and second.script.robots["b"].recovered)
    second.script.robots["a"].fail("REFUSED")
    second.script.robots["b"]._finish("recovered")
    ending = second.end()
    assert ending.suspended == ("a",)
    assert ending.faults["a"].which == "REFUSED"
    assert [record.label for record in second.records if record.robot == "a"] == []


def test_a_robot_that_ended_by_a_fault_is_left_alone_and_the_others_go_on(live):
    first = live(TWO, Script(walk=inf))
    first.wait_for_step("a begin walk")
    first.wait_for_step("b begin walk")
    first.order(LAND, "a")
    first.script.robots["b"].fail("BATTERY_LOW")
    first.wait_for(lambda: "'a': has done LAND" in first.said)
    first.order(STOP, "b")
    records = tuple(record for record in first.records if record.detail != "STOPPED")
    second = live(TWO, Script(), resumed=records)
    ending = second.end()
    assert list(second.script.robots) == ["b"]
    assert ending.outcome is Outcome.FAILED
    assert ending.faults == {"a": Fault("ORDERED")}
    assert "b end stop" in second.shown()


def test_a_robot_that_waits_for_one_that_failed_before_is_told_so(live):
    behaviour = program(
        robot("a", [do("walk", after=(notify("b.s"),))]),
        robot("b", [do("h")], waits={"h": ["s"]}, policies=(Policy("PEER_LOST", "LAND", 0.1),)),
    )
    first = live(behaviour, Script(walk=inf, h=inf))
    first.wait_for_step("b begin h")
    first.order(LAND, "a")
    records = tuple(first.records)
    second = live(behaviour, Script(), resumed=records)
    assert second.end().faults["b"].which == "PEER_LOST"


@pytest.mark.parametrize("kept", range(1, 14))
def test_a_run_is_resumed_after_any_of_its_steps(live, kept):
    behaviour = program(
        robot("a", [do("one", after=(notify("b.s"),)), do("two")]),
        robot("b", [do("h"), do("i")], waits={"h": ["s"]}),
    )
    whole = live(behaviour, Script())
    whole.end()
    records = tuple(whole.records[:kept])
    bus = InProcessBus(behaviour)
    restore(bus, behaviour, records)
    rest = live(behaviour, Script(), resumed=records, bus=bus)
    assert rest.end().outcome is Outcome.SUCCESS
    result = replay(behaviour, [*records, *(replace(r, time=r.time + 1e3) for r in rest.records)])
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_a_log_of_another_behaviour_is_refused(live, kinds):
    run = live(WALK, Script())
    run.end()
    other = program(robot("r", [do("swim")]))
    given = inputs_of(other, types={ROBOT_TYPE: robot_type()}, options={}, environment={}, areas=(), **kinds)
    venture = Venture(other, given, InProcessBus(other), {}, resumed=tuple(run.records))
    with pytest.raises(ValueError, match="none of its program's"):
        list(run_live(venture, Script().factory))
