"""Two versions of a metamodel: what changed, and whether old models still load."""

import re
from pathlib import Path

import pytest
from metamodel_edits import EDITS, ZOO, edited

from mmrs_core.errors import PluginError
from mmrs_core.languages.evolution.differences import differences, ways_between
from mmrs_core.languages.evolution.migration import Migration
from mmrs_core.languages.evolution.versions import pairs_of, version_of


@pytest.fixture
def between(core, tmp_path):
    """Return a function that compares the zoo with an edited one."""

    def compare(text, *migrations):
        new = tmp_path / "new.ecore"
        new.write_text(text, encoding="utf-8")
        versions = version_of(str(ZOO), core), version_of(str(new), core)
        return differences(*versions, ways_between(*versions, migrations))

    return compare


def test_a_metamodel_does_not_differ_from_itself(between):
    assert between(edited()) == ()


@pytest.mark.parametrize("name", EDITS)
def test_every_edit_has_its_verdict(between, name):
    before, after, verdict = EDITS[name]
    assert before in ZOO.read_text(encoding="utf-8")
    assert before != after
    found = {each.verdict.value for each in between(edited(name))}
    if verdict == "compatible":
        assert found <= {"compatible"}
    else:
        assert verdict in found


def test_a_reason_is_given_for_whatever_does_not_load(between):
    for name, (_, _, verdict) in EDITS.items():
        if verdict != "compatible":
            assert all(each.reason for each in between(edited(name)) if each.verdict.value != "compatible")


def test_a_feature_of_the_same_type_in_its_place_is_told_as_the_likely_new_name(between):
    (gone, come) = between(edited("a feature is renamed"))
    assert gone.what == "Lion.weight"
    assert gone.reason == "older models may say it; if it is mass now, a migration has to say so"
    assert (come.what, come.sort) == ("Lion.mass", "added")


def test_a_feature_that_goes_to_a_supertype_is_no_difference_for_models(between):
    feature = EDITS["a feature is removed"][0]
    text = edited("a feature is removed").replace(
        'name="Animal" abstract="true">', f'name="Animal" abstract="true">{feature}'
    )
    assert {each.verdict.value for each in between(text)} == {"compatible"}


def test_a_new_name_of_the_language_needs_a_migration(between):
    text = edited().replace('nsURI="urn:test:zoo"', 'nsURI="urn:test:zoo:2"')
    (difference,) = between(text)
    assert difference.reason == "older models name the older one, and no migration leads there"
    (allowed,) = between(text, Migration("urn:test:zoo", "urn:test:zoo:2"))
    assert allowed.verdict.value == "compatible"


def test_a_new_name_of_a_package_inside_needs_a_migration_of_its_own(between):
    text = edited().replace('nsURI="urn:test:zoo:wing"', 'nsURI="urn:test:zoo:wing:2"')
    (difference,) = between(text)
    assert (difference.what, difference.verdict.value) == ("wing", "incompatible")
    (allowed,) = between(text, Migration("urn:test:zoo:wing", "urn:test:zoo:wing:2"))
    assert allowed.verdict.value == "compatible"


_HEAD = """<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="{0}" nsURI="urn:test:{0}:1" nsPrefix="{0}">
  <eClassifiers xsi:type="ecore:EClass" name="{1}">{2}</eClassifiers>
</ecore:EPackage>
"""
_PARTS = '<eStructuralFeatures xsi:type="ecore:EReference" name="parts" eType="ecore:EClass {}#//Part"/>'
_INT = "ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EInt"
_SIZE = f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="size" eType="{_INT}"/>'


@pytest.fixture
def part_and_whole(core, tmp_path):
    """Return a function that reads a metamodel, which refers to a second file for its parts."""

    def read(folder, part, name="part.ecore"):
        (tmp_path / folder).mkdir(exist_ok=True)
        whole = tmp_path / folder / "whole.ecore"
        whole.write_text(_HEAD.format("whole", "Whole", _PARTS.format(name)))
        (tmp_path / folder / name).write_text(part)
        return version_of(str(whole), core)

    return read


def test_what_is_gone_from_a_file_that_is_referred_to_is_told(part_and_whole):
    sized = _HEAD.format("part", "Part", _SIZE)
    old, new = part_and_whole("old", sized), part_and_whole("new", _HEAD.format("part", "Part", ""))
    (gone,) = differences(old, new)
    assert (gone.what, gone.verdict.value) == ("part:Part.size", "incompatible")
    assert differences(old, old) == ()


