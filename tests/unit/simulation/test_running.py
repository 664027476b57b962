"""Robots that run on the engine: who steps when, what it does about waits, choices and faults."""

from math import inf

import pytest
from carried_out import carried_out

from mmrs_core.behaviour.program import Action
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.execution import Condition, Fault, RobotState
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.errors import LinkLostError, UnsupportedError
from mmrs_core.scene import Policy
from mmrs_core.simulation.simulation import SimulatedRobot
from mmrs_core.testing.small_programs import go, hold, notify, program, robot, robot_type, use
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.engine.decisions import assumed
from mmrs_runtime.engine.terms import Terms
from mmrs_runtime.semantics import Outcome
from mmrs_runtime.slots import LocalSlots
from mmrs_runtime.vehicle import Vehicle

pytestmark = pytest.mark.real_time("parts of flights")


def shown(records):
    return [f"{r.robot} {r.label} {r.move} {r.detail}".strip() for r in records]


def at(records, robot_id, label, move):
    return next(r.time for r in records if (r.robot, r.label, r.move) == (robot_id, label, move))


def test_a_join_waits_for_the_slowest_robot(fly):
    run = fly(
        program(
            robot("a", [hold("h", 3.0, after=(notify("c.a"),))]),
            robot("b", [hold("h", 8.0, after=(notify("c.b"),))]),
            robot("c", [hold("h", 1.0), hold("i", 1.0)], waits={"h": ["a", "b"]}),
        )
    )
    assert run.ending.outcome is Outcome.SUCCESS
    assert at(run.records, "c", "begin", "i") == 8.0


def test_a_notify_that_comes_before_the_wait_is_not_lost(fly):
    run = fly(
        program(
            robot("a", [hold("h", 1.0, after=(notify("b.s"),))]),
            robot("b", [hold("h", 9.0)], waits={"h": ["s"]}),
        )
    )
    assert at(run.records, "b", "take", "h") == 9.0


def test_robots_of_one_instant_step_in_the_programs_order(fly):
    def together(*ids):
        return program(*(robot(id, [hold("h", 2.0)]) for id in ids))

    for ids in (("a", "b"), ("b", "a")):
        ends = [r.robot for r in fly(together(*ids)).records if r.move == "h" and r.label == "end"]
        assert ends == list(ids)


def test_the_same_run_twice_is_the_same(fly):
    behaviour = program(
        robot("a", [go("g", (5, 5, 0), after=(notify("b.s"),))]), robot("b", [hold("h")], waits={"h": ["s"]})
    )
    assert fly(behaviour) == fly(behaviour)


@pytest.mark.parametrize(("holds", "then"), [(True, "x"), (False, "y")])
def test_a_condition_decides_a_choice(fly, holds, then):
    behaviour = program(robot("r", [hold("h"), hold("x"), hold("y")], choices={"h": ("sunny", "x", "y")}))
    run = fly(behaviour, conditions=assumed({"sunny": holds}))
    assert f"r begin {then}" in shown(run.records)
    assert ("r begin x" in shown(run.records)) is holds


def test_a_condition_is_asked_once_after_the_wait_with_the_robots_state(fly):
    asked = []

    def holds(state):
        asked.append(state)
        return True

    behaviour = program(
        robot("r", [go("g", (9, 0, 0)), hold("x")], choices={"g": ("c", "x", "stop")}, waits={"g": ["s"]}),
        robot("q", [hold("h", 50.0, after=(notify("r.s"),))]),
    )
    fly(behaviour, conditions={"c": Condition("c", holds)})
    (state,) = asked
    assert state.time == 50.0
    assert state.position == (9, 0, 0)


@pytest.mark.parametrize("answer", [lambda state: 1 / 0, lambda state: None])
def test_a_condition_that_throws_is_a_fault_never_false(fly, answer):
    behaviour = program(robot("r", [hold("h"), hold("x")], choices={"h": ("c", "x", "stop")}))
    run = fly(behaviour, conditions={"c": Condition("c", answer)})
    assert run.ending.outcome is Outcome.FAILED
    assert run.ending.faults["r"].which == "CONDITION_FAILED"
    assert run.records[-1].label == "fault"


