"""Metamodels that random models are made of."""

from pathlib import Path

import pytest
from lxml import etree

from mmrs_core.languages.registry import MetamodelSource, registry_with

PROJECT = Path(__file__).parents[3]


@pytest.fixture(scope="session")
def registry():
    """The core, the plug-ins' metamodels and a foreign one that uses what Ecore offers beyond ours."""
    files = sorted((PROJECT / "plugins").glob("*/mmrs_*/metamodels/*.ecore"))
    sources = [MetamodelSource(etree.parse(file).getroot().get("nsURI"), file, file.stem) for file in files]
    zoo = PROJECT / "tests" / "fixtures" / "models" / "zoo.ecore"
    return registry_with([*sources, MetamodelSource("urn:test:zoo", zoo, "zoo")])
