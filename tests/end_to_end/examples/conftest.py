"""The shipped examples, taken through every stage once for all tests."""

from functools import cache, cached_property

import pytest

from mmrs_core import pipeline
from mmrs_core.languages.reading import read_model
from mmrs_core.resources import shipped
from mmrs_core.stages import Stages

MISSIONS = sorted(file.parent.name for file in shipped("examples").glob("*/mission.xmi"))
ASSUMED = {"Lost float": {"found:lost float": True}}
"""What choices ask that nobody else can answer, by mission."""


class Example(Stages):
    """An example, every stage of which is made once."""

    def __init__(self, folder, contributions):
        models, self.faults = pipeline.valid_models(folder, contributions)
        super().__init__(lambda: models, contributions)

    @property
    def behaviour(self):
        return self.transformed[0]

    @property
    def trace(self):
        return self.transformed[1]

    @cached_property
    def run(self):
        """The simulated run."""
        assumed = ASSUMED.get(self.scene.name)
        return pipeline.simulate(self.program, self.place, self._contributions, assume=assumed)


@pytest.fixture(scope="session")
def folder_of():
    """Return the folder of an example by name."""
    return lambda name: shipped("examples") / name


@pytest.fixture(scope="session")
def taken(contributions, folder_of):
    """Return an example of a mission by name."""
    return cache(lambda name: Example(folder_of(name), contributions))


@pytest.fixture(scope="session")
def missions():
    """Return the names of the examples of missions."""
    return MISSIONS


@pytest.fixture(scope="session", params=MISSIONS)
def example(request, taken):
    """Return each example of a mission."""
    return taken(request.param)


@pytest.fixture(scope="session")
def read(contributions):
    """Return the roots of every model file of an example's folder."""

    def roots(folder):
        files = sorted(folder.rglob("*.xmi"))
        return [
            root for file in files for root in read_model(file, contributions.languages, root=folder).roots
        ]

    return roots