def test_a_condition_that_nobody_decides_is_refused_before_anything_moves(fly):
    behaviour = program(robot("r", [hold("h"), hold("x")], choices={"h": ("c", "x", "stop")}))
    with pytest.raises(UnsupportedError) as caught:
        fly(behaviour)
    assert caught.value.elements == ("robot 'r', after move 'h': condition 'c'",)


def test_a_condition_that_nobody_ever_knows_is_waited_for_no_longer_than_anything_else_happens(fly):
    behaviour = program(
        robot("r", [hold("h"), hold("x")], choices={"h": ("c", "x", "stop")}), robot("q", [hold("h", 60.0)])
    )
    ending = fly(
        behaviour,
        robot_type(lifetime=None),
        conditions={"c": Condition("c", lambda state: True, lambda state: False)},
    ).ending
    assert ending.outcome is Outcome.INCOMPLETE
    assert 660.0 <= ending.time < 661.0
    assert [str(each) for each in ending.waiting] == ["'r' waits after 'h' for 'c'"]


def test_a_condition_that_nobody_knows_is_waited_for_as_long_as_a_policy_says(fly):
    policy = Policy("WAIT_TOO_LONG", "HOLD", 650.0)
    behaviour = program(
        robot("r", [hold("h"), hold("x")], choices={"h": ("c", "x", "stop")}, policies=(policy,))
    )
    run = fly(
        behaviour,
        robot_type(lifetime=None),
        conditions={"c": Condition("c", lambda state: True, lambda state: False)},
    )
    assert run.ending.faults["r"].which == "WAIT_TOO_LONG"
    assert run.records[-1].time == pytest.approx(651.0, abs=0.06)


def test_a_deadlock_is_found_and_names_robots_moves_and_slots(fly):
    behaviour = program(
        robot("a", [hold("h", 1.0), hold("i", after=(notify("b.s"),))], waits={"h": ["s"]}),
        robot("b", [hold("h", 2.0), hold("i", after=(notify("a.s"),))], waits={"h": ["s"]}),
    )
    ending = fly(behaviour).ending
    assert ending.outcome is Outcome.STUCK
    assert [(w.robot, w.move, w.slots) for w in ending.waiting] == [("a", "h", ("s",)), ("b", "h", ("s",))]
    assert ending.time == 2.0


def test_a_wait_that_lasts_too_long_ends_by_its_policy(fly):
    policy = Policy("WAIT_TOO_LONG", "HOLD", 30.0)
    behaviour = program(robot("r", [hold("h", 5.0)], waits={"h": ["s"]}, wait_policies={"h": (policy,)}))
    run = fly(behaviour)
    assert run.ending.outcome is Outcome.FAILED
    assert run.records[-1].detail == "WAIT_TOO_LONG: waits for s"
    assert run.records[-1].time == 35.0
    assert [(w.robot, w.slots) for w in run.ending.waiting] == [("r", ("s",))]


def test_a_robot_whose_peer_failed_responds_to_that(fly):
    behaviour = program(
        robot(
            "a",
            [hold("h", before=(use("cam", "on"),), after=(notify("b.s"),))],
            policies=(Policy("DEVICE_SILENT", "HOLD"),),
        ),
        robot("b", [hold("h", 1.0)], waits={"h": ["s"]}, policies=(Policy("PEER_LOST", "HOLD", 4.0),)),
    )
    run = fly(behaviour)
    assert run.ending.faults["a"].which == "DEVICE_SILENT"
    assert run.ending.faults["b"] == Fault("PEER_LOST", "waits for s of a")
    assert run.records[-1].time == 5.0


def test_a_silent_device_is_passed_over_where_the_policy_says_so(fly):
    behaviour = program(
        robot("r", [hold("h", before=(use("cam", "on"),))], policies=(Policy("DEVICE_SILENT", "CONTINUE"),))
    )
    assert fly(behaviour).ending.outcome is Outcome.SUCCESS


