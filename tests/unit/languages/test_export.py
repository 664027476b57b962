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


HEAD = (
    '<ecore:EPackage xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" '
)


@pytest.fixture
def exporting(tmp_path):
    """Return a function that writes metamodels (name of the file to its bytes) and exports them."""

    def export(**files):
        sources = []
        for name, data in files.items():
            path = tmp_path / "in" / f"{name.replace('_and_', '&')}.ecore"
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
            sources.append(MetamodelSource(f"urn:{name}", path, name))
        return {path.name: path for path in export_metamodels(registry_with(sources), tmp_path / "out")}

    return export


def metamodel(name, body="", called=""):
    return f'{HEAD}name="{called or name}" nsURI="urn:{name}" nsPrefix="p">{body}</ecore:EPackage>'


@pytest.mark.parametrize("quote", ["'", '"'])
@pytest.mark.parametrize(
    ("encoding", "codec"),
    [("UTF-8", "utf-8-sig"), ("UTF-16", "utf-16"), ("UTF-16", "utf-16-le"), ("ISO-8859-1", "latin-1")],
)
def test_a_metamodel_in_any_encoding_is_exported_in_utf_8(exporting, encoding, codec, quote):
    text = metamodel("a", '<eClassifiers xsi:type="ecore:EClass" name="Größe"/>')
    declared = f"<?xml version={quote}1.0{quote} encoding={quote}{encoding}{quote}?>\n{text}"
    out = exporting(a=declared.encode(codec))["a.ecore"].read_text(encoding="utf-8")
    assert out.partition("\n")[2] == text
    assert 'encoding="UTF-8"' in out.partition("\n")[0]


def test_only_references_are_changed(exporting):
    said = "eType='gone.ecore#//X' is <!-- no reference --> eSuperTypes=\"urn:b#//B\""
    escaped = said.replace("<", "&lt;").replace('"', "&quot;")
    comment = "<!-- eType='gone.ecore#//X' eSuperTypes=\"urn:b#//B\" -->"
    details = f'<details key="k" value="{escaped}"/>'
    note = f'<eAnnotations source="s" references="gone.genmodel#//p">{details}</eAnnotations>'
    begin = '<eClassifiers xsi:type="ecore:EClass" name="A"'
    body = f'{comment}{begin} eSuperTypes="urn:b#//B">{note}</eClassifiers>'
    b = metamodel("b", '<eClassifiers xsi:type="ecore:EClass" name="B"/>')
    out = exporting(a=metamodel("a", body).encode(), b=b.encode())
    changed = body.replace('name="A" eSuperTypes="urn:b#', 'name="A" eSuperTypes="b.ecore#')
    assert out["a.ecore"].read_text() == metamodel("a", changed)


def test_references_by_elements_are_changed_too(exporting):
    link = "<eSuperTypes href='b&amp;c.ecore#//B'/>"
    body = f'<eClassifiers xsi:type="ecore:EClass" name="A">{link}</eClassifiers>'
    b = metamodel("b_and_c", '<eClassifiers xsi:type="ecore:EClass" name="B"/>', "other")
    out = exporting(a=metamodel("a", body).encode(), b_and_c=b.encode())
    assert '<eSuperTypes href="other.ecore#//B"/>' in out["a.ecore"].read_text()


@pytest.mark.parametrize(
    ("called", "file"),
    [
        ("../../evil", "_.._evil.ecore"),
        ("/tmp/evil", "_tmp_evil.ecore"),
        ("..", "metamodel.ecore"),
        (".hidden", "hidden.ecore"),
        ("a\\b c", "a_b_c.ecore"),
        ("n" * 300, f"{'n' * 60}.ecore"),
        ("Mission", "Mission-4.ecore"),
    ],
)
def test_whatever_a_metamodel_is_called_its_file_stands_in_the_folder(exporting, tmp_path, called, file):
    out = exporting(a=metamodel("a", called=called).encode())
    assert file in out
    assert {path.parent for path in out.values()} == {tmp_path / "out"}
    assert {path.name for path in tmp_path.iterdir()} == {"in", "out"}
