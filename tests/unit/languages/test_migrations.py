"""Models of older versions are migrated while they are read."""

import pytest

from mmrs_core.errors import PluginError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.evolution.migration import Migration
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.languages.writing import to_json, to_xmi, write_model

NEW = "urn:test:fair:1.2"
STAND = "urn:test:stand:1.0"
ECORE = """<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="fair" nsURI="urn:test:fair:1.2" nsPrefix="fair">
  <eClassifiers xsi:type="ecore:EClass" name="Fair">
    <eStructuralFeatures xsi:type="ecore:EReference" name="kites" upperBound="-1"
        eType="#//Kite" containment="true"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="winner" eType="#//Kite"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="ranking" upperBound="-1" eType="#//Kite"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Kite">
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="label" eType="E#//EString"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="metres" eType="E#//EDouble"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="colour" eType="#//Colour"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="notes" upperBound="-1" eType="E#//EString"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="tail" eType="#//Tail" containment="true"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Tail">
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="bows" eType="E#//EInt"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EEnum" name="Colour">
    <eLiterals name="RED"/><eLiterals name="BLUE" value="1"/>
  </eClassifiers>
</ecore:EPackage>
""".replace("E#//", "ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//")
STAND_ECORE = """<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="stand"
    nsURI="urn:test:stand:1.0" nsPrefix="stand">
  <eClassifiers xsi:type="ecore:EClass" name="BoxKite" eSuperTypes="urn:test:fair:1.2#//Kite"/>
</ecore:EPackage>
"""
OLD = b"""<?xml version="1.0" encoding="UTF-8"?>
<fair:Fair xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:fair="urn:test:fair:1.0" xmlns:stand="urn:test:stand:1.0" winner="//@dragons.1">
  <dragons name="a b" feet="10" colour="ROUGE" serial="77"/>
  <dragons xsi:type="stand:BoxKite" name="c" feet="100" colour="BLUE">
    <notes>one</notes>
    <end knots="3"/>
  </dragons>
  <dragons>
    <notes> two words </notes>
    <end/>
  </dragons>
  <ranking href="#//@dragons.2"/>
  <ranking href="#//@dragons.0"/>
</fair:Fair>
"""
OLD_JSON = b"""{
  "$languages": {"fair": "urn:test:fair:1.0", "stand": "urn:test:stand:1.0"},
  "$type": "fair:Fair",
  "winner": "//@dragons.1",
  "ranking": ["//@dragons.2", "//@dragons.0"],
  "dragons": [
    {"name": "a b", "feet": 10, "colour": "ROUGE", "serial": 77},
    {"$type": "stand:BoxKite", "name": "c", "feet": 100, "colour": "BLUE",
     "notes": ["one"], "end": {"knots": 3}},
    {"notes": [" two words "], "end": {}}
  ]
}
"""


def in_metres(element):
    if "feet" in element.members:
        element.members["metres"] = str(float(element.members.pop("feet")) * 0.3048)


STEPS = (
    Migration(
        "urn:test:fair:1.0",
        "urn:test:fair:1.1",
        classes={"Dragon": "Kite", "End": "Trail"},
        features={
            "Fair.dragons": "kites",
            "Dragon.name": "label",
            "Dragon.end": "trail",
            "End.knots": "bows",
        },
        values={"Dragon.colour": {"ROUGE": "RED"}},
        dropped=frozenset({"Dragon.serial"}),
    ),
    Migration(
        "urn:test:fair:1.1",
        NEW,
        classes={"Trail": "Tail"},
        features={"Kite.trail": "tail", "Kite.feet": "metres"},
        values={"Kite.feet": {"10": "3.0", "100": "30.0"}},
    ),
)


@pytest.fixture
def fair(tmp_path):
    """Return a function that makes a registry with the new fair and the given steps to it."""
    (tmp_path / "fair.ecore").write_text(ECORE)
    (tmp_path / "stand.ecore").write_text(STAND_ECORE)
    sources = [MetamodelSource(uri, tmp_path / f"{uri.split(':')[2]}.ecore") for uri in (NEW, STAND)]
    return lambda *steps: registry_with(sources, steps)


@pytest.fixture(params=[(OLD, "old.xmi"), (OLD_JSON, "old.json")], ids=["xmi", "json"])
def migrated(request, fair):
    """Return the model of the oldest version, read from XMI or JSON, and its registry."""
    registry = fair(*STEPS)
    return read_text(*request.param, registry), registry


def test_classes_features_and_values_get_their_new_names(migrated):
    model, registry = migrated
    first, second, third = model.roots[0].kites
    assert (first.label, first.colour, first.metres) == ("a b", "RED", 3.0)
    assert (second.label, second.colour, second.metres) == ("c", "BLUE", 30.0)
    assert second.tail.bows == 3
    assert (third.notes, third.tail.bows) == ([" two words "], 0)
    assert check_conformance(model, registry) == ()


def test_renames_are_meant_for_subclasses_of_other_languages(migrated):
    model, _ = migrated
    assert type(model.roots[0].kites[1]).__name__ == "BoxKite"
    assert model.roots[0].kites[1].label == "c"


def test_references_lead_to_the_same_elements_as_before(migrated):
    fair = migrated[0].roots[0]
    assert fair.winner is fair.kites[1]
    assert [kite.label for kite in fair.ranking] == [None, "a b"]


