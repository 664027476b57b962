import ast
import json
from itertools import pairwise
from math import dist, hypot

import pytest
import shapely

from mmrs_core import pipeline
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.checks import Status
from mmrs_core.contributions.execution import Condition
from mmrs_core.diagnostics import Severity
from mmrs_core.planning.charges import Charges
from mmrs_core.planning.planner import plan
from mmrs_core.planning.team import Team
from mmrs_core.scene import Serve, Signal, Step, all_steps
from mmrs_core.simulation.run import simulate

pytestmark = pytest.mark.together("examples")

JUSTIFIED_UNKNOWNS = {
    name: {"range"} for name in ("Objects in the pool", "Outfall", "Course", "Two fields", "Lost float")
}

LONGEST = {
    "Carbon dioxide near L'Aquila": 1461.0,
    "Course": 143.0,
    "Dam inspection": 3491.0,
    "Hot spots behind a ridge": 667.5,
    "Lost float": 140.0,
    "Objects in the pool": 368.0,
    "Outfall": 1149.0,
    "Photos of a farm": 1121.0,
    "Recycling yard after a fire": 504.0,
    "Thermal inspection": 501.0,
    "Two fields": 199.0,
}
"""Seconds that missions take at most, by name: as simulated so far, rounded up."""


def test_it_is_valid_without_a_warning(example):
    assert [each for each in example.faults if each.severity is not Severity.NOTE] == []


def served(steps):
    for step in steps:
        if isinstance(step, Serve):
            yield step.task
        for _, inner in getattr(step, "arms", ()):
            yield from served(inner)


def test_every_task_is_served(example):
    tasks = {name for name, _ in example.scene.works}
    assert {task for robot in example.plan.robots for task in served(robot.steps)} == tasks


def test_every_robot_has_something_to_do(example):
    assert all(any(isinstance(step, Step) for step in robot.steps) for robot in example.plan.robots)


def test_no_mission_takes_longer_than_it_did(example):
    assert example.timed.makespan <= LONGEST[example.scene.name]


def test_nothing_stands_against_the_behaviour(example):
    assert pipeline.refusals(example.verdicts, example.program) == ()


def test_the_planner_counts_charges_as_the_check_does(example):
    pilots = Team(example.scene).pilots
    used = Charges(pilots).most_used(example.plan)
    for verdict in example.verdicts:
        if verdict.property == "endurance" and verdict.margin is not None:
            kinematics = pilots[verdict.robot].kinematics
            checked = kinematics.endurance - verdict.margin
            assert used[verdict.robot] > checked - 0.01
            # The check knows what thrust an underwater vehicle begins its legs with, and where a car looks.
            assert kinematics.timing.lag or kinematics.turning_radius or used[verdict.robot] < checked + 0.01


def test_only_what_the_mission_accepts_is_unknown(example):
    unknown = {verdict.property for verdict in example.verdicts if verdict.status is Status.UNKNOWN}
    assert unknown == JUSTIFIED_UNKNOWNS.get(example.scene.name, set())


@pytest.mark.parametrize(
    "name",
    [
        *("drone-and-rover", "outfall", "two-auv-survey"),
        *(pytest.param(name, marks=pytest.mark.thorough) for name in ("mixed-team", "solar-park")),
    ],
)
def test_planning_twice_gives_the_same_plan(taken, name):
    assert plan(taken(name).scene) == taken(name).plan


def test_the_behaviour_survives_a_file(example, contributions, tmp_path):
    from mmrs_core.languages.reading import read_model

    pipeline.save(example.behaviour, tmp_path / "behaviour.xmi", contributions)
    again = read_model(tmp_path / "behaviour.xmi", contributions.languages)
    assert again.diagnostics == ()
    program = pipeline.program_of(again.roots[0], contributions)
    for before, after in zip(example.program.robots, program.robots, strict=True):
        assert [move.id for move in after.moves] == [move.id for move in before.moves]
        assert [each.next_moves for each in after.transitions.values()] == [
            each.next_moves for each in before.transitions.values()
        ]


def test_the_simulated_run_succeeds_and_its_log_replays(example):
    run = example.run
    assert run.ending.outcome.value == "success"
    result = replay(example.program, run.records)
    assert result.complaints == ()
    assert result.outcome.value == "success"


def test_the_simulated_run_lasts_about_as_long_as_planned(example):
    # Turns are planned for at their longest, and objects wherever they may be.
    assert 0.75 * example.plan.makespan <= example.run.ending.time <= 1.1 * example.plan.makespan


def test_the_simulated_run_lasts_as_long_as_mmrs_plan_says(example, contributions):
    run, told = pipeline.simulate(example.program, example.place, contributions), example.timed
    assert told.makespan == pytest.approx(run.ending.time, rel=0.01)
    for robot in told.robots:
        track = run.tracks.get(robot.robot, ())
        moving = [one.time for one, two in pairwise(track) if one.position != two.position]
        assert robot.busy <= max((sample.time for sample in track), default=0.0) + 1e-6
        assert robot.busy > 0.0 or not moving
        assert all(one.end <= two.begin + 1e-6 for one, two in pairwise(robot.steps))
        idle = (two.begin - one.end for one, two in pairwise(robot.steps) if not isinstance(two, Signal))
        assert sum(idle, 0.0) < 1.0


