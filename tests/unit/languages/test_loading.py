"""What pyecore has of metamodels that it would not read, or not read rightly, by itself."""

from __future__ import annotations

import gc
import weakref
from pathlib import Path

import pytest

from mmrs_core.errors import PluginError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.registry import MetamodelSource

HEAD = (
    '<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    f'xmlns:ecore="{ECORE}" name="a" nsURI="urn:a" nsPrefix="a">'
)
MODELS = Path(__file__).parents[2] / "fixtures" / "models"


def feature(kind, name, target, rest=""):
    return f'<eStructuralFeatures xsi:type="ecore:{kind}" name="{name}" eType="{target}" {rest}/>'


def number(name, kind, rest=""):
    return feature("EAttribute", name, f"ecore:EDataType {ECORE}#//{kind}", rest)


@pytest.fixture
def loaded(core, tmp_path):
    """Return a function that loads a metamodel of one class A and other classifiers."""

    def load(features, others=""):
        file = tmp_path / "a.ecore"
        body = f'<eClassifiers xsi:type="ecore:EClass" name="A">{features}</eClassifiers>{others}'
        file.write_text(f"{HEAD}\n<!-- comment -->\n{body}</ecore:EPackage>")
        return core.extended([MetamodelSource("urn:a", file, "plugin-a")])

    return load


def test_defaults_in_java_s_notation_are_those_of_pyecore_s_objects(loaded):
    features = (
        number("x", "EDouble", 'defaultValueLiteral="0x1p3"')
        + number("y", "EInt", 'defaultValueLiteral="+0007"')
        + number("z", "EBoolean", 'defaultValueLiteral="TRUE"')
    )
    made = loaded(features).metaclass("urn:a", "A").eclass()
    assert (made.x, made.y, made.z) == (8.0, 7, True)


def test_enumerations_of_pyecore_read_literals_and_may_have_any_names(loaded):
    literals = '<eLiterals name="name" literal="a-name"/><eLiterals name="eLiterals" value="1"/>'
    enumeration = f'<eClassifiers xsi:type="ecore:EEnum" name="E">{literals}</eClassifiers>'
    registry = loaded(feature("EAttribute", "e", "#//E", 'defaultValueLiteral="a-name"'), enumeration)
    kind = registry.epackage("urn:a").getEClassifier("E")
    assert (kind.name, [literal.name for literal in kind.eLiterals]) == ("E", ["name", "eLiterals"])
    assert kind.from_string("a-name") is kind.from_string("name") is kind.eLiterals[0]
    assert registry.metaclass("urn:a", "A").eclass().e is kind.eLiterals[0]
    assert registry.create("urn:a", "A").e == "name"


def test_data_types_of_a_package_read_values_as_java_does(loaded):
    declared = '<eClassifiers xsi:type="ecore:EDataType" name="D" instanceClassName="double"/>'
    kind = loaded("", declared).epackage("urn:a").getEClassifier("D")
    assert (kind.from_string("0x1p3"), kind.to_string(1e9), kind.default_value) == (8.0, "1.0E9", 0.0)


def test_keys_are_known_to_pyecore_s_references(everything):
    path = MODELS / "keyed.ecore"
    registry = everything.extended([MetamodelSource("urn:test:keyed", path)])
    features = (each for kind in registry.package("urn:test:keyed").metaclasses for each in kind.features)
    keyed = [each for each in features if each.keys and not each.type.is_entry]
    assert keyed
    for each in keyed:
        reference = each.owner.eclass.findEStructuralFeature(each.name)
        assert tuple(key.name for key in reference.eKeys) == each.keys


@pytest.mark.parametrize(
    ("features", "message"),
    [
        (number("x", "EClass"), "A.x: EClass is no EDataType"),
        (feature("EReference", "x", f"ecore:EClass {ECORE}#//EInt"), "A.x: EInt is no EClass"),
        (
            number("y", "EInt") + feature("EReference", "x", "#//A", 'eOpposite="#//A/y"'),
            "A.x: y is no EReference",
        ),
        (feature("EReference", "x", "#//A", 'eKeys="#//A/y"'), "A.x: urn:a#//A/y: no such reference"),
    ],
)
def test_what_is_of_another_kind_than_needed_is_refused_with_its_place(loaded, features, message):
    with pytest.raises(PluginError) as refused:
        loaded(features)
    assert str(refused.value).startswith("plugin-a: ")
    assert str(refused.value).endswith(f"a.ecore:3: urn:a: {message}")


def test_a_metamodel_that_nobody_uses_any_more_is_forgotten(core):
    registry = core.extended([MetamodelSource("urn:test:zoo", MODELS / "zoo.ecore")])
    package = weakref.ref(registry.epackage("urn:test:zoo"))
    del registry
    gc.collect()
    assert package() is None