def test_a_new_name_of_a_language_that_is_referred_to_is_told(part_and_whole):
    part = _HEAD.format("part", "Part", "")
    old, new = part_and_whole("old", part), part_and_whole("new", part.replace("part:1", "part:2"))
    (renamed,) = differences(old, new)
    assert renamed.words == "its nsURI was urn:test:part:1, is urn:test:part:2"
    assert renamed.verdict.value == "incompatible"


def test_files_are_told_with_what_they_were_compared_with(part_and_whole):
    part = _HEAD.format("part", "Part", "")
    pairs = pairs_of(part_and_whole("old", part), part_and_whole("new", part, "parts.ecore"))
    named = [(Path(old).name, Path(new).name) for old, new in pairs.files()]
    assert named == [("whole.ecore", "whole.ecore"), ("part.ecore", "parts.ecore")]


def test_what_a_migration_renames_is_the_same(between):
    text = edited("a feature is renamed").replace('nsURI="urn:test:zoo"', 'nsURI="urn:test:zoo:2"')
    step = Migration("urn:test:zoo", "urn:test:zoo:2", features={"Lion.weight": "mass"})
    assert {each.verdict.value for each in between(text, step)} == {"compatible"}


def test_what_a_migration_drops_has_another_meaning(between):
    text = edited("a feature is removed").replace('nsURI="urn:test:zoo"', 'nsURI="urn:test:zoo:2"')
    step = Migration("urn:test:zoo", "urn:test:zoo:2", dropped=frozenset({"Lion.weight"}))
    assert "changed meaning" in {each.verdict.value for each in between(text, step)}


def test_an_installed_language_is_named_by_its_ns_uri(core):
    installed = version_of("urn:mmrs:mission:1.0", core)
    file = version_of(str(installed.packages[0].ecore), core)
    assert differences(installed, file) == ()


def test_a_name_that_is_neither_installed_nor_a_file_is_refused(core):
    with pytest.raises(ValueError, match=r"no such metamodel; did you mean urn:mmrs:mission:1\.0"):
        version_of("urn:mmrs:misson:1.0", core)


def test_a_metamodel_that_needs_another_says_which(core, tmp_path):
    file = tmp_path / "lost.ecore"
    file.write_text(edited().replace('eType="#//Keeper"', 'eType="gone.ecore#//Keeper"', 1))
    with pytest.raises(PluginError, match=r"needs the metamodel gone\.ecore"):
        version_of(str(file), core)


def test_a_number_that_may_be_nil_is_not_one_that_may_not(core, tmp_path):
    old, new = tmp_path / "old.ecore", tmp_path / "new.ecore"
    text = edited("a byte may be absent").replace('name="cage"', 'name="cage" unsettable="true"')
    old.write_text(text, encoding="utf-8")
    new.write_text(text.replace("EByteObject", "EByte"), encoding="utf-8")
    found = differences(version_of(str(old), core), version_of(str(new), core))
    assert "older models may say nil, which is no EByte" in {each.reason for each in found}


def test_a_feature_that_was_inherited_and_is_declared_anew_is_compared(core, tmp_path):
    old, new = tmp_path / "old.ecore", tmp_path / "new.ecore"
    text = ZOO.read_text(encoding="utf-8").replace("urn:test:zoo", "urn:test:park")
    depth = re.search(r'<eStructuralFeatures [^>]*name="depth"[^>]*/>', text)[0]
    otter = '<eClassifiers xsi:type="ecore:EClass" name="Otter" eSuperTypes="#//Animal #//Swimmer"'
    assert otter in text
    old.write_text(text, encoding="utf-8")
    bare = text.replace(depth, "").replace(otter + "/>", otter + "></eClassifiers>")
    anew = depth.replace("EDouble", "EInt")
    new.write_text(re.sub(f"({re.escape(otter)}[^>]*>)", rf"\g<1>{anew}", bare), encoding="utf-8")
    found = differences(version_of(str(old), core), version_of(str(new), core))
    assert ("Otter.depth", "incompatible") in {(each.what, each.verdict.value) for each in found}
