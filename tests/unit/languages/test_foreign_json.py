"""Models in JSON of a language that lies beside them."""

import json

import pytest

from mmrs_core.languages.foreign import read_any
from mmrs_core.languages.registry import core_registry
from mmrs_core.languages.writing import to_xmi

BOXES = """<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"
    name="boxes" nsURI="urn:test:boxes" nsPrefix="boxes">
  <eClassifiers xsi:type="ecore:EClass" name="Box">
    <eStructuralFeatures xsi:type="ecore:EReference" name="box" eType="#//Box" containment="true"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="anything" containment="true"
        eType="ecore:EClass http://www.eclipse.org/emf/2002/Ecore#//EObject"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="mark"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EChar"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="count"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EBigInteger"/>
  </eClassifiers>
</ecore:EPackage>
"""


@pytest.fixture
def read(tmp_path):
    """Return a function that reads a box with the given members, beside its metamodel."""
    (tmp_path / "boxes.ecore").write_text(BOXES)

    def read(members: dict[str, object]):
        head = {"$languages": {"boxes": "urn:test:boxes"}, "$type": "boxes:Box"}
        file = tmp_path / "box.json"
        file.write_text(json.dumps(head | members))
        return read_any(file, core_registry())

    return read


def test_a_feature_for_anything_takes_any_element(read):
    found = read({"anything": {"$type": "boxes:Box", "count": 3}})
    assert found.model.diagnostics == ()
    assert found.model.roots[0].anything.count == 3


def test_elements_may_stand_as_deep_as_in_xmi(read):
    nested: dict[str, object] = {}
    for _ in range(350):
        nested = {"box": nested}
    found = read(nested)
    assert found.model.diagnostics == ()
    assert sum(1 for _ in found.model.elements()) == 351


def test_a_character_beyond_16_bits_is_no_char(read):
    (fault,) = read({"mark": "\U0001f600"}).model.diagnostics
    assert (fault.code, fault.message) == ("XMI005", "mark: '\U0001f600': not one character of 16 bits")


def test_the_last_character_of_16_bits_is_a_char(read):
    found = read({"mark": "\uffff"})
    assert b'mark="65535"' in to_xmi(found.model.roots, found.registry)


@pytest.mark.parametrize("sign", ["", "-"])
def test_a_whole_number_may_have_4300_digits(read, sign):
    found = read({"count": sign + "9" * 4300})
    assert abs(found.model.roots[0].count) == 10**4300 - 1


def test_a_number_too_long_to_be_read_is_a_fault_in_plain_words(read):
    (fault,) = read({"count": "9" * 100_001}).model.diagnostics
    assert fault.message.endswith("...: more than 100000 digits")
