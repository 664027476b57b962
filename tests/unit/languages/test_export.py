from __future__ import annotations

import re
from pathlib import Path

import pytest

from mmrs_core.languages.metamodels.export import export_metamodels, exported_names
from mmrs_core.languages.registry import MetamodelSource, registry_with

PROJECT = Path(__file__).parents[3]


@pytest.fixture
def exported(everything, tmp_path):
    return {path.name: path for path in export_metamodels(everything, tmp_path / "out" / "deep")}


def test_every_metamodel_stands_beside_the_others_in_an_eclipse_project(everything, exported):
    assert set(exported) == {".project", *exported_names(everything).values()}
    assert "<name>mmrs-metamodels</name>" in exported[".project"].read_text()


def test_references_lead_to_files_in_the_same_folder(exported):
    asked = 0
    for path in exported.values():
        for reference in re.findall(r'(?:eType|eSuperTypes)="([^"]*)"', path.read_text()):
            for token in reference.split():
                document = token.partition("#")[0] if "#" in token else ""
                if document and "Ecore" not in document:
                    asked += 1
                    assert (path.parent / document).is_file(), reference
    assert asked > len(exported)


def test_nothing_else_changes(exported):
    for name in ("mission", "robot"):
        source = (PROJECT / "metamodels" / f"{name}.ecore").read_text()
        text = exported[f"{name}.ecore"].read_text()
        assert re.sub(r"urn:mmrs:(\w+):1.0#", r"\1.ecore#", source) == text


def test_exported_metamodels_can_be_read_again(exported):
    survey = MetamodelSource("urn:mmrs:survey:1.0", exported["survey.ecore"], "survey")
    registry = registry_with([survey])
    assert registry.metaclass("urn:mmrs:survey:1.0", "PhotoGridTask").is_kind("urn:mmrs:mission:1.0", "Task")


def test_exporting_twice_gives_the_same_bytes(everything, tmp_path):
    for path in export_metamodels(everything, tmp_path / "a"):
        other = tmp_path / "b" / path.name
        export_metamodels(everything, tmp_path / "b")
        assert path.read_bytes() == other.read_bytes()


def test_packages_of_one_name_get_files_of_their_own(tmp_path):
    sources = []
    for folder in "ab":
        path = tmp_path / folder / "types.ecore"
        path.parent.mkdir()
        path.write_text(
            '<ecore:EPackage xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="types" '
            f'nsURI="urn:{folder}" nsPrefix="t"/>'
        )
        sources.append(MetamodelSource(f"urn:{folder}", path, folder))
    names = exported_names(registry_with(sources))
    assert names["urn:a"] == "types.ecore"
    assert names["urn:b"] != "types.ecore"


def test_a_package_made_with_pyecore_is_exported_too(core, tmp_path):
    pyecore = pytest.importorskip("pyecore.ecore")
    task = core.metaclass("urn:mmrs:mission:1.0", "PointTask").eclass
    package = pyecore.EPackage("paint", nsURI="urn:t:paint", nsPrefix="paint")
    paint = pyecore.EClass("PaintTask", superclass=(task,))
    paint.eStructuralFeatures.append(pyecore.EAttribute("coats", pyecore.EInt, lower=1))
    package.eClassifiers.append(paint)
    export_metamodels(registry_with([MetamodelSource("urn:t:paint", package, "p")]), tmp_path)
    again = registry_with([MetamodelSource("urn:t:paint", tmp_path / "paint.ecore", "p")])
    assert again.metaclass("urn:t:paint", "PaintTask").feature("coats").lower == 1
    assert again.metaclass("urn:t:paint", "PaintTask").is_kind("urn:mmrs:mission:1.0", "Task")
