"""Slots that no robot ever resets: a notify of them is one message, recorded before it is sent."""

import json
from contextlib import closing
from threading import Thread

import pytest
from gateway_client import Client
from hub import Hub
from mmrs_multicopter.testing import quad, robot_program, target_input

from mmrs_core.testing.programs import program
from mmrs_core.testing.small_programs import hold, notify
from mmrs_mavlink.plugin.controllers import robot_of
from mmrs_runtime.bus import CommandId, Node
from mmrs_runtime.bus.gateway.server import Gateway
from mmrs_runtime.bus.owner import Owner
from mmrs_runtime.bus.program_bus import members_of, recorded_of
from mmrs_runtime.controllers.running import program_of
from mmrs_runtime.records.steps import StepRecord

pytestmark = pytest.mark.real_time("parts of flights")

RUN = "run-0"


@pytest.fixture
def made():
    """Return a behaviour in which 'a' sets two slots of 'b', and 'b' resets one of them."""
    return program(
        robot_program("a", [hold("tell", 0.0, after=(notify("b.go"), notify("b.go", "b.ball")))]),
        robot_program(
            "b", [hold("drop", 0.0, after=(notify("b.ball", active=False),))], slots=("go", "ball")
        ),
    )


class Said(Hub):
    """A hub that remembers what is asked of robots, and brings nothing while it is `cut`."""

    def __init__(self):
        super().__init__()
        self.words, self.cut = [], False

    def plug(self):
        carrier = super().plug()
        ask = carrier.ask
        carrier.ask = lambda *asked: self._carry(ask, *asked)
        return carrier

    def _carry(self, ask, sender, owner, request, answered):
        self.words.append(json.loads(request)["do"])
        if not self.cut:
            ask(sender, owner, request, answered)


@pytest.fixture
def hub():
    return Said()


@pytest.fixture
def start(made, hub):
    """Return a function by which a robot begins."""

    def begin(robot, recorded=None):
        member = members_of(made.executable)[robot]
        return Node([member], RUN, carrier=hub.plug(), recorded=recorded, threaded=False)

    return begin


def notifying(node, *slots, active=True, number=1):
    return node.prepare(CommandId(RUN, "a", "", number), tuple(("b", slot) for slot in slots), active)


def test_a_notify_of_latched_slots_is_one_message(start, hub):
    b, a = start("b"), start("a")
    hub.words.clear()
    delivery = notifying(a, "go")
    assert (delivery.lamport, delivery.waiting, hub.words) == (a.lamport + 1, (), [])
    delivery.send(7)
    assert hub.words == ["commit"]
    assert delivery.is_over
    assert b.state(("b", "go")).active
    assert b.passed([("b", "go")], 8)


def test_a_notify_of_a_slot_that_another_robot_resets_still_asks_first(start, hub):
    b, a = start("b"), start("a")
    hub.words.clear()
    delivery = notifying(a, "go", "ball")
    assert hub.words == ["prepare"]
    delivery.send(delivery.lamport)
    assert hub.words == ["prepare", "commit"]
    assert b.state(("b", "ball")).active


def test_a_wait_that_a_latched_notify_lets_pass_is_later_than_it(start):
    b, a = start("b"), start("a")
    a.use(40)
    delivery = notifying(a, "go")
    delivery.send(delivery.lamport)
    assert delivery.lamport == 41
    assert not b.passed([("b", "go")], 41)
    assert b.passed([("b", "go")], 42)


def test_a_latched_notify_is_sent_until_its_owner_answers_and_its_value_counts_once(start, hub):
    b, a = start("b"), start("a")
    hub.cut = True
    delivery = notifying(a, "go")
    delivery.send(delivery.lamport)
    assert delivery.waiting == ("b",)
    hub.cut = False
    a.noticed("b", True)
    a.pump()
    assert delivery.is_over
    assert b.state(("b", "go")).version == 1


def test_a_latched_notify_that_was_recorded_and_not_sent_is_sent_when_its_robot_is_resumed(made, start, hub):
    b = start("b")
    hub.cut = True
    a = start("a")
    notifying(a, "go")
    a.close()
    hub.cut = False
    log = [StepRecord(RUN, "a", 0, 9, 0.0, "ntf", "tell", "post:0", "+b.go")]
    start("a", recorded_of(made.executable, ["a"], log))
    assert b.state(("b", "go")).active
    assert not b.passed([("b", "go")], 9)
    assert b.passed([("b", "go")], 10)


def test_a_latched_notify_that_is_given_up_leaves_nothing_to_be_told(start, hub):
    _, a = start("b"), start("a")
    hub.words.clear()
    notifying(a, "go").abort()
    assert hub.words == []


def test_a_latched_notify_is_granted_no_time_beyond_reach(start):
    a = start("a")
    with pytest.raises(ValueError, match="not from 1 to"):
        notifying(a, "go").send(1 << 40)


@pytest.mark.parametrize("together", [["a", "b"], ["a"], ["b"]])
def test_controllers_and_interpreter_agree_who_is_on_the_bus_whichever_robots_a_process_runs(made, together):
    members, input = members_of(made.executable), target_input(made, [quad()])
    own = [robot_of(robot, input) for robot in made.robots if robot.id in together]
    assert members["a"].latched == {("b", "go")}
    found = members_of(program_of(own))
    assert {name: found[name] for name in together} == {name: members[name] for name in together}


def test_sending_looks_at_no_owner_but_those_that_keep_a_slot(monkeypatch):
    names = [f"r{number}" for number in range(20)]
    robots = [robot_program(name, [], slots=("go",)) for name in names[1:]]
    resets = hold("tell", 0.0, after=(notify("r1.go", "r7.go", active=False),))
    everybody = members_of(program(robot_program("r0", [resets]), *robots).executable)
    node, looked = Node(list(everybody.values()), RUN, threaded=False), []
    kept = Owner.kept
    monkeypatch.setattr(Owner, "kept", lambda owner: looked.append(owner.robot) or kept(owner))
    delivery = node.prepare(CommandId(RUN, "r0", "", 1), (("r1", "go"), ("r7", "go")), False)
    node.pump()
    assert {*looked} == {"r1", "r7"}
    delivery.send(delivery.lamport)
    looked.clear()
    node.pump()
    assert looked == []


def test_a_program_at_a_gateway_is_granted_a_latched_notify_before_its_owner_is_there(made, tmp_path):
    hub, members = Hub(), members_of(made.executable)
    gateway = Gateway("a", RUN, lambda recorded: Node([members["a"]], RUN, carrier=hub.plug()), tmp_path)
    Thread(target=gateway.serve, args=(lambda line: None,), daemon=True).start()
    with closing(gateway), Client(gateway.port) as client:
        client.ask({"do": "hello", "token": gateway.token}, "welcome")
        client.ask({"do": "prepare", "number": 1, "slots": [["b", "go"]], "active": True}, "asked")
        assert client.hear("granted")["lamport"] == 1
        client.ask({"do": "send", "number": 1, "lamport": 4}, "sent")
        with closing(Node([members["b"]], RUN, carrier=hub.plug())) as b:
            client.hear("acknowledged")
            assert b.state(("b", "go")).lamport == 4
