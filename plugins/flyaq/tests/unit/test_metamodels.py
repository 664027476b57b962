"""Metamodels at hand go before what the mapping declares."""

import shutil
from dataclasses import replace

import pytest

ECORE = """<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"
    name="{name}" nsURI="{uri}" nsPrefix="{name}">
  <eClassifiers xsi:type="ecore:EClass" name="Drone">
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="name"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="{own}"/>
  </eClassifiers>
</ecore:EPackage>
"""
MODEL = '<d:Drone xmlns:d="{uri}" {more} name="Tern" colour="white"/>'
SCHEMA = (
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://www.flyaq.it/drone {}"'
)
UNKNOWN = "LOST: the metamodel has no such feature: colour white of Drone 'Tern'"
UNMAPPED = "LOST: the mapping has no rule for this feature: colour white of Drone 'Tern'"


@pytest.fixture
def colour(migrated, told):
    """Return a function that tells what becomes of a feature that only some metamodels have."""
    return lambda file, **options: told(migrated(file, **options), "colour")


def test_without_a_metamodel_the_mapping_says_what_there_is(colour, written):
    file = written("Tern.xmi", MODEL.format(uri="http://www.flyaq.it/drone", more=""))
    assert colour(file) == [UNKNOWN]


@pytest.mark.parametrize("uri", ["http://www.flyaq.it/drone", "http://www.flyaql.it/drone"])
@pytest.mark.parametrize("other", ["http://www.flyaq.it/drone", "http://www.flyaql.it/drone"])
def test_a_metamodel_that_is_given_is_found_by_either_spelling(colour, written, uri, other):
    metamodel = written("elsewhere/birds.ecore", ECORE.format(name="birds", uri=other, own="colour"))
    file = written("Tern.xmi", MODEL.format(uri=uri, more=""))
    assert colour(file, metamodels=(metamodel,)) == [UNMAPPED]
    assert colour(file, metamodels=(metamodel.parent,)) == [UNMAPPED]


def test_a_metamodel_is_found_where_the_model_says(colour, written):
    written(
        "language/model/x.ecore", ECORE.format(name="drone", uri="http://www.flyaq.it/drone", own="colour")
    )
    more = SCHEMA.format("../language/model/x.ecore")
    assert colour(written("models/Tern.xmi", MODEL.format(uri="http://www.flyaq.it/drone", more=more))) == [
        UNMAPPED
    ]


def test_a_metamodel_is_found_beside_a_model_whose_workspace_was_moved(flyaq, migrated, told, tmp_path):
    folder = shutil.copytree(flyaq / "workspace", tmp_path / "flat")
    found = migrated(folder / "Finch.xmi")
    assert found.sources[0].metamodels == {"drone": folder / "drone.ecore"}
    assert told(found, "LOST: the mapping has no rule for this feature: hull Hull (colour green)")


def test_of_two_metamodels_that_of_the_same_spelling_is_taken(colour, written):
    written("a.ecore", ECORE.format(name="drone", uri="http://www.flyaql.it/drone", own="weight"))
    written("b.ecore", ECORE.format(name="drone", uri="http://www.flyaq.it/drone", own="colour"))
    assert colour(written("Tern.xmi", MODEL.format(uri="http://www.flyaq.it/drone", more=""))) == [UNMAPPED]
    assert colour(written("Tern.xmi", MODEL.format(uri="http://www.flyaql.it/drone", more=""))) == [UNKNOWN]


def test_of_two_metamodels_the_one_whose_file_the_model_names_is_taken(migrated, mapping, written, told):
    for name, uri, own in (
        ("a", "flyaql", "weight"),
        ("birds", "flyaq", "colour"),
        ("c", "flyaql", "height"),
    ):
        written(f"{name}.ecore", ECORE.format(name="drone", uri=f"http://www.{uri}.it/drone", own=own))
    model = '{"eClass": "file:/C:/far/away/birds.ecore#//Drone", "name": "Tern", "colour": "white"}'
    files = {**mapping.dialect.files, "drone": ("drone.ecore", "birds.ecore")}
    by = replace(mapping, dialect=replace(mapping.dialect, files=files))
    found = migrated(written("Tern.json", model), by=by)
    assert [each.name for each in found.sources[0].metamodels.values()] == ["birds.ecore"]
    assert told(found, "colour") == [UNMAPPED]


def test_a_metamodel_that_is_given_goes_before_the_one_that_the_model_names(colour, written):
    written("drone.ecore", ECORE.format(name="drone", uri="http://www.flyaq.it/drone", own="weight"))
    given = written("far/birds.ecore", ECORE.format(name="x", uri="http://www.flyaql.it/drone", own="colour"))
    file = written("Tern.xmi", MODEL.format(uri="http://www.flyaq.it/drone", more=""))
    assert colour(file) == [UNKNOWN]
    assert colour(file, metamodels=(given,)) == [UNMAPPED]


def test_a_broken_metamodel_beside_a_model_is_passed_over(colour, written):
    written("broken.ecore", "<nothing")
    assert colour(written("Tern.xmi", MODEL.format(uri="http://www.flyaq.it/drone", more=""))) == [UNKNOWN]
