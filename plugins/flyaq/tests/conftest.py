"""What the installed plug-ins contribute, the shipped mapping, and the command line."""

from pathlib import Path

import pytest
from mmrs_flyaq.plugin import FLYAQ_2015
from mmrs_flyaq.rules.mapping_file import read_mapping

from mmrs_core.cli import run
from mmrs_core.plugins import load_plugins


@pytest.fixture(scope="session")
def contributions():
    """Return what the installed plug-ins contribute."""
    return load_plugins().contributions


@pytest.fixture(scope="session")
def registry(contributions):
    return contributions.languages


@pytest.fixture(scope="session")
def mapping(registry):
    """Return the shipped mapping of FLYAQ 2015."""
    return read_mapping(FLYAQ_2015, registry)


@pytest.fixture(scope="session")
def flyaq():
    return Path(__file__).parent / "fixtures" / "flyaq"


@pytest.fixture
def mmrs(capsys):
    """Return a function that runs a command line: exit code, standard output, standard error."""

    def call(*arguments, program="mmrs"):
        code = run([str(argument) for argument in arguments], program=program)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call