def test_a_slot_that_was_reset_after_a_wait_was_passed_replays(fly):
    behaviour = program(
        robot("a", [hold("h", 1.0, after=(notify("b.s"),)), hold("i", 1.0)], slots=("u",)),
        robot("b", [hold(f"h{n}", 0.1) for n in range(9)], waits={"h8": ["s"]}),
        robot("c", [hold("h", 2.0, after=(notify("b.s", active=False),))]),
    )
    run = fly(behaviour)
    assert run.ending.outcome is Outcome.SUCCESS
    took = next(r for r in run.records if r.detail == "stop" and r.robot == "b")
    reset = next(r for r in run.records if r.slot == "-b.s")
    assert took.lamport < reset.lamport


def test_a_loop_without_duration_is_cut_off_at_the_limit(fly):
    behaviour = program(robot("r", [hold("h", 0.0)], choices={"h": ("c", "h", "stop")}))
    run = fly(behaviour, conditions=assumed({"c": True}), terms=Terms(steps=1000))
    assert run.ending.outcome is Outcome.INCOMPLETE
    assert len(run.records) == 1000


def test_a_run_is_cut_off_at_its_time(fly):
    run = fly(program(robot("r", [hold("h", 100.0)])), terms=Terms(seconds=50.0))
    assert run.ending.outcome is Outcome.INCOMPLETE
    assert run.records[-1].label == "begin"


def test_notifies_are_observed_before_they_are_delivered():
    behaviour = program(robot("r", [hold("h", after=(notify("r.s"),))], waits={"h": ["s"]}))
    bus, seen = LocalSlots(behaviour.executable), []

    def observe(record):
        seen.append(record)
        if record.label == "ntf":
            assert not bus.state(("r", "s")).active

    carried_out(behaviour, {"r": Instant()}, slots=bus, terms=Terms(observe=observe))
    assert [record.label for record in seen].count("ntf") == 1
    assert bus.state(("r", "s")).active


class Instant(Vehicle):
    """A vehicle whose moves take no time; it notes what it is told."""

    def __init__(self, lost_at: str = "", fault: Fault | None = None) -> None:
        self.calls: list[str] = []
        self.lost_at, self.trouble = lost_at, fault

    def do(self, order, now, *, through=False):
        if isinstance(order, Action):
            self.calls.append(f"act {order.name}")
            return
        self.calls.append(f"begin {order.id}{' through' if through else ''}")
        if order.id == self.lost_at:
            raise LinkLostError("no heartbeat")

    def wait(self, now):
        self.calls.append("wait")

    def state(self, now):
        return RobotState(now, (0.0, 0.0, 0.0), 0.0, 0.0, None)

    def respond(self, response, now):
        self.calls.append(f"stop {response}")


def test_a_robot_that_came_to_its_end_is_not_stopped():
    backend = Instant()
    carried_out(program(robot("r", [hold("h")])), {"r": backend})
    assert backend.calls == ["begin start", "begin h", "begin stop"]


def test_a_lost_link_is_a_fault_that_stops_the_robot_by_its_policy():
    backend = Instant(lost_at="h")
    behaviour = program(robot("r", [hold("h")], policies=(Policy("LINK_LOST", "RETURN"),)))
    records, ending = carried_out(behaviour, {"r": backend})
    assert records[-1].detail == "LINK_LOST: no heartbeat"
    assert backend.calls[-1] == "stop RETURN"
    assert ending.outcome is Outcome.FAILED


def test_policies_of_the_type_answer_what_the_program_leaves_open():
    backend = Instant(lost_at="h")
    behaviour = program(robot("r", [hold("h")]))
    carried_out(behaviour, {"r": backend}, policies={"r": (Policy("LINK_LOST", "LAND"),)})
    assert backend.calls[-1] == "stop LAND"


