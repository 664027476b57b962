"""A stranger's context elements are read, planned around, and drawn without any change to the core."""

import shutil

import pytest
from lxml import etree

from mmrs_core import pipeline
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.registry import MetamodelSource
from mmrs_core.pictures.preview.from_plan import picture_of_plan
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.plugins import load_plugins

pytestmark = pytest.mark.together("examples")

SOLAR = "urn:test:solar:1.0"
ECORE = f"""<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="solar" nsURI="{SOLAR}" nsPrefix="solar">
  <eClassifiers xsi:type="ecore:EClass" name="PanelGroup"
      eSuperTypes="urn:mmrs:context:1.0#//ContextElement">
    <eStructuralFeatures xsi:type="ecore:EReference" name="shell" lowerBound="3" upperBound="-1"
        eType="ecore:EClass urn:mmrs:mission:1.0#//Coordinate" containment="true"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="inverters" upperBound="-1"
        eType="#//Inverter" containment="true"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="rowCount"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EInt"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Inverter" eSuperTypes="urn:mmrs:mission:1.0#//NamedElement">
    <eStructuralFeatures xsi:type="ecore:EReference" name="at" lowerBound="1"
        eType="ecore:EClass urn:mmrs:mission:1.0#//Coordinate" containment="true"/>
  </eClassifiers>
</ecore:EPackage>
"""
ELEMENT = """  <elements xsi:type="solar:PanelGroup" xmlns:solar="urn:test:solar:1.0"
      name="roof &lt;west&gt;" rowCount="6">
    <shell xsi:type="mission:RelativeCoordinate" x="1.0" y="9.0"/>
    <shell xsi:type="mission:RelativeCoordinate" x="5.0" y="9.0"/>
    <shell xsi:type="mission:RelativeCoordinate" x="5.0" y="11.0"/>
    <inverters name="first"><at xsi:type="mission:RelativeCoordinate" x="6.0" y="10.0"/></inverters>
  </elements>
"""


@pytest.fixture
def stranger(tmp_path):
    """Return everything that is contributed once a stranger's plug-in is installed."""
    ecore = tmp_path / "solar.ecore"
    ecore.write_text(ECORE, encoding="utf-8")

    class Plugin:
        @staticmethod
        @hookimpl
        def mmrs_metamodels():
            return (MetamodelSource(SOLAR, ecore, "mmrs-solar-of-a-stranger"),)

        @staticmethod
        @hookimpl
        def mmrs_map_symbols():
            return (MapSymbol((SOLAR, "PanelGroup"), "panel group", "#7a4b00", "☀", ("rowCount",)),)

    return load_plugins(extra={"solar-of-a-stranger": Plugin()}).contributions


@pytest.fixture
def markup(stranger, folder_of, tmp_path):
    """Return the map of the pool with a group of panels on its roof."""
    project = tmp_path / "pool"
    shutil.copytree(folder_of("pool"), project)
    context = project / "context.xmi"
    words = context.read_text(encoding="utf-8")
    context.write_text(words.replace("  <environment", f"{ELEMENT}  <environment"), encoding="utf-8")
    models, _ = pipeline.valid_models(project, stranger)
    scene = pipeline.expand(pipeline.ground(models), stranger)
    plan = pipeline.plan(scene)
    return map_of(picture_of_plan(scene, plan, stranger.map_symbols), standalone=True)


def test_a_stranger_s_element_is_drawn_with_its_outline_colour_icon_and_label(markup):
    root = etree.fromstring(markup.encode())
    (outline,) = [e for e in root.iter() if e.get("class") == "element area"]
    assert outline.get("stroke") == "#7a4b00"
    assert outline.get("d").count("L") == 2
    assert outline.findtext("{*}title") == "roof <west>: panel group, row count 6"
    icons = [e.text.strip() for e in root.iter() if e.get("class") == "icon" and e.get("fill") == "#7a4b00"]
    assert set(icons) == {"☀"}
    legend = next(e for e in root.iter() if e.get("class") == "legend")
    assert "panel group" in "".join(legend.itertext())


def test_what_a_stranger_s_element_contains_is_drawn_too(markup):
    assert "<title>first: panel group</title>" in markup
