"""Simulated vehicles that hit what is in their water."""

from pathlib import Path

import pytest
from dives import dive, rehearse, swim

from auv_vessel.body.surroundings import Obstacle, Surroundings, to_json
from mmrs_runtime.semantics import Outcome


@pytest.mark.parametrize(("north", "outcome"), [(0.1, Outcome.FAILED), (1.0, Outcome.SUCCESS)])
def test_a_vehicle_does_not_go_through_obstacles(tmp_path: Path, north: float, outcome: Outcome) -> None:
    post = Obstacle(north, 2.0, 0.05, 1.0, 2.5)
    file = tmp_path / "pool.json"
    file.write_text(to_json(Surroundings(bottom=4.0, obstacles=(post,))))
    found = rehearse(dive(swim("out", 4.0, 0.0, 1.5)), tmp_path / "logs", surroundings=str(file))
    assert found.run.ending.outcome is outcome
    assert found.accepted
    assert found.fault == ("CRASHED" if outcome is Outcome.FAILED else "")


@pytest.mark.thorough
def test_a_vehicle_that_pressed_on_the_bottom_comes_up(tmp_path: Path) -> None:
    found = rehearse(dive(swim("out", 2.0, 0.0, 2.6)), tmp_path, bottom="2.5", noise="no")
    vehicle = found.robots["naiad"].stage.vehicle
    assert found.fault == "NO_PROGRESS"
    assert vehicle.truth.depth < 0.5
