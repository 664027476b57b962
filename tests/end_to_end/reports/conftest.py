"""A behaviour with the logs and black boxes of a simulated run of it."""

import shutil

import pytest

from mmrs_core.cli import run
from mmrs_core.resources import shipped


@pytest.fixture
def mmrs(capsys):
    """Return a function that runs a command line: exit code, standard output, standard error."""

    def call(*arguments):
        code = run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


@pytest.fixture
def project(tmp_path, mmrs):
    """Return a folder with a behaviour written by hand, its place, its types, and logs of a run."""
    folder = shutil.copytree(shipped("examples") / "handwritten", tmp_path / "project")
    assert mmrs("simulate", folder, "-o", folder / "logs")[0] == 0
    return folder
