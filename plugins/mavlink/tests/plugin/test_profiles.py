"""A plug-in contributes a vehicle profile, and a robot kind that is carried by it, with moves of its own."""

import json
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import replace

import pytest
from flight_crew import NORTH, robot_of
from mavlink_peer import acknowledged, eventually, linked, value
from mmrs_multicopter.testing import go_to, quad, robot_program, target_input
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.behaviour.program import Move
from mmrs_core.contributions.rules import MoveKind
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.scene.timing import MoveSeconds
from mmrs_core.testing.programs import program
from mmrs_core.transformation.kinds import PLAIN_ROBOT
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.profiles import ARDUCOPTER, ARDUPILOT, PROFILES, modes
from mmrs_mavlink.profiles.profile import LostLinkFailsafe, Safeguard, Timing
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.vehicles.guidance import ArduPilotGuidance
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_mavlink.vehicles.preparation import check_identity, report_failsafes
from mmrs_runtime.faults import RefusedError

AIRSHIPS = "urn:airships:1.0"
AIRSHIP, CAST_OFF, MOOR = (AIRSHIPS, "Airship"), (AIRSHIPS, "CastOff"), (AIRSHIPS, "Moor")
MAV_TYPE_AIRSHIP = 7
MAV_AUTOPILOT_AIRSHIPS = 19


class Buoyant(ArduPilotGuidance):
    """Lifts off in HOLD: an airship hovers as soon as it is untied."""

    climbs_in = modes.HOLD


