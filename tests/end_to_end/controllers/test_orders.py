"""Orders of people, obeyed and confirmed by the robots; the fault table gives each in every state."""

import time
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off
from stalls import Stalls

from mmrs_core.behaviour.program import Transition
from mmrs_core.testing.programs import move, photo, program
from mmrs_runtime.orders.channels import Unreachable
from mmrs_runtime.orders.ordering import give

pytestmark = pytest.mark.real_time("controllers")

BRAKE, GUIDED = 17, 4
AT_HOME = 0.4
"""Metres from home at which a vehicle may land: ArduCopter landed within 0.3 m (benchmarks/results)."""
SPEEDUP = 20.0
PROMPT = 1.0
"""Real seconds in which an order on loopback is confirmed."""


def survey(*, leg: float = 40.0, waits: bool = False):
    """A climb, a stepped leg, a run of three legs, a photo, a wait, and a way home."""
    moves = [
        take_off("up", 10.0),
        go_to("out", (0.0, leg, 12.0)),
        go_to("r1", (20.0, leg, 12.0)),
        go_to("r2", (40.0, leg, 12.0)),
        replace(go_to("r3", (60.0, leg, 12.0)), after=(photo(),)),
        move("stay", "HoldPosition", duration=20.0),
        go_to("home", (0.0, 0.0, 12.0)),
        LAND,
    ]
    fluid = {index: Transition(index, index + 1, fluid=True) for index in (3, 4)}
    waiting = {6: Transition(6, 7, waits=("go",))} if waits else {}
    return program(robot_program("alpha", moves, slots=("go",), transitions=fluid | waiting))


def order(made, name: str, **options):
    """Give one robot an order; return its reply."""
    until = time.monotonic() + 10.0
    while True:
        try:
            (reply,) = give(made.logs, name, ["alpha"], **options)
            return reply
        except Unreachable:
            assert time.monotonic() < until
            time.sleep(0.02)


def pace(vehicle) -> float:
    return vehicle.autopilot.body.pace


def test_a_hold_is_obeyed_at_once_and_the_robot_goes_on_to_its_end(controllers, hangar):
    stalls = Stalls()
    made = controllers(survey())
    vehicles, links = hangar(made.program, speedup=SPEEDUP)
    with made.start("fleet.py", *links) as process:
        made.await_step("r2")
        time.sleep(0.1)
        held = order(made, "hold")
        place = vehicles["alpha"].autopilot.body.position
        assert (held["confirmed"], vehicles["alpha"].autopilot.mode) == (True, BRAKE), held
        time.sleep(0.5)
        assert pace(vehicles["alpha"]) < 0.3
        assert vehicles["alpha"].autopilot.body.distance_to(place) < 12.0
        resumed = order(made, "resume")
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0, said
    assert held["seconds"] < PROMPT + stalls.seconds
    assert resumed["confirmed"]
    assert resumed["seconds"] < PROMPT + stalls.seconds
    assert made.replayed().complaints == ()
    assert [(line["order"], line["confirmed"]) for line in made.box("alpha", "order")] == [
        ("hold", True),
        ("resume", True),
    ]


def test_a_robot_comes_home_when_it_is_told_to(controllers, hangar):
    stalls = Stalls()
    made = controllers(survey(leg=30.0))
    vehicles, links = hangar(made.program, speedup=SPEEDUP)
    with made.start("fleet.py", *links) as process:
        made.await_step("up")
        time.sleep(0.1)
        told = order(made, "return")
        assert told["confirmed"], told
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert told["seconds"] < PROMPT + stalls.seconds
    assert GUIDED in [number for _, number in vehicles["alpha"].autopilot.modes]
    assert not vehicles["alpha"].autopilot.armed
    assert max(map(abs, vehicles["alpha"].autopilot.body.position)) < AT_HOME
    assert made.replayed(partial=True).faults == {"alpha": "ORDERED"}


def test_a_robot_that_comes_home_can_be_held_and_landed_on_its_way(controllers, hangar):
    made = controllers(survey(leg=80.0))
    vehicles, links = hangar(made.program, speedup=SPEEDUP)
    with made.start("fleet.py", *links) as process:
        made.await_step("r1")
        assert order(made, "return")["confirmed"]
        time.sleep(0.2)
        held = order(made, "hold")
        assert (held["confirmed"], vehicles["alpha"].autopilot.mode) == (True, BRAKE)
        assert order(made, "land")["confirmed"]
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert not vehicles["alpha"].autopilot.armed
    assert vehicles["alpha"].autopilot.body.position[0] > AT_HOME
    assert made.replayed(partial=True).faults == {"alpha": "ORDERED"}


