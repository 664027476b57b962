"""A copy of the example that needs no planning."""

import shutil

import pytest

from mmrs_core.cli import run
from mmrs_core.resources import shipped


@pytest.fixture
def project(tmp_path):
    """Return a folder with a behaviour written by hand, its place and its types of robot."""
    return shutil.copytree(shipped("examples") / "handwritten", tmp_path / "project")


@pytest.fixture
def mmrs(capsys):
    """Return a function that runs a command line: exit code, standard output, standard error."""

    def call(*arguments, program="mmrs"):
        code = run([str(argument) for argument in arguments], program=program)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call
