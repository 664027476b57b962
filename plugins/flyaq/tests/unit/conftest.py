"""The fixtures in the dialects of others, and what becomes of them."""

from pathlib import Path

import pytest
from mmrs_flyaq.migrate import migrate

from mmrs_core.languages.element import Element

FIXTURES = Path(__file__).parents[1] / "fixtures"


@pytest.fixture(scope="session")
def dialects():
    return FIXTURES / "dialects"


@pytest.fixture
def migrated(mapping, registry):
    """Return a function that migrates files by the shipped mapping, or another one."""

    def call(*files, by=None, **options):
        return migrate(files, by or mapping, registry, **options)

    return call


@pytest.fixture
def model():
    """Return a function that finds the only model of a kind in a migration."""

    def find(migration, name) -> Element:
        found = [output.element for output in migration.outputs if output.path.name == name]
        assert len(found) == 1, [str(output.path) for output in migration.outputs]
        return found[0]

    return find


@pytest.fixture
def told():
    """Return a function that gives the findings whose reason or subject holds some words, as text."""

    def find(migration, words):
        lines = (f"{each.category.name}: {each.reason}: {each.subject}" for each in migration.findings)
        return [line for line in lines if words in line]

    return find


@pytest.fixture
def written(tmp_path):
    """Return a function that writes a file."""

    def write(name, text):
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    return write