def test_a_run_that_is_given_up_stops_every_robot_that_is_under_way():
    backends = {"a": Instant(), "b": Instant()}
    behaviour = program(robot("a", [hold("h")]), robot("b", [hold("h")]))

    def observe(record):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        carried_out(behaviour, backends, terms=Terms(observe=observe))
    assert [backend.calls[-1] for backend in backends.values()] == ["stop HOLD", "stop HOLD"]


def test_a_robot_that_does_not_confirm_its_stop_is_named():
    class Deaf(Instant):
        def respond(self, response, now):
            raise LinkLostError("no answer")

    behaviour = program(robot("r", [hold("h")], waits={"h": ["s"]}))
    _, ending = carried_out(behaviour, {"r": Deaf()})
    assert ending.unconfirmed == ("r",)
    assert ending.outcome is Outcome.STUCK


def test_a_fluid_transition_tells_the_backend_to_pass_through_only_where_nothing_holds_it_up():
    behaviour = program(
        robot(
            "r",
            [
                go("free", (1, 0, 0), after=(notify("r.t"),)),
                go("blocked", (2, 0, 0), after=(use("cam", "shoot"),)),
                go("waits", (3, 0, 0)),
                go("set", (4, 0, 0)),
            ],
            fluid=["free", "blocked", "waits", "set"],
            waits={"waits": ["s"], "set": ["t"]},
        ),
        robot("q", [hold("h", after=(notify("r.s"),))]),
    )
    backend = Instant()
    carried_out(behaviour, {"r": backend, "q": Instant()})
    begun = [call for call in backend.calls if call.startswith("begin")]
    assert begun == [
        "begin start",
        "begin free through",
        "begin blocked",
        "begin waits",
        "begin set through",
        "begin stop",
    ]


def test_a_backend_for_an_unknown_robot_is_the_callers_mistake():
    with pytest.raises(ValueError, match="robot 'z': not in the behaviour"):
        carried_out(program(robot("r", [])), {"z": Instant()})


def test_some_of_the_robots_can_run_here_and_the_others_elsewhere():
    behaviour = program(
        robot("here", [hold("h", 0.0)], waits={"h": ["s"]}),
        robot("elsewhere", [hold("h", 0.0, after=(notify("here.s"),))]),
    )
    bus, there = LocalSlots(behaviour.executable), []

    class Late(Instant):
        def look(self, now):
            """Have the other robot run while this one waits."""
            if self.calls[-1] == "wait" and not there:
                there.extend(carried_out(behaviour, {"elsewhere": Instant()}, slots=bus)[0])
            return inf

    here, _ = carried_out(behaviour, {"here": Late()}, slots=bus, terms=Terms(seconds=60.0))
    assert there
    assert replay(behaviour, [*here, *there]).outcome is Outcome.SUCCESS


def test_many_robots_run_much_faster_than_real_time(fly):
    behaviour = program(
        *(
            robot(
                f"r{n}",
                [hold("h", 60.0, after=(notify(f"r{n + 1}.s"),) if n < 199 else ())],
                waits={"start": ["s"]} if n else {},
            )
            for n in range(200)
        )
    )
    run = fly(behaviour, robot_type(lifetime=None))
    assert run.ending.outcome is Outcome.SUCCESS
    assert run.ending.time == pytest.approx(200 * 60.0)


def test_a_run_can_follow_the_worlds_time(kinds):
    behaviour = program(
        robot("a", [go("g", (12, 0, 0), after=(notify("b.s"),))]),
        robot("b", [hold("h", 1.0)], waits={"h": ["s"]}),
    )
    backends = {}
    for each in behaviour.robots:
        given = VehicleInput(behaviour, {}, **kinds, robot=each, type=robot_type())
        backends[each.id] = SimulatedRobot(given)
    clock = RealClock(100.0)
    records, _ = carried_out(behaviour, backends, clock=clock)
    result = replay(behaviour, records)
    assert result.accepted
    assert result.outcome is Outcome.SUCCESS
    assert 4.0 <= result.duration <= clock.now()
