"""Registries and shorthands for tests of models."""

from pathlib import Path

import pytest
from lxml import etree

from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import MetamodelSource, core_registry, registry_with

PROJECT = Path(__file__).parents[3]
MODELS = PROJECT / "tests" / "fixtures" / "models"
NAMESPACES = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xmlns:zoo="urn:test:zoo" xmlns:wing="urn:test:zoo:wing"'
)


@pytest.fixture(scope="session")
def core():
    return core_registry()


@pytest.fixture(scope="session")
def zoo():
    return registry_with([MetamodelSource("urn:test:zoo", MODELS / "zoo.ecore", "zoo")])


@pytest.fixture(scope="session")
def everything():
    """The core with the metamodels of the plug-ins, which need not be installed."""
    files = sorted((PROJECT / "plugins").glob("*/mmrs_*/metamodels/*.ecore"))
    return registry_with(
        [MetamodelSource(etree.parse(file).getroot().get("nsURI"), file, file.stem) for file in files]
    )


@pytest.fixture(scope="session")
def zoo_text():
    """Return a function that wraps the attributes and content of a Zoo into a document."""

    def text(content: str, attributes: str = 'name="z"') -> bytes:
        return f"<zoo:Zoo {NAMESPACES} {attributes}>{content}</zoo:Zoo>".encode()

    return text


@pytest.fixture(scope="session")
def read_zoo(zoo, zoo_text):
    """Return a function that reads such a document."""

    def read(content: str, attributes: str = 'name="z"'):
        return read_text(zoo_text(content, attributes), "zoo.xmi", zoo)

    return read


@pytest.fixture(scope="session")
def lion(read_zoo):
    """Return a function that reads a zoo with one lion and returns the lion; it must be without fault."""

    def read(attributes: str, content: str = ""):
        model = read_zoo(f'<animals xsi:type="zoo:Lion" name="Leo" {attributes}>{content}</animals>')
        assert model.diagnostics == ()
        return model.roots[0].animals[0]

    return read
