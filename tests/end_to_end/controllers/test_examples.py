"""The examples' controllers: made from the models, run, and judged by the replayer."""

from functools import cache

import pytest
from example_flight.mission import SLACK, margins

from mmrs_core import pipeline
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_core.resources import shipped
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("controllers")

EXAMPLES = ("carbon-dioxide", "drone-and-rover", "mixed-team", "outfall", "pool", "solar-park")
OTHERS = ("carbon-dioxide", "mixed-team", "outfall", "solar-park")


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
        made.place = place
        for name, word, answer in (
            ("conditions.py", ": undecided,", ": lambda state: True,"),
            ("objects.py", ": not_looked_for,", ": where_expected,"),
        ):
            path = made.folder / name
            if path.exists():
                path.write_text(path.read_text("ascii").replace(word, answer), "ascii")
        return made

    return make


@pytest.mark.parametrize(
    "example",
    ["drone-and-rover", "pool", *(pytest.param(each, marks=pytest.mark.thorough) for each in OTHERS)],
)
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
    vehicles, links = hangar(controllers.program, 25.0, types=controllers.place.types, energy=20_000.0)
    code, said = controllers.run("fleet.py", *links, patience=280.0)
    assert code == 0, said
    result = controllers.replayed()
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())
    assert not any(vehicle.autopilot.armed for vehicle in vehicles.values())
    for robot in controllers.program.robots:
        track = vehicles[robot.id].autopilot.track
        assert len(track) > 100
        for area, margin in margins(controllers.program, controllers.place, robot.id, track).items():
            assert margin >= -SLACK, f"{robot.id} is {-margin:.2f} m too close to {area}"
