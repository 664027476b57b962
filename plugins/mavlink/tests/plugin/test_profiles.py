"""A plug-in contributes a vehicle profile, and a robot kind that is carried by it, with moves of its own."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from mmrs_core.behaviour.program import Move
from mmrs_core.contributions.rules import MoveKind
from mmrs_core.generation.render import render
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.testing.programs import go_to, program, quad, robot_program, target_input
from mmrs_core.transformation.kinds import PLAIN_ROBOT
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.profiles import ARDUCOPTER, VehicleProfile

AIRSHIPS = "urn:airships:1.0"
AIRSHIP, CAST_OFF, MOOR = (AIRSHIPS, "Airship"), (AIRSHIPS, "CastOff"), (AIRSHIPS, "Moor")
MAV_TYPE_AIRSHIP = 7
PROFILE = VehicleProfile(
    "airship", "airship", "copter", MAV_TYPE_AIRSHIP, alone=frozenset({"CONTINUE", "LAND"})
)
TYPE = replace(quad(), name="Zeppelin", metaclasses=(AIRSHIP, PLAIN_ROBOT.metaclass))


class Airships:
    """The module of such a plug-in."""

    @staticmethod
    @hookimpl
    def mmrs_vehicle_profiles():
        return (PROFILE,)

    @staticmethod
    @hookimpl
    def mmrs_robot_kinds():
        answers = dict.fromkeys(PLAIN_ROBOT.policies, "LAND")
        kind = replace(PLAIN_ROBOT, name="airship", metaclass=AIRSHIP, policies=answers)
        return (replace(kind, vehicle="airship", medium="air"),)

    @staticmethod
    @hookimpl
    def mmrs_move_kinds():
        def up(move, here, home):
            return here, (here[0], here[1], here[2] + move.attributes["rope"])

        def down(move, here, home):
            return here, (here[0], here[1], 0.0)

        def seconds(move, path, kinematics, mode):
            return 1.0, 9.0

        return (
            MoveKind(CAST_OFF, up, seconds, frozenset({"grounded"}), "airborne", "take_off"),
            MoveKind(MOOR, down, seconds, frozenset({"airborne"}), "grounded", "land"),
        )


@pytest.fixture(scope="module")
def flight():
    contributed = load_plugins(extra={"airships": Airships}).contributions
    moves = [
        Move("up", (CAST_OFF, ("urn:mmrs:behaviour:1.0", "Move")), {"rope": 12.0}),
        go_to("out", (0.0, 30.0, 12.0)),
        Move("down", (MOOR, ("urn:mmrs:behaviour:1.0", "Move"))),
    ]
    given = target_input(program(robot_program("alpha", moves, type_name="Zeppelin")), [TYPE])
    kinds = {"robot_kinds": contributed.robot_kinds, "move_kinds": contributed.move_kinds}
    return replace(given, **kinds, extensions=contributed.extensions)


def test_a_robot_is_carried_by_the_profile_that_its_kind_names(flight):
    assert context_of(flight.program.robots[0], flight).profile == PROFILE


def test_its_moves_become_the_manoeuvres_that_their_kinds_state(flight):
    (file,) = (each for each in render(MAVLINK_PYTHON, flight) if each.path == "robot_alpha.py")
    code = file.content.decode()
    assert "TakeOff(12.0)" in code
    assert "Land()" in code
    assert 'vehicle="copter"' in code


def test_plans_have_its_vehicle_type(flight):
    (plan,) = (each for each in render(QGC_PLAN, flight) if each.path.endswith(".plan"))
    mission = json.loads(plan.content)["mission"]
    assert mission["vehicleType"] == MAV_TYPE_AIRSHIP
    assert next(item["command"] for item in mission["items"]) == 22


def test_without_the_profile_the_kind_is_refused_by_its_name(flight):
    (refusal, *_) = MAVLINK_PYTHON.refusals(replace(flight, extensions={}))
    assert "is of kind 'airship', which names vehicle 'airship'; known are copter" in refusal


def test_an_autopilot_without_a_profile_of_its_own_has_that_of_another():
    boat = replace(quad(**{"mavlink.autopilot": "px4"}), metaclasses=(PLAIN_ROBOT.metaclass,))
    robot = robot_program("a", [])
    assert context_of(robot, target_input(program(robot), [boat])).profile.vehicle == "rover"


def test_a_profile_answers_on_command_whatever_its_failsafe_does():
    assert ARDUCOPTER.alone <= ARDUCOPTER.responses
