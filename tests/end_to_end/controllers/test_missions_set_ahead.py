"""Others move a robot's mission on, or back, or replace it: nobody has checked where that leads."""

import threading
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Transition
from mmrs_core.testing.programs import program
from mmrs_mavlink.sitl.items import MISSION

pytestmark = pytest.mark.real_time("controllers")

AUTO, BRAKE = 3, 17
PLACES = [(0.0, 60.0, 20.0), (60.0, 60.0, 20.0), (60.0, 0.0, 20.0), (30.0, -30.0, 20.0), (0.0, -60.0, 20.0)]


def mission():
    moves = [take_off("up", 20.0), *(go_to(f"p{n}", place) for n, place in enumerate(PLACES))]
    moves.append(LAND)
    fluid = {n: Transition(n, n + 1, fluid=True) for n in range(2, 6)}
    return program(robot_program("alpha", moves, transitions=fluid))


def flying(process, until) -> None:
    """Wait for something while a process flies."""
    while not until():
        assert process.poll() is None
        threading.Event().wait(0.02)


def halted(process, autopilot) -> str:
    """Wait until a mission is flown no more, and end the process; return what it said."""
    flying(process, lambda: autopilot.mode != AUTO)
    assert autopilot.mode == BRAKE
    process.terminate()
    return process.communicate(timeout=60)[1]


@pytest.mark.parametrize(
    ("after", "to", "words"),
    [(1, 4, "set ahead to item"), pytest.param(4, 1, "set back from item", marks=pytest.mark.thorough)],
)
def test_a_mission_that_somebody_else_moves_ends_in_a_hold_and_is_not_logged_as_flown(
    controllers, hangar, after, to, words
):
    made = controllers(mission())
    vehicles, links = hangar(made.program, speedup=10.0)
    autopilot = vehicles["alpha"].autopilot
    with made.start("fleet.py", *links, "--on-stop", "land") as process:
        flying(process, lambda: autopilot.mode == AUTO and autopilot.item > after)
        autopilot.item = to if to < after else autopilot.item + 2
        said = halted(process, autopilot)
    assert words in said
    steps = read_logs([made.logs])
    ended = [step.move for step in steps if step.label == "end" and step.move.startswith("p")]
    assert len(ended) < len(PLACES)
    assert "NO_PROGRESS" in [step.detail for step in steps if step.label == "fault"]


def test_a_robot_whose_mission_was_replaced_is_held_before_it_is_far_from_where_it_should_be(
    controllers, hangar
):
    made = controllers(mission())
    vehicles, links = hangar(made.program, speedup=5.0)
    autopilot = vehicles["alpha"].autopilot
    with made.start("fleet.py", *links, "--on-stop", "land") as process:
        flying(process, lambda: autopilot.mode == AUTO and autopilot.item > 1)
        elsewhere = [replace(item, y=item.y + 20_000) for item in autopilot.stores[MISSION]]
        autopilot.stores[MISSION] = elsewhere
        said = halted(process, autopilot)
    assert "off all legs of its run: it may have got another mission" in said
    assert max(east for _, _, east, _ in autopilot.track) < 60.0 + 20.0
