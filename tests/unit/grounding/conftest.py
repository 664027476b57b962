"""A language with a task and a context element of each sort."""

import pytest

from mmrs_core.languages.registry import MetamodelSource, registry_with


@pytest.fixture(scope="session")
def registry(tmp_path_factory):
    ecore = tmp_path_factory.mktemp("metamodels") / "visit.ecore"
    ecore.write_text(
        """<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="visit" nsURI="urn:test:visit" nsPrefix="visit">
  <eClassifiers xsi:type="ecore:EClass" name="Buoy" eSuperTypes="urn:mmrs:context:1.0#//ContextElement">
    <eStructuralFeatures xsi:type="ecore:EReference" name="at"
        eType="ecore:EClass urn:mmrs:mission:1.0#//Coordinate" containment="true"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Visit" eSuperTypes="urn:mmrs:mission:1.0#//PointTask">
    <eStructuralFeatures xsi:type="ecore:EReference" name="buoy" eType="#//Buoy"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="via"
        eType="ecore:EClass urn:mmrs:mission:1.0#//Coordinate"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Sweep" eSuperTypes="urn:mmrs:mission:1.0#//PolygonTask"/>
</ecore:EPackage>
"""
    )
    return registry_with([MetamodelSource("urn:test:visit", ecore)])
