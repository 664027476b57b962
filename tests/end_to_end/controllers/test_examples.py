"""The examples' controllers: made from the models, run, and judged by the replayer."""

from __future__ import annotations

from functools import cache
from math import hypot, inf

import pytest
from shapely import Point, Polygon

from mmrs_core import pipeline
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.resources import shipped
from mmrs_core.scene import AreaUse

SLACK = 0.6
"""Metres that a vehicle may be off its leg: the radius in which places count as reached, and a little."""

EXAMPLES = ("carbon-dioxide", "drone-and-rover", "mixed-team", "pool", "solar-park")


@pytest.fixture(scope="module")
def planned(contributions):
    """Return a function that gives the behaviour of an example, and the place it is for."""

    @cache
    def plan(example: str):
        models, _ = pipeline.valid_models(shipped("examples") / example, contributions)
        scene = pipeline.expand(pipeline.ground(models), contributions)
        behaviour, _ = pipeline.transform(scene, pipeline.plan(scene), contributions)
        return pipeline.program_of(behaviour, contributions), pipeline.place_of_scene(scene)

    return plan


@pytest.fixture
def made(planned, contributions, controllers):
    """Return a function that makes the controllers of an example, with all that only users can say."""

    def make(example: str):
        program, place = planned(example)
        files = pipeline.render(program, place, "mavlink-python", contributions)
        made = controllers(program, files=files)
        made.types = place.types
        made.areas = [area for area in place.areas if area.use is not AreaUse.EMERGENCY]
        for name, word, answer in (
            ("conditions.py", ": undecided,", ": lambda state: True,"),
            ("objects.py", ": not_looked_for,", ": where_expected,"),
        ):
            path = made.folder / name
            if path.exists():
                path.write_text(path.read_text("ascii").replace(word, answer), "ascii")
        return made

    return make


@pytest.mark.parametrize("example", EXAMPLES)
def test_a_dry_run_of_an_example_replays(made, example):
    controllers = made(example)
    code, said = controllers.run("fleet.py", "--dry-run", "--speedup", "2000")
    assert code == 0, said
    result = replay(controllers.program, read_logs([controllers.logs]))
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


@pytest.mark.thorough
@pytest.mark.parametrize("example", EXAMPLES)
def test_an_example_flies_and_its_logs_replay(made, hangar, example):
    controllers = made(example)
    vehicles, links = hangar(controllers.program, 25.0, types=controllers.types, energy=20_000.0)
    code, said = controllers.run("fleet.py", *links, patience=280.0)
    assert code == 0, said
    result = controllers.replayed()
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())
    assert not any(vehicle.autopilot.armed for vehicle in vehicles.values())
    for robot in controllers.program.robots:
        assert vehicles[robot.id].autopilot.track
        needed = controllers.types[robot.type_name].half_diagonal + controllers.program.position_error
        for area in (each for each in controllers.areas if each.concerns(robot.type_name)):
            margin = least_margin(vehicles[robot.id].autopilot.track, robot.home, area, needed)
            assert margin >= -SLACK, f"{robot.id} is {-margin:.2f} m too close to {area.name}"


def least_margin(track, home, area, needed: float) -> float:
    """Return how much farther from an area than it must be a track stays, metres."""
    shape = Polygon(area.shell)
    margins = []
    for _, north, east, up in track:
        aside = shape.distance(Point(home[0] + east, home[1] + north))
        height = home[2] + up
        above = max(height - area.high, area.low - height, 0.0)
        margins.append(hypot(aside, above) - area.safety_distance - needed)
    return min(margins, default=inf)
