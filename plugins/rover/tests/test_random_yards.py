"""Rovers among random terrain, from the scene to the end of the run."""

from math import dist

import pytest
import shapely
from counts import many
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mmrs_core import pipeline
from mmrs_core.behaviour.replay import replay
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import (
    Battery,
    Capability,
    Device,
    DeviceAction,
    Frame,
    Part,
    Robot,
    RobotType,
    Scene,
    Task,
)

ROVER = (("urn:mmrs:rover:1.0", "Rover"), ("urn:mmrs:robot:1.0", "Robot"))
TERRAIN = (("urn:mmrs:rover:1.0", "Terrain"), ("urn:mmrs:context:1.0", "ContextElement"))
MEASURE = (("urn:mmrs:survey:1.0", "MeasureTask"), ("urn:mmrs:mission:1.0", "Task"))
SIDE = 100.0
"""Metres."""

places = st.tuples(st.integers(0, int(SIDE)), st.integers(0, int(SIDE))).map(
    lambda at: (*map(float, at), 0.0)
)


def rovers(radius, wades, acceleration):
    figures = Capability(0.0, 20_000.0, (0.0, 2.0), acceleration=acceleration)
    gas = Device("gas", {"Sample": DeviceAction("Sample", 5.0)}, {})
    limits = {"turningRadius": radius, "wadingDepth": wades, "communicationRange": 1000.0}
    part = Part(ROVER, {"drive": "WHEELS", **limits})
    return RobotType("Rover", ROVER, (), 0.5, None, (figures,), (Battery(4e6, None),), {"gas": gas}, part)


@st.composite
def yards(draw):
    """Draw a scene: one or two rovers on the western side, terrain, and places to measure."""
    kind = rovers(
        draw(st.sampled_from([0.0, 0.8, 2.5])),
        draw(st.sampled_from([None, 0.3])),
        draw(st.sampled_from([None, 0.3, 2.0])),
    )
    team = tuple(
        Robot(f"r{k}", kind, (-20.0, 40.0 * k, 0.0), True, 0.0, "NORMAL", 0.5 + 0.2)
        for k in range(draw(st.integers(1, 2)))
    )
    elements = []
    for k in range(draw(st.integers(0, 4))):
        (east, north, _), wide, deep = draw(places), draw(st.integers(3, 40)), draw(st.integers(3, 40))
        shell = tuple((east + x * wide, north + y * deep, 0.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
        depth, safety = draw(st.sampled_from([0.2, 1.0])), draw(st.sampled_from([0.0, 1.5]))
        stated = {"name": f"pond {k}", "shell": shell, "waterDepth": depth, "safetyDistance": safety}
        elements.append(Part(TERRAIN, stated))
    points = tuple(draw(st.lists(places, min_size=1, max_size=5, unique=True)))
    measure = Part(MEASURE, {"points": points, "actionName": "Sample", "deviceId": "gas"})
    return Scene(
        "yard",
        Frame("EPSG:4326", None, None),
        (Task("readings", measure),),
        (),
        team,
        elements=tuple(elements),
        position_error=0.2,
        minimum_separation=draw(st.sampled_from([None, 3.0])),
    )


def carried_out(scene, contributions):
    """Return expanded scene, plan, behaviour and verdicts; None where no rover gets to a place."""
    try:
        scene = pipeline.expand(scene, contributions)
        plan = pipeline.plan(scene)
    except InfeasibleError:
        return None
    behaviour, _ = pipeline.transform(scene, plan, contributions)
    program = pipeline.program_of(behaviour, contributions)
    return scene, plan, program, pipeline.verify(program, pipeline.place_of_scene(scene), contributions)


def judge(scene, contributions):
    found = carried_out(scene, contributions)
    assume(found is not None)
    scene, plan, program, verdicts = found
    assert [each.message for each in pipeline.refusals(verdicts, program)] == []
    run = pipeline.simulate(program, pipeline.place_of_scene(scene), contributions)
    assert replay(program, run.records).complaints == ()
    assert run.ending.outcome.value == "success"
    # The plan ends where the last rover is back, its motors still on. It knows no headings: it expects of a
    # rover that drives round that it is on its leg already.
    kinematics = [scene.robot(each.id).kinematics for each in program.robots]
    stopping = max(each.recovery for each in kinematics)
    turning = sum(len(one.moves) * of.shunting for one, of in zip(program.robots, kinematics, strict=True))
    assert run.ending.time <= plan.makespan + stopping + turning + 1e-3
    for name, track in run.tracks.items():
        assert_clear(scene, scene.robot(name), track)


def assert_clear(scene, robot, track):
    way = [sample.position[:2] for sample in track]
    for area in scene.kept_from(robot):
        kept = shapely.Polygon(area.shell).distance(shapely.LineString([way[0], *way]))
        assert kept >= area.safety_distance + robot.clearance - 1e-2, area.name
    assert dist(track[-1].position, robot.home) < 1e-2


@pytest.fixture(scope="module")
def everything(contributions):
    return contributions


@given(scene=yards())
@settings(max_examples=many(400, fast=15))
def test_rovers_go_round_what_they_cannot_pass(everything, scene):
    judge(scene, everything)


@given(scene=yards())
@settings(max_examples=15, deadline=None)
def test_a_rover_that_wades_deeper_meets_no_more_barriers(everything, scene):
    shallow = len(pipeline_areas(scene, everything, 0.3))
    assert len(pipeline_areas(scene, everything, 0.9)) == shallow
    assert len(pipeline_areas(scene, everything, 1.0)) == 0


def pipeline_areas(scene, contributions, wades):
    from mmrs_core.contributions.rules import barriers

    return barriers(scene.elements, (), [rovers(1.0, wades, None)], contributions.robot_kinds, {})
