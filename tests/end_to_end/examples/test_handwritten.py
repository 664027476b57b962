import pytest

from mmrs_core import pipeline
from mmrs_core.analysis.constraints import check_behaviour
from mmrs_core.behaviour.replay import replay
from mmrs_core.grounding.scenes import robot_type_of
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.reading import read_model
from mmrs_core.simulation.run import simulate

pytestmark = pytest.mark.together("examples")


@pytest.fixture(scope="module")
def model(contributions, folder_of):
    return read_model(folder_of("handwritten") / "behaviour.xmi", contributions.languages)


@pytest.fixture(scope="module")
def robots(contributions, folder_of):
    files = sorted((folder_of("handwritten") / "robots").glob("*.xmi"))
    return [read_model(file, contributions.languages).roots[0] for file in files]


@pytest.fixture(scope="module")
def program(model, contributions):
    return pipeline.program_of(model.roots[0], contributions)


@pytest.fixture(scope="module")
def place(robots):
    return pipeline.BehaviourContext({robot.name: robot_type_of(robot) for robot in robots}, ())


def test_it_is_valid(model, contributions):
    assert (*model.diagnostics, *check_conformance(model, contributions.languages)) == ()


def test_it_keeps_every_constraint(model, robots, contributions):
    types = {robot.name: robot for robot in robots}
    found = check_behaviour(model.roots[0], contributions.constraints, contributions.languages, robots=types)
    assert found == ()


def test_nothing_stands_against_it(program, place, contributions):
    assert pipeline.refusals(pipeline.verify(program, place, contributions), program) == ()


def test_its_run_succeeds_and_replays(program, place, contributions):
    run = pipeline.simulate(program, place, contributions)
    assert run.ending.outcome.value == "success"
    assert replay(program, run.records).complaints == ()


@pytest.mark.parametrize(("energetic", "closer"), [(True, True), (False, False)])
def test_the_leader_goes_closer_only_with_energy_left(program, place, contributions, energetic, closer):
    from mmrs_core.contributions.execution import Condition

    answer = {"energy_above_100_kJ": Condition("energy_above_100_kJ", lambda state: energetic)}
    given, backend = pipeline.input_of(program, place, contributions), contributions.vehicles["simulation"]
    run = simulate(given, backend, conditions=answer)
    assert any(record.move == "closer" for record in run.records) is closer


def test_the_leader_resets_what_nobody_waits_for_any_more(program):
    resets = [
        action.sets
        for robot in program.robots
        for move in robot.moves
        for action in move.after
        if action.sets and not action.active
    ]
    assert [set(slots) for slots in resets] == [{("left", "ready"), ("right", "begin")}]
