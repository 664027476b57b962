"""The shipped examples, taken through every stage once for all tests."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import pytest

from mmrs_core import pipeline
from mmrs_core.languages.reading import read_model
from mmrs_core.resources import shipped

MISSIONS = (
    "carbon-dioxide",
    "pool",
    "mixed-team",
    "solar-park",
    "drone-and-rover",
    "outfall",
    "pool-course",
    "two-auv-survey",
    "lost-float",
    "barn",
    "ridge",
)
ASSUMED = {"Lost float": {"found:lost float": True}}
"""What choices ask that nobody else can answer, by mission."""


@dataclass(frozen=True)
class Taken:
    """What every stage made of an example."""

    models: object
    faults: tuple
    scene: object
    plan: object
    behaviour: object
    trace: object
    program: object
    place: pipeline.BehaviourContext
    verdicts: tuple


@pytest.fixture(scope="session")
def folder_of():
    """Return the folder of an example by name."""
    return lambda name: shipped("examples") / name


@pytest.fixture(scope="session")
def taken(contributions, folder_of):
    """Return an example of a mission after every stage up to verification, by name."""

    @cache
    def take(name):
        models, faults = pipeline.valid_models(folder_of(name), contributions)
        scene = pipeline.expand(pipeline.ground(models), contributions)
        plan = pipeline.plan(scene)
        behaviour, trace = pipeline.transform(scene, plan, contributions)
        program = pipeline.program_of(behaviour, contributions)
        place = pipeline.place_of_scene(scene)
        verdicts = pipeline.verify(program, place, contributions)
        return Taken(models, faults, scene, plan, behaviour, trace, program, place, verdicts)

    return take


@pytest.fixture(scope="session", params=MISSIONS)
def example(request, taken):
    """Return each example of a mission after every stage."""
    return taken(request.param)


@pytest.fixture(scope="session")
def run_of(contributions):
    """Return the simulated run of an example."""
    runs = {}

    def simulate(example):
        if id(example) not in runs:
            runs[id(example)] = pipeline.simulate(
                example.program, example.place, contributions, assume=ASSUMED.get(example.scene.name)
            )
        return runs[id(example)]

    return simulate


@pytest.fixture(scope="session")
def read(contributions):
    """Return the roots of every model file of an example's folder."""

    def roots(folder):
        files = sorted(folder.rglob("*.xmi"))
        return [
            root for file in files for root in read_model(file, contributions.languages, root=folder).roots
        ]

    return roots
