"""What the installed plug-ins contribute, and the command line."""

import pytest

from mmrs_core.cli import run
from mmrs_core.plugins import load_plugins


@pytest.fixture(scope="session")
def contributions():
    """Return what the installed plug-ins contribute."""
    return load_plugins().contributions


@pytest.fixture
def mmrs(capsys):
    """Return a function that runs a command line: exit code, standard output, standard error."""

    def call(*arguments, program="mmrs"):
        code = run([str(argument) for argument in arguments], program=program)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call