def test_a_robot_that_waits_for_others_is_held_and_waits_on(controllers, hangar):
    stalls = Stalls()
    made = controllers(survey(leg=20.0, waits=True))
    vehicles, links = hangar(made.program, speedup=SPEEDUP)
    with made.start("fleet.py", *links) as process:
        made.await_step("stay", "end")
        assert order(made, "hold")["seconds"] < PROMPT + stalls.seconds
        assert order(made, "resume")["confirmed"]
        assert vehicles["alpha"].autopilot.mode == GUIDED
        assert order(made, "land")["confirmed"]
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said


def test_status_says_where_a_robot_is_and_what_it_does(controllers, hangar):
    made = controllers(survey())
    _, links = hangar(made.program, speedup=SPEEDUP)
    with made.start("fleet.py", *links) as process:
        made.await_step("stay")
        told = order(made, "status")
        order(made, "land")
        process.communicate(timeout=60)
    assert (told["phase"], told["move"], told["mode"], told["armed"]) == ("works", "stay", "guided", True)
    assert told["place"]["height"] == pytest.approx(12.0, abs=0.6)


@pytest.mark.thorough
def test_a_robot_that_holds_after_a_fault_obeys_what_can_still_be_done(controllers, hangar):
    made = controllers(survey(leg=20.0))
    vehicles, links = hangar(made.program, speedup=SPEEDUP, silent=frozenset({2000}))
    with made.start("fleet.py", *links, "--tries", "2") as process:
        assert any("is watched; interrupt to end" in line for line in process.stderr)
        refused = order(made, "resume")
        assert (refused["confirmed"], refused["why"]) == (False, "its program has ended")
        told = order(made, "status")
        assert (told["phase"], told["response"]) == ("responds", "HOLD")
        assert order(made, "return")["confirmed"]
        _, said = process.communicate(timeout=60)
    assert process.returncode == 1, said
    assert max(map(abs, vehicles["alpha"].autopilot.body.position)) < AT_HOME
    assert made.replayed(partial=True).faults == {"alpha": "DEVICE_SILENT"}


def test_a_choice_that_comes_round_again_asks_again(controllers):
    robot = robot_program(
        "alpha",
        [take_off("up", 5.0), go_to("a", (4.0, 6.0, 5.0)), go_to("b", (0.0, 0.0, 5.0)), LAND],
        transitions={3: Transition(3, 2, condition="answer:again", otherwise=4)},
    )
    made = controllers(program(robot))
    with made.start("fleet.py", "--dry-run") as process:
        for again in (True, True, False):
            assert any("waits for an answer to 'again'" in line for line in process.stderr)
            assert order(made, "answer", question="again", answer=again)["confirmed"]
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0, said
    chosen = [step["detail"] for step in made.steps("alpha") if step["label"] == "choose"]
    assert chosen == ["true", "true", "false"]


def asking(question: str):
    """A climb, a place to which the robot goes only if it is answered yes, and a landing."""
    robot = robot_program(
        "alpha",
        [take_off("up", 5.0), go_to("a", (4.0, 6.0, 5.0)), LAND],
        transitions={1: Transition(1, 2, condition=f"answer:{question}", otherwise=3)},
    )
    return program(robot)


def test_an_answer_to_a_question_that_nobody_asks_is_refused(controllers):
    made = controllers(asking("go on?"))
    with made.start("fleet.py", "--dry-run") as process:
        assert any("waits for an answer to 'go on?'" in line for line in process.stderr)
        refused = order(made, "answer", question="go on", answer=True)
        assert (refused["confirmed"], refused["why"]) == (False, "no choice asks 'go on'; there is 'go on?'")
        assert order(made, "status")["asks"] == "go on?"
        assert order(made, "answer", question="go on?", answer=True)["confirmed"]
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0, said


def test_an_answer_decides_a_choice_that_waited_for_it(controllers):
    made = controllers(asking("is it safe"))
    with made.start("fleet.py", "--dry-run") as process:
        assert any("waits for an answer to 'is it safe'" in line for line in process.stderr)
        assert order(made, "answer", question="is it safe", answer=False)["confirmed"]
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0, said
    assert [step["detail"] for step in made.steps("alpha") if step["label"] == "choose"] == ["false"]
    (answered,) = made.box("alpha", "order")
    assert (answered["question"], answered["says"], answered["confirmed"]) == ("is it safe", "no", True)
    assert made.replayed().complaints == ()
