"""What pyecore has of metamodels that it would not read, or not read rightly, by itself."""

import gc
import subprocess
import sys
import weakref
from pathlib import Path

import pytest
from pyecore import ecore
from pyecore.resources import URI
from pyecore.resources.xmi import XMIResource

from mmrs_core.errors import PluginError, UnsupportedError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.ecore_api.bridge import from_pyecore
from mmrs_core.languages.metamodels.loading import load_alone
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.languages.writing import to_xmi

HEAD = (
    '<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    f'xmlns:ecore="{ECORE}" name="a" nsURI="urn:a" nsPrefix="a">'
)
MISSION = "urn:mmrs:mission:1.0#//Mission"
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
        (
            feature("EReference", "x", MISSION, f'eOpposite="{MISSION}/tasks"'),
            "A.x: its opposite Mission.tasks does not name it back",
        ),
    ],
)
def test_what_is_of_another_kind_than_needed_is_refused_with_its_place(loaded, features, message):
    with pytest.raises(PluginError) as refused:
        loaded(features)
    assert str(refused.value).startswith("plugin-a: ")
    assert str(refused.value).endswith(f"a.ecore:3: urn:a: {message}")


def test_a_metamodel_that_was_refused_leaves_nothing_behind(loaded):
    before = set(ecore.EInt._inverse_rels)
    with pytest.raises(PluginError, match="is no EReference"):
        loaded(number("y", "EInt") + feature("EReference", "x", "#//A", 'eOpposite="#//A/y"'))
    assert ecore.EInt._inverse_rels == before


def test_alone_a_metamodel_is_loaded_whatever_it_refers_to_elsewhere(tmp_path):
    links = 'eOpposite="gone.ecore#//B/a" eKeys="gone.ecore#//B/n"'
    features = feature("EReference", "x", "ecore:EClass gone.ecore#//B", links)
    (tmp_path / "a.ecore").write_text(
        f'{HEAD}<eClassifiers xsi:type="ecore:EClass" name="A">{features}</eClassifiers></ecore:EPackage>'
    )
    (package,) = load_alone(tmp_path / "a.ecore")
    (reference,) = package.getEClassifier("A").eStructuralFeatures
    assert (reference.eType.name, reference.eType.ePackage.nsURI) == ("B", "gone.ecore")


def test_a_metamodel_that_nobody_uses_any_more_is_forgotten(core):
    registry = core.extended([MetamodelSource("urn:test:zoo", MODELS / "zoo.ecore")])
    package = weakref.ref(registry.epackage("urn:test:zoo"))
    del registry
    gc.collect()
    assert package() is None


@pytest.fixture
def taken(core):
    """Return a function that takes an EPackage of a class A with some features, made in Python."""

    def take(features, others=()):
        package = ecore.EPackage("a", nsURI="urn:a", nsPrefix="a")
        kind = ecore.EClass("A")
        kind.eStructuralFeatures.extend(features)
        package.eClassifiers.extend([kind, *others])
        return core.extended([MetamodelSource("urn:a", package, "plugin-a")])

    return take


def test_defaults_that_were_given_in_python_hold(taken):
    length = ecore.EDataType("Length", float, 1.5)
    features = [
        ecore.EAttribute("x", ecore.EDouble, default_value="2.5"),
        ecore.EAttribute("y", ecore.EInt, default_value=7),
        ecore.EAttribute("z", length),
        ecore.EAttribute("w", ecore.EBoolean, default_value="true"),
    ]
    made = taken(features, [length]).create("urn:a", "A")
    assert (made.x, made.y, made.z, made.w) == (2.5, 7, 1.5, True)


def test_a_default_of_another_type_is_refused(taken):
    with pytest.raises(PluginError, match=r"^plugin-a: urn:a: A\.x: default 'abc': not a whole number"):
        taken([ecore.EAttribute("x", ecore.EInt, default_value="abc")])


def test_values_of_a_type_made_in_python_are_read_and_written_by_its_functions(taken):
    pair = ecore.EDataType(
        "Pair",
        tuple,
        from_string=lambda text: tuple(map(float, text.split(","))),
        to_string=lambda value: ",".join(map(str, value)),
    )
    registry = taken([ecore.EAttribute("x", pair)], [pair])
    written = to_xmi([registry.create("urn:a", "A", x=(1.0, 2.5))], registry)
    assert b'x="1.0,2.5"' in written
    assert read_text(written, "a.xmi", registry).roots[0].x == (1.0, 2.5)
    wrong = read_text(written.replace(b"1.0,2.5", b"one"), "a.xmi", registry)
    (fault,) = wrong.diagnostics
    assert "'one': not of the type Pair" in fault.message


def test_what_an_epackage_refers_to_in_vain_is_refused(taken, tmp_path):
    with pytest.raises(PluginError, match=r"^plugin-a: urn:a: A\.x: Lost is in no EPackage"):
        taken([ecore.EReference("x", ecore.EClass("Lost"))])
    proxied = ecore.EReference("x")
    proxied.eType = ecore.EProxy("gone.ecore#//B", XMIResource(URI(str(tmp_path / "a.ecore"))))
    with pytest.raises(PluginError, match=r"^plugin-a: urn:a: A\.x: pyecore does not find what it refers to"):
        taken([proxied])


def test_a_metamodel_that_an_epackage_needs_is_named(taken):
    other = ecore.EPackage("o", nsURI="urn:o", nsPrefix="o")
    other.eClassifiers.append(ecore.EClass("B"))
    with pytest.raises(PluginError, match=r"A\.x: needs the metamodel urn:o \(for B\)"):
        taken([ecore.EReference("x", other.getEClassifier("B"))])


def test_features_that_were_added_later_are_not_dropped(taken):
    registry = taken([])
    eclass = registry.metaclass("urn:a", "A").eclass
    eclass.eStructuralFeatures.append(ecore.EAttribute("late", ecore.EInt))
    with pytest.raises(UnsupportedError, match=r"A\.late: added to the EClass after it was loaded"):
        from_pyecore([eclass(late=1)], registry)


def test_threads_that_ask_first_get_the_same_languages():
    code = (
        "from concurrent.futures import ThreadPoolExecutor\n"
        "from mmrs_core.languages.registry import core_registry\n"
        "with ThreadPoolExecutor(6) as pool:\n"
        "    print(len({id(each) for each in pool.map(lambda _: core_registry(), range(6))}))"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said == "1\n"


def test_metamodels_of_other_plug_ins_stay_where_one_brings_an_epackage(everything):
    sources = [
        MetamodelSource(each.ns_uri, each.ecore, "p")
        for each in everything.packages
        if "mmrs:s" in each.ns_uri
    ]
    package = ecore.EPackage("a", nsURI="urn:a", nsPrefix="a")
    sources.append(MetamodelSource("urn:a", package, "plugin-a"))
    one, other = registry_with(sources), registry_with(sources)
    assert [each for each in one.packages if each not in other.packages] == []