def test_a_note_and_a_warning_say_what_was_done(migrated):
    model, _ = migrated
    said = [(fault.code, fault.severity.value, fault.message) for fault in model.diagnostics]
    assert said == [
        ("MIG001", "note", f"urn:test:fair:1.0: an older version; migrated to {NEW} while it was read"),
        ("MIG002", "warning", "serial: '77' has no place in urn:test:fair:1.1, and is left out"),
    ]
    assert all(fault.place.line > 1 or fault.code == "MIG001" for fault in model.diagnostics)


def test_a_migrated_model_is_saved_in_the_new_version(migrated):
    model, registry = migrated
    again = read_text(to_xmi(model.roots, registry), "new.xmi", registry)
    assert again.diagnostics == ()
    assert b"urn:test:fair:1.0" not in to_xmi(model.roots, registry)
    assert to_json(again.roots, registry) == to_json(model.roots, registry)


def test_the_file_stays_as_it_is_until_it_is_saved(fair, tmp_path):
    file = tmp_path / "old.xmi"
    file.write_bytes(OLD)
    registry = fair(*STEPS)
    model = read_model(file, registry)
    assert file.read_bytes() == OLD
    write_model(model.roots, file, registry)
    assert read_model(file, registry).diagnostics == ()


def test_a_function_rewrites_what_renames_cannot(fair):
    step = Migration(
        "urn:test:fair:1.0",
        NEW,
        classes={"Dragon": "Kite", "End": "Tail"},
        features={"Fair.dragons": "kites", "Dragon.name": "label", "Dragon.end": "tail", "End.knots": "bows"},
        values={"Dragon.colour": {"ROUGE": "RED"}},
        dropped=frozenset({"Dragon.serial"}),
        rewrite=in_metres,
    )
    model = read_text(OLD, "old.xmi", fair(step))
    assert model.roots[0].kites[0].metres == pytest.approx(3.048)


def test_a_function_is_not_called_for_elements_of_other_languages(fair):
    seen = []
    step = Migration("urn:test:fair:1.0", NEW, rewrite=lambda element: seen.append(element.kind))
    read_text(OLD, "old.xmi", fair(step))
    assert seen == ["Fair"]


def test_a_function_that_fails_is_told_with_the_element_that_it_failed_for(fair):
    def fail(element):
        raise PluginError(f"fails for {element.kind}")

    step = Migration("urn:test:fair:1.0", NEW, rewrite=fail)
    with pytest.raises(PluginError, match=r"^fails for Fair; at old\.xmi:\d+$"):
        read_text(OLD, "old.xmi", fair(step))


def test_elements_of_a_missing_language_are_kept_inside_a_migrated_model(fair):
    alien = b'<dragons xsi:type="far:Thing" xmlns:far="urn:far" x="&lt;"><y/></dragons>'
    text = OLD.replace(b"  <dragons>", b"  " + alien + b"\n  <dragons>")
    registry = fair(*STEPS)
    model = read_text(text, "old.xmi", registry)
    assert [fault.code for fault in model.diagnostics] == ["XMI001", "MIG001", "MIG002"]
    assert b'x="&lt;"><y/></dragons>' in to_xmi(model.roots, registry)


def test_a_reference_from_another_file_leads_to_the_migrated_element(fair, tmp_path):
    (tmp_path / "old.xmi").write_bytes(OLD)
    (tmp_path / "new.xmi").write_text(
        f'<fair:Fair xmlns:fair="{NEW}"><winner href="old.xmi#//@dragons.1"/></fair:Fair>'
    )
    model = read_model(tmp_path / "new.xmi", fair(*STEPS))
    assert model.diagnostics == ()
    assert model.roots[0].winner.label == "c"


def test_what_the_new_version_does_not_know_is_a_fault_with_its_line(fair):
    model = read_text(OLD.replace(b"serial=", b"weird="), "old.xmi", fair(*STEPS))
    (fault,) = [fault for fault in model.diagnostics if fault.code == "XMI004"]
    assert (fault.message, fault.place.line) == ("weird: no feature of Kite", 5)


def test_a_version_that_no_migration_leads_from_is_told_with_the_installed_one(fair):
    model = read_text(OLD.replace(b"fair:1.0", b"fair:0.9"), "old.xmi", fair(*STEPS))
    assert model.diagnostics[0].code == "XMI001"
    assert model.diagnostics[0].hint.startswith(f"{NEW} is installed, but no migration leads there")


def test_migrations_that_lead_in_a_circle_are_refused(fair):
    circle = (Migration("urn:a:1", "urn:a:2"), Migration("urn:a:2", "urn:a:1"))
    with pytest.raises(PluginError, match="urn:a:1: its migrations lead in a circle"):
        _ = fair(*circle).chains


def test_migrations_that_lead_nowhere_are_not_taken(fair):
    assert fair(Migration("urn:a:1", "urn:a:2")).chains == {}


def test_a_feature_without_its_class_is_a_mistake():
    with pytest.raises(ValueError, match=r"'name': a feature is written Class\.feature"):
        Migration("urn:a:1", "urn:a:2", features={"name": "label"})


@pytest.mark.parametrize(
    "text", [b"[]", b'{"x": "urn:test:fair:1.0"}', b'{"$roots": {}, "x": "urn:test:fair:1.0"}']
)
def test_json_that_only_mentions_an_old_version_is_read_as_ever(fair, text):
    assert "XMI015" in [f.code for f in read_text(text, "a.json", fair(*STEPS)).diagnostics]


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
def test_old_models_in_other_encodings_are_migrated(fair, encoding):
    text = OLD.decode().replace('<?xml version="1.0" encoding="UTF-8"?>\n', "").encode(encoding)
    assert read_text(text, "old.xmi", fair(*STEPS)).roots[0].kites[0].label == "a b"
