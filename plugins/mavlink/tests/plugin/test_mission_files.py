"""Missions in both formats hold the same items, wherever a robot goes."""

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off, target_input
from pymavlink import mavwp

from mmrs_core.behaviour.program import Transition
from mmrs_core.generation.render import render
from mmrs_core.testing.programs import photo, program
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL

lengths = st.floats(-5000.0, 5000.0, allow_nan=False)
heights = st.floats(1.0, 120.0)
trajectories = st.sampled_from(["DIRECT", "HORIZONTAL_FIRST", "VERTICAL_FIRST"])


@st.composite
def legs(draw, number):
    """Return a GoTo with any trajectory, distance, speed and actions."""
    position = (draw(lengths), draw(lengths), draw(heights))
    leg = go_to(f"m{number}", position, speed=draw(st.floats(0.1, 30.0)), trajectory=draw(trajectories))
    actions = (photo(),) * draw(st.integers(0, 2))
    return replace(leg, distance=draw(st.floats(0.0, 20.0)), after=actions)


@st.composite
def flights(draw):
    """Return what a target gets for one drone."""
    count = draw(st.integers(1, 6))
    moves = [take_off("up", draw(heights)), *(draw(legs(number)) for number in range(count))]
    moves.append(LAND)
    fluid = draw(st.sets(st.integers(2, count + 1)))
    transitions = {index: Transition(index, index + 1, fluid=True) for index in fluid}
    home = (draw(lengths), draw(lengths), draw(st.floats(-50.0, 50.0)))
    return target_input(program(robot_program("alpha", moves, home=home, transitions=transitions)))


def items_of_plan(flight):
    plan = json.loads(render(QGC_PLAN, flight)[0].content)["mission"]
    return plan["plannedHomePosition"], [(i["frame"], i["command"], *i["params"]) for i in plan["items"]]


def items_of_list(flight):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "alpha.waypoints"
        path.write_bytes(render(WPL, flight)[0].content)
        loader = mavwp.MAVWPLoader()
        loader.load(str(path))
    home, *items = loader.wpoints
    assert [item.seq for item in loader.wpoints] == list(range(len(loader.wpoints)))
    return [home.x, home.y, home.z], [
        (i.frame, i.command, i.param1, i.param2, i.param3, i.param4, i.x, i.y, i.z) for i in items
    ]


@given(flights())
@settings(max_examples=many(600, fast=20))
def test_a_list_holds_the_items_of_the_plan(flight):
    assert items_of_list(flight) == items_of_plan(flight)
