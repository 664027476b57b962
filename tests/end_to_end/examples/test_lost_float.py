"""A drone finds, an underwater vehicle goes and looks: both in simulated time, over one bus."""

import json
from dataclasses import dataclass
from math import hypot
from pathlib import Path

import pytest

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_core.cli.examples import example_folder
from mmrs_core.cli.simulation import write_logs
from mmrs_core.pipeline import simulate
from mmrs_core.simulation.run import SimulatedRun
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.together("examples")

FOLDER = example_folder("lost-float")
FLOAT = (23.5, 27.5)
NEAR = 2.5
"""Metres from the float within which the vehicle has been once it has held before it."""


@dataclass
class Search:
    """A run, what was chosen, and how near the vehicle came to a place at most."""

    run: SimulatedRun
    accepted: bool

    @property
    def chosen(self) -> list[str]:
        return [each.detail for each in self.run.records if each.label == "choose"]

    @property
    def depths(self) -> list[float]:
        return [-each.up for each in self.run.tracks["Otter"]]

    def nearest(self, east: float, north: float) -> float:
        return min(hypot(each.east - east, each.north - north) for each in self.run.tracks["Otter"])


@pytest.fixture
def search(taken, contributions, tmp_path):
    """Return the search of the example with other surroundings of both robots."""

    def carry_out(by_drone: Path, by_vehicle: Path, **options: str) -> Search:
        example = taken("lost-float")
        own = {"surroundings": str(by_vehicle), "objects": "seen", **options}
        run = simulate(
            example.program,
            example.place,
            contributions,
            own_backends={"Otter": "can-sim"},
            options={"Gull:surroundings": str(by_drone), **{f"Otter:{k}": v for k, v in own.items()}},
        )
        write_logs(run, example.program, tmp_path / "logs", example.place.types)
        return Search(run, replay(example.program, read_logs([tmp_path / "logs"])).accepted)

    return carry_out


@pytest.fixture
def bay(tmp_path):
    """Return a file of the bay with floats at these places (east, north)."""

    def write(*places: tuple[float, float]) -> Path:
        found = json.loads((FOLDER / "surroundings.json").read_text())
        float_ = found["things"][0]
        found["things"] = [{**float_, "east": east, "north": north} for east, north in places]
        path = tmp_path / f"bay-{len(list(tmp_path.iterdir()))}.json"
        path.write_text(json.dumps(found))
        return path

    return write


def test_the_vehicle_goes_to_where_the_drone_has_seen_the_float(search, bay):
    there = bay(FLOAT)
    found = search(there, there)
    assert found.run.ending.outcome is Outcome.SUCCESS, found.run.ending
    assert found.accepted
    assert found.chosen == ["true"]
    assert found.nearest(*FLOAT) < NEAR
    assert max(found.depths) > 5.0
    assert found.depths[-1] < 0.6


@pytest.mark.thorough
def test_without_a_float_the_vehicle_stays_at_the_jetty(search, bay):
    empty = bay()
    found = search(empty, empty)
    assert found.run.ending.outcome is Outcome.SUCCESS, found.run.ending
    assert found.accepted
    assert found.chosen == ["false"]


@pytest.mark.thorough
def test_a_float_that_has_sunk_meanwhile_is_searched_for_where_the_drone_saw_it(search, bay):
    found = search(bay(FLOAT), bay())
    assert found.accepted
    assert found.nearest(*FLOAT) < 3.0
    fault = found.run.ending.faults["Otter"]
    assert fault.which == "OBJECT_NOT_FOUND"
    assert fault.reason == "object 'lost float' is not seen where it is expected"
    assert found.depths[-1] < 0.6


@pytest.mark.thorough
def test_a_float_beside_where_the_drone_saw_it_is_found_by_the_vehicle_itself(search, bay):
    moved = (FLOAT[0] - 2.5, FLOAT[1] - 2.0)
    found = search(bay(FLOAT), bay(moved))
    assert found.run.ending.outcome is Outcome.SUCCESS, found.run.ending
    assert found.nearest(*moved) < NEAR
