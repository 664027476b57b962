"""Models that refer to classes and types: of Ecore itself, of what is installed, of .ecore files."""

import pytest

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import write_model

NAMESPACES = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    f'xmi:version="2.0" xmlns:ecore="{ECORE}"'
)
FEATURES = "".join(
    f'<eStructuralFeatures xsi:type="ecore:EReference" name="{name}" {rest} '
    f'eType="ecore:EClass {ECORE}#//{kind}"/>'
    for name, kind, rest in (
        ("of", "EClassifier", 'upperBound="-1"'),
        ("feature", "EStructuralFeature", ""),
        ("own", "EPackage", 'containment="true"'),
    )
)
METAMODEL = f"""<ecore:EPackage {NAMESPACES} name="notes" nsURI="urn:notes" nsPrefix="notes">
  <eClassifiers xsi:type="ecore:EClass" name="Note">{FEATURES}</eClassifiers>
  <eSubpackages name="inner" nsURI="urn:notes:inner" nsPrefix="inner">
    <eClassifiers xsi:type="ecore:EClass" name="Deep" eSuperTypes="#//Note"/>
  </eSubpackages>
</ecore:EPackage>"""


@pytest.fixture
def notes(tmp_path):
    (tmp_path / "notes.ecore").write_text(METAMODEL)
    return registry_of_files([tmp_path / "notes.ecore"], ())[0]


@pytest.fixture
def read(notes, tmp_path):
    """Return a function that reads a Note of some content."""

    def read_note(content, attributes=""):
        note = f'<notes:Note {NAMESPACES} xmlns:notes="urn:notes" {attributes}>{content}</notes:Note>'
        (tmp_path / "note.xmi").write_text(note)
        return read_model(tmp_path / "note.xmi", notes)

    return read_note


def named(model):
    return [f"{type(each).__name__} {each.name}" for each in model.roots[0].of]


@pytest.mark.parametrize(
    ("href", "kind", "found"),
    [
        (f"{ECORE}#//EString", "EDataType", "EDataType EString"),
        (f"{ECORE}#//EPackage", "EClass", "EClass EPackage"),
        ("http://www.eclipse.org/emf/2003/XMLType#//Date", "EDataType", "EDataType Date"),
        ("notes.ecore#//Note", "EClass", "EClass Note"),
        ("notes.ecore#//inner/Deep", "EClass", "EClass Deep"),
        ("urn:notes#//inner/Deep", "EClass", "EClass Deep"),
        ("urn:mmrs:mission:1.0#//Mission", "EClass", "EClass Mission"),
    ],
)
def test_a_model_refers_to_a_class_and_says_so_again_when_it_is_written(
    read, notes, tmp_path, href, kind, found
):
    model = read(f'<of xsi:type="ecore:{kind}" href="{href}"/>')
    assert model.diagnostics == check_conformance(model, notes) == ()
    assert named(model) == [found]
    write_model(model.roots, tmp_path / "again.xmi", notes)
    assert f'<of xsi:type="ecore:{kind}" href="{href}"/>' in (tmp_path / "again.xmi").read_text()


def test_references_in_one_attribute_lead_to_the_same_classes(read):
    model = read("", f'of="ecore:EClass notes.ecore#//Note ecore:EDataType {ECORE}#//EInt"')
    assert model.diagnostics == ()
    assert named(model) == ["EClass Note", "EDataType EInt"]


def test_a_reference_leads_to_a_feature(read):
    model = read('<feature xsi:type="ecore:EReference" href="notes.ecore#//Note/own"/>')
    assert model.diagnostics == ()
    assert model.roots[0].feature.eType.name == "EPackage"
    assert model.roots[0].feature.eContainingClass.name == "Note"


def test_a_metamodel_inside_a_model_is_referred_to_by_position(read):
    own = '<own name="p" nsURI="urn:p"><eClassifiers xsi:type="ecore:EClass" name="K"/></own>'
    model = read(own, 'of="//@own/@eClassifiers.0"')
    assert model.diagnostics == ()
    assert named(model) == ["EClass K"]


@pytest.mark.parametrize(
    ("href", "message"),
    [
        (f"{ECORE}#//EStrin", "leads to no element"),
        ("notes.ecore#//Not", "leads to no element"),
        ("urn:unknown#//A", "not a relative path"),
        ("gone.ecore#//A", "no such file"),
    ],
)
def test_what_is_not_there_is_told(read, href, message):
    (fault,) = read(f'<of xsi:type="ecore:EClass" href="{href}"/>').diagnostics
    assert message in fault.message
    assert fault.place.file.endswith("note.xmi")


def test_metamodels_that_a_model_refers_to_are_no_models_of_the_project(read):
    hrefs = (f"{ECORE}#//EString", "notes.ecore#//Note", "urn:notes#//Note")
    model = read("".join(f'<of xsi:type="ecore:EClass" href="{href}"/>' for href in hrefs[1:]))
    assert model.linked == ()