AUTOPILOT = replace(
    ARDUPILOT,
    name="airships",
    title="Airship Pilot",
    number=MAV_AUTOPILOT_AIRSHIPS,
    guidance=f"{__name__}:Buoyant",
    announcements={"BATTERY_LOW": ("gas is low",)},
)
NUMBERS = {modes.GUIDED: 31, modes.HOLD: 32, modes.LAND: 33}
PROFILE = replace(
    ARDUCOPTER,
    name="airship",
    vehicle="airship",
    autopilot=AUTOPILOT,
    source=f"{__name__}:PROFILE",
    rehearsed_as="",
    mav_types=(MAV_TYPE_AIRSHIP,),
    modes={name: modes.Mode(number, (1.0, float(number))) for name, number in NUMBERS.items()},
    other_modes={34: "drifting"},
    failsafe_modes=frozenset({33, 34}),
    own_modes=frozenset(),
    event_modes={"BATTERY_LOW": frozenset({34})},
    lost_link=LostLinkFailsafe(
        {"LAND": {"MOOR_ON_LOSS": 2}, "CONTINUE": {"MOOR_ON_LOSS": 0}}, {"MOOR_ON_LOSS": {2: frozenset({33})}}
    ),
    responses=frozenset({"CONTINUE", "LAND"}),
    safeguards=(Safeguard("MOOR_ON_LOSS", "no ground station", {0: "nothing", 2: "moor"}),),
    corridor=60.0,
    timing=Timing(resend=0.1),
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
            return MoveSeconds(1.0, 5.0, 9.0)

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
    assert 'vehicle="airship"' in code
    assert f'driven_by="{PROFILE.source}"' in code


def test_plans_have_its_vehicle_type(flight):
    (plan,) = (each for each in render(QGC_PLAN, flight) if each.path.endswith(".plan"))
    mission = json.loads(plan.content)["mission"]
    assert mission["vehicleType"] == MAV_TYPE_AIRSHIP
    assert next(item["command"] for item in mission["items"]) == 22


def test_without_the_profile_the_kind_is_refused_by_its_name(flight):
    (refusal, *_) = MAVLINK_PYTHON.refusals(replace(flight, extensions={}))
    assert "is of kind 'airship', which names vehicle 'airship'; known are copter" in refusal


def test_a_profile_that_programs_cannot_import_is_refused(flight):
    nowhere = {"vehicle_profiles": {PROFILE.name: replace(PROFILE, source="")}}
    (refusal,) = MAVLINK_PYTHON.refusals(replace(flight, extensions=nowhere))
    assert refusal == "robot 'alpha': profile 'airship' says no module that programs import it from"


MODULE = """from dataclasses import replace

from mmrs_mavlink.profiles import ARDUCOPTER

ZEPPELIN = replace(ARDUCOPTER, name="airship", vehicle="airship")
"""


def test_a_program_imports_its_profile_and_begins_nothing_without_it(flight, tmp_path):
    own = {"vehicle_profiles": {PROFILE.name: replace(PROFILE, source="zeppelins:ZEPPELIN")}}
    write(render(MAVLINK_PYTHON, replace(flight, extensions={**flight.extensions, **own})), tmp_path)

    def dry_run():
        command = [sys.executable, "fleet.py", "--dry-run", "--speedup", "100"]
        found = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
        return found.returncode, found.stderr

    code, said = dry_run()
    assert code == 2
    assert "robot 'alpha': zeppelins:ZEPPELIN: cannot be imported" in said
    (tmp_path / "zeppelins.py").write_text(MODULE, "utf-8")
    assert dry_run()[0] == 0


def test_a_class_of_vehicle_without_the_autopilot_of_a_type_is_refused(flight):
    type = replace(quad(**{"mavlink.autopilot": "px4"}), name="Zeppelin", metaclasses=TYPE.metaclasses)
    (refusal, *_) = MAVLINK_PYTHON.refusals(replace(flight, types={"Zeppelin": type}))
    assert refusal == "robot 'alpha': mavlink.autopilot is 'px4', with which no profile of airship is known"


@contextmanager
def aloft(**about):
    """Give an airship at the end of a link, and its wire."""
    told = {"kind": MAV_TYPE_AIRSHIP, "autopilot": MAV_AUTOPILOT_AIRSHIPS, "mode": 32, "armed": True, **about}

    def answer(message):
        if message.get_type() == "PARAM_SET":
            yield value(message.param_id, message.param_value)
        if message.get_type() == "PARAM_REQUEST_READ" and message.param_id == "MOOR_ON_LOSS":
            yield value("MOOR_ON_LOSS", 2.0)
        if message.get_type() == "COMMAND_LONG":
            if message.command == mavlink.MAV_CMD_DO_SET_MODE:
                wire.beat(**{**told, "mode": int(message.param2)})
            yield acknowledged(message.command)

    with linked(answer) as (link, wire):
        robot = robot_of(vehicle="airship", driven_by=PROFILE.source)
        vehicle = MavlinkVehicle(link, robot.profile, robot.home)
        begun = link.clock.now()
        wire.beat(**told)
        eventually(lambda: link.clock.now() - link.since("HEARTBEAT") > begun)
        yield vehicle, link, wire


def test_its_modes_are_those_of_its_profile():
    with aloft() as (vehicle, _, wire):
        assert vehicle.state().mode == modes.HOLD
        vehicle._mode_control.enter(modes.GUIDED)
        (asked,) = (each for each in wire.of("COMMAND_LONG") if each.command == mavlink.MAV_CMD_DO_SET_MODE)
        assert asked.param2 == 31.0
        assert vehicle.state().mode == modes.GUIDED


def test_its_failsafe_for_a_lost_link_is_set_by_its_own_parameter():
    with aloft() as (vehicle, link, wire):
        vehicle.answer_lost_link("LAND")
        sent = {each.param_id: each.param_value for each in wire.of("PARAM_SET")}
        assert sent["MOOR_ON_LOSS"] == 2.0
        assert vehicle.modes_alone == {33}
        assert list(report_failsafes(link)) == ["MOOR_ON_LOSS = 2: no ground station: moor"]


def test_a_target_is_sent_again_after_the_seconds_of_its_profile():
    with aloft() as (vehicle, link, wire):

        def stand(milliseconds):
            place = (423_700_000, 133_500_000, 0, 0)
            wire.say(mavlink.MAVLink_global_position_int_message(milliseconds, *place, 0, 0, 0, 0))

        stand(1)
        eventually(lambda: link.latest("GLOBAL_POSITION_INT"))
        begun, ended, told = link.clock.now(), RefusedError("enough"), [0]

        def guard():
            passed = link.clock.now() - begun
            if passed > 0.5:
                raise ended
            if passed > told[-1] + 0.02:
                told.append(passed)
                stand(round(1000.0 * passed))

        link.guard = guard
        with pytest.raises(RefusedError, match="enough"):
            vehicle.go_to(NORTH, None, None, False)
        assert len(wire.of("SET_POSITION_TARGET_GLOBAL_INT")) >= 3


def test_it_is_guided_by_the_guidance_of_its_autopilot():
    with aloft() as (vehicle, _, _):
        assert isinstance(vehicle._mode_control.guidance, Buoyant)


@pytest.mark.parametrize(
    ("about", "why"),
    [
        (
            {"kind": mavlink.MAV_TYPE_QUADROTOR},
            "the vehicle reports the type 'quadrotor'; the program is for vehicle 'airship'",
        ),
        ({"autopilot": 3}, "the vehicle has autopilot 3 .* is for a airship with Airship Pilot"),
    ],
)
def test_no_other_vehicle_is_taken_for_it(about, why):
    with aloft(**about) as (vehicle, link, _), pytest.raises(RefusedError, match=why):
        check_identity(link, vehicle.telemetry, 20.0, vehicle.start, vehicle.start)


def test_a_profile_of_a_plug_in_that_is_missing_is_named():
    with pytest.raises(ValueError, match="mmrs_zeppelins:ZEPPELIN: cannot be imported: No module"):
        _ = robot_of(vehicle="zeppelin", driven_by="mmrs_zeppelins:ZEPPELIN").profile


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_what_a_vehicle_does_by_its_failsafes_it_does_on_command(profile):
    assert profile.alone <= profile.responses
    assert {profile.down, *profile.breach} <= profile.responses


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_there_is_a_simulated_vehicle_to_rehearse_with(profile):
    pilot = SimulatedAutopilot(Settings(kind=profile.rehearsed_as, firmware=profile.rehearsed_with))
    assert pilot.settings.kind == profile.vehicle
