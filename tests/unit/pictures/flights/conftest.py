"""Runs of two drones, simulated, with their logs and black boxes in a folder."""

import pytest

from mmrs_core.cli.simulation import write_logs


@pytest.fixture
def folder(run, behaviour, types, tmp_path):
    write_logs(run, behaviour, tmp_path / "logs", types)
    return tmp_path / "logs"
