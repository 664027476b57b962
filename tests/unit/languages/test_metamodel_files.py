"""Metamodels that are files of the user's."""

from pathlib import Path

import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.metamodels.gathering import gathered, registry_of_files
from mmrs_core.languages.model import Model
from mmrs_core.languages.registry import MetamodelSource, core_registry

HEAD = (
    '<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"'
)
DOUBLE = "ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EDouble"


def written(path: Path, name: str, body: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f'{HEAD} name="{name}" nsURI="urn:test:{name}" nsPrefix="{name}">{body}</ecore:EPackage>')
    return path


def classed(name: str, above: str = "") -> str:
    supertypes = f' eSuperTypes="{above}"' if above else ""
    return f'<eClassifiers xsi:type="ecore:EClass" name="{name}"{supertypes}/>'


@pytest.mark.parametrize(
    ("place", "reference"),
    [
        ("animals.ecore", "animals.ecore"),
        ("model/animals.ecore", "model/animals.ecore"),
        ("with space.ecore", "with%20space.ecore"),
        ("animals.ecore", "../../org.animals/model/animals.ecore"),
        ("animals.ecore", "platform:/resource/org.animals/model/animals.ecore"),
    ],
)
def test_a_metamodel_that_a_file_refers_to_is_taken_along(tmp_path, place, reference):
    written(tmp_path / place, "animals", classed("Animal"))
    zoo = written(tmp_path / "zoo.ecore", "zoo", classed("Lion", f"{reference}#//Animal"))
    registry, wanted = registry_of_files([zoo], ())
    assert wanted == ("urn:test:zoo",)
    assert registry.metaclass("urn:test:zoo", "Lion").is_kind("urn:test:animals", "Animal")
    assert [each.ns_uri for each in gathered([zoo], core_registry())] == ["urn:test:zoo", "urn:test:animals"]


def test_a_file_takes_the_place_of_what_is_installed(tmp_path):
    old = written(tmp_path / "old.ecore", "zoo", classed("Lion"))
    new = written(tmp_path / "new.ecore", "zoo", classed("Tiger"))
    registry, _ = registry_of_files([new], [MetamodelSource("urn:test:zoo", old)])
    assert [each.name for each in registry.package("urn:test:zoo").metaclasses] == ["Tiger"]


def test_what_is_no_metamodel_is_refused_with_its_name(tmp_path):
    file = tmp_path / "note.ecore"
    file.write_text("<note/>")
    with pytest.raises(UnreadableError, match=r"note\.ecore:1: no metamodel"):
        registry_of_files([file], ())


def test_zeros_of_both_signs_are_no_repetition(tmp_path):
    reading = (
        '<eClassifiers xsi:type="ecore:EClass" name="Reading">'
        '<eStructuralFeatures xsi:type="ecore:EAttribute" name="values" upperBound="-1"'
        f' eType="{DOUBLE}"/></eClassifiers>'
    )
    registry, (uri,) = registry_of_files([written(tmp_path / "r.ecore", "readings", reading)], ())
    signed = Model("m", (registry.create(uri, "Reading", values=[0.0, -0.0]),))
    twice = Model("m", (registry.create(uri, "Reading", values=[-0.0, 1.0, -0.0]),))
    assert check_conformance(signed, registry) == ()
    assert [fault.code for fault in check_conformance(twice, registry)] == ["ECO006"]
