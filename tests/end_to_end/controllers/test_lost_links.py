"""What a vehicle is told to do by itself when it no longer hears the ground."""

import time
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off

from mmrs_core.behaviour.program import Transition
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import move, notify, program

pytestmark = pytest.mark.real_time("controllers")

ARM = 400


def one_drone(*policies: Policy):
    return program(replace(robot_program("alpha", [take_off("up", 5.0), LAND]), policies=policies))


def test_a_vehicle_that_does_not_take_the_response_over_never_leaves_the_ground(controllers, hangar):
    made = controllers(one_drone(Policy("LINK_LOST", "LAND")))
    vehicles, links = hangar(made.program)
    del vehicles["alpha"].autopilot.parameters["FS_GCS_ENABLE"]
    code, said = made.run("fleet.py", *links)
    assert code == 1
    assert (
        "does not get ready: response to a lost link: the vehicle does not confirm FS_GCS_ENABLE = 5" in said
    )
    assert ARM not in [command for _, command, _ in vehicles["alpha"].autopilot.history]


def test_a_rover_switches_the_failsafe_on_that_its_action_needs(controllers, hangar):
    crawler = replace(quad(), metaclasses=(("urn:mmrs:robot:1.0", "Robot"),))
    robot = robot_program("alpha", [go_to("a", (0.0, 5.0, 0.0))])
    made = controllers(program(replace(robot, policies=(Policy("LINK_LOST", "HOLD"),))), types=[crawler])
    vehicles, links = hangar(made.program, types={"Quad": crawler})
    code, said = made.run("fleet.py", *links)
    assert code == 0, said
    parameters = vehicles["alpha"].autopilot.parameters
    assert (parameters["FS_ACTION"], parameters["FS_GCS_ENABLE"]) == (2.0, 1.0)


def test_the_vehicle_knows_the_response_of_the_wait_that_it_is_in(controllers, hangar):
    moves = [take_off("up", 5.0), move("stay", "HoldPosition", duration=60.0), replace(LAND, id="b")]
    giver = robot_program("beta", moves, home=(50.0, 0.0, 0.0))
    told = replace(giver.moves[2], after=(notify(("alpha", "go")),))
    giver = replace(giver, moves=(*giver.moves[:2], told, *giver.moves[3:]))
    waiting = Transition(1, 2, waits=("go",), policies=(Policy("LINK_LOST", "LAND"),))
    taker = robot_program("alpha", [take_off("up", 5.0), LAND], slots=("go",), transitions={1: waiting})
    made = controllers(program(taker, giver))
    vehicles, links = hangar(made.program)
    seen = []
    with made.start("fleet.py", *links) as process:
        while process.poll() is None:
            response = vehicles["alpha"].autopilot.parameters["FS_GCS_ENABLE"]
            if response not in seen[-1:]:
                seen.append(response)
            time.sleep(0.02)
        said = process.stderr.read()
    assert process.returncode == 0, said
    assert seen == [0.0, 3.0, 5.0, 3.0]