def test_an_orbit_takes_as_long_as_planned_though_the_robot_does_not_stop_on_it(taken):
    example = taken("barn")
    planned, told = (
        [
            each.end - each.begin
            for robot in plan.robots
            for each in robot.steps
            if isinstance(each, Serve) and each.stroke.look is not None
        ]
        for plan in (example.plan, example.timed)
    )
    assert planned
    assert told == pytest.approx(planned, rel=0.03)


def test_the_preview_says_when_each_step_is_simulated_to_be_made(taken):
    example = taken("carbon-dioxide")
    moves = example.trace.moves()
    ends = {
        (each.robot, each.move): each.time
        for each in example.run.records
        if each.label in ("end", "act", "ntf")
    }
    for robot in example.timed.robots:
        for number, step in enumerate(all_steps(robot.steps)):
            own = moves.get((robot.robot, number))
            if own and step is not robot.steps[-1]:
                assert step.end == ends[robot.robot, own[-1]]


def test_no_simulated_track_comes_into_a_forbidden_area(example):
    for name, track in example.run.tracks.items():
        robot = example.scene.robot(name)
        clearance = robot.clearance
        for area in example.scene.kept_from(robot):
            shape = shapely.Polygon(area.shell)
            kept = area.safety_distance + clearance
            for sample in track:
                east, north, up = sample.position
                level = shape.distance(shapely.Point(east, north))
                above = max(area.low - up, up - area.high, 0.0)
                assert hypot(level, above) >= kept - 0.3, (name, area.name, sample)


def test_every_robot_that_is_to_return_is_home_at_the_end(example):
    for robot in example.program.robots:
        if not example.scene.robot(robot.id).return_home:
            continue
        end = example.run.tracks[robot.id][-1].position
        assert dist(end, robot.home) < 0.5


def test_controllers_for_mavlink_compile(example, contributions):
    # Objects are found by the vehicle itself, which no MAVLink vehicle can: such steps are lossy.
    lossy = any(
        move.target and move.target.description for robot in example.program.robots for move in robot.moves
    )
    files = pipeline.render(
        example.program, example.place, "mavlink-python", contributions, allow_lossy=lossy
    )
    programs = [file for file in files if file.path.endswith(".py")]
    assert len(programs) > len(example.program.robots)
    for file in programs:
        ast.parse(file.content, file.path)


def test_ground_station_plans_hold_every_robot_that_flies(taken, contributions):
    example = taken("carbon-dioxide")
    files = pipeline.render(example.program, example.place, "qgc-plan", contributions, allow_lossy=True)
    plans = [json.loads(file.content) for file in files if file.path.endswith(".plan")]
    assert len(plans) == 3
    assert all(plan["fileType"] == "Plan" and len(plan["mission"]["items"]) > 50 for plan in plans)
    assert all(len(plan["geoFence"]["polygons"]) == 1 for plan in plans)
    assert all(len(plan["rallyPoints"]["points"]) == 2 for plan in plans)


def test_samples_cover_every_field_of_the_carbon_dioxide_mission(taken):
    scene = taken("carbon-dioxide").scene
    for (task, _), work in scene.works.items():
        if work.coverage is None:
            continue
        assert (work.coverage.width, work.coverage.length) == (12.0, 12.0), task


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("carbon-dioxide", {"multicopter"}),
        ("pool", {"auv"}),
        ("mixed-team", {"multicopter", "auv", "plain_robot"}),
        ("solar-park", {"multicopter"}),
        ("drone-and-rover", {"multicopter", "rover"}),
        ("outfall", {"auv"}),
        ("pool-course", {"auv"}),
        ("two-auv-survey", {"auv"}),
        ("lost-float", {"multicopter", "auv"}),
        ("barn", {"multicopter"}),
        ("ridge", {"multicopter"}),
    ],
)
def test_the_kinds_of_robots_are_those_that_the_example_is_for(taken, name, kinds):
    assert {robot.kind for robot in taken(name).scene.robots} == kinds


def test_a_small_battery_makes_a_drone_of_the_mixed_team_recharge(taken):
    plan = taken("mixed-team").plan
    assert max(robot.sorties for robot in plan.robots) >= 2


@pytest.mark.parametrize(("energetic", "task"), [(True, "landslide scar"), (False, "over the car park")])
def test_the_choice_of_the_mixed_team_leads_to_the_task_of_its_arm(taken, contributions, energetic, task):
    example = taken("mixed-team")
    given = pipeline.input_of(example.program, example.place, contributions)
    answer = {"energy_above_100_kJ": Condition("energy_above_100_kJ", lambda state: energetic)}
    run = simulate(given, contributions.vehicles["simulation"], conditions=answer)
    moves = {(robot.id, move.id): move.task for robot in example.program.robots for move in robot.moves}
    done = {moves[record.robot, record.move] for record in run.records}
    assert run.ending.outcome.value == "success"
    assert done & {"landslide scar", "over the car park"} == {task}
