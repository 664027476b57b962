"""Runs of two drones, simulated, with their logs and black boxes in a folder."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mmrs_core.cli.simulation import write_logs
from mmrs_core.pipeline import Place, simulate
from mmrs_core.scene import Part
from mmrs_core.testing.programs import MULTICOPTER, areas, quad, two_drones


@pytest.fixture(scope="session")
def types():
    attributes = {"maxAltitude": 120.0}
    return {"Quad": replace(quad(), part=Part(((MULTICOPTER, "Drone"),), attributes))}


@pytest.fixture(scope="session")
def place(types):
    return Place(types, areas(), {})


@pytest.fixture(scope="session")
def behaviour():
    return two_drones()


@pytest.fixture(scope="session")
def run(behaviour, place, contributions):
    return simulate(behaviour, place, contributions)


@pytest.fixture
def folder(run, behaviour, types, tmp_path):
    write_logs(run, behaviour, tmp_path / "logs", types)
    return tmp_path / "logs"
