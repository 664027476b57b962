import gc
import re
from pathlib import Path
from weakref import ref

import pytest

from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages import mission
from mmrs_core.languages.datatypes import XML_TYPES
from mmrs_core.languages.registry import MetamodelSource, core_registry, registry_with

HEAD = (
    '<ecore:EPackage xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"'
)

TWICE = (
    'name="a" nsURI="urn:a"><eClassifiers xsi:type="ecore:EClass" name="A"/>'
    '<eClassifiers xsi:type="ecore:EEnum" name="A"/></ecore:EPackage>'
)
UNTYPED = '<eStructuralFeatures xsi:type="ecore:EAttribute" name="n"/>'


@pytest.fixture
def package(tmp_path):
    """Return a function that writes an .ecore and returns its source."""

    def write(name, content, folder=""):
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        path = tmp_path / folder / f"{name}.ecore"
        path.write_text(
            f'{HEAD} name="{name}" nsURI="urn:t:{folder}{name}" nsPrefix="{name}">{content}</ecore:EPackage>'
        )
        return MetamodelSource(f"urn:t:{folder}{name}", path, f"plugin-{name}")

    return write


def eclass(name, supertypes="", content=""):
    head = f'<eClassifiers xsi:type="ecore:EClass" name="{name}" eSuperTypes="{supertypes}">'
    return f"{head}{content}</eClassifiers>"


def attribute(name, kind, rest=""):
    ecore = "ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//"
    kind = kind if "#" in kind else f"{ecore}{kind}"
    return f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{name}" eType="{kind}" {rest}/>'


def test_the_core_is_loaded_once_and_shared(everything):
    assert core_registry() is core_registry()
    task = core_registry().metaclass("urn:mmrs:mission:1.0", "Task")
    assert everything.metaclass("urn:mmrs:mission:1.0", "Task") is task
    assert task.interface is mission.Task


def test_every_class_and_feature_of_the_languages_is_documented(everything):
    for package in everything.packages:
        assert package.documentation, package
        for metaclass in package.metaclasses:
            assert metaclass.documentation, metaclass
            for feature in metaclass.features:
                assert feature.documentation, feature


def test_packages_say_who_provides_them(everything):
    providers = {package.ns_uri: package.provider for package in everything.packages}
    assert providers["urn:mmrs:mission:1.0"] == "core"
    assert providers["urn:mmrs:survey:1.0"] == "survey"


def test_sources_may_come_in_any_order_and_refer_in_circles(package):
    one = package("one", eclass("A", "urn:t:two#//B") + eclass("C"))
    two = package("two", eclass("B", "urn:t:one#//C"))
    for sources in ([one, two], [two, one]):
        registry = registry_with(sources)
        assert registry.metaclass("urn:t:one", "A").is_kind("urn:t:one", "C")


def test_classes_that_nothing_uses_any_more_are_let_go(package):
    source = package("one", eclass("A"))
    one = ref(registry_with([source]).metaclass("urn:t:one", "A").interface)
    kept = one()
    gc.collect()
    assert registry_with([source]).metaclass("urn:t:one", "A").interface is kept
    del kept
    gc.collect()
    assert one() is None


def test_supertypes_in_an_order_that_python_refuses(package):
    content = (
        eclass("X")
        + eclass("Y")
        + eclass("A", "#//X #//Y")
        + eclass("B", "#//Y #//X")
        + eclass("C", "#//A #//B")
    )
    registry = registry_with([package("odd", content)])
    made = registry.create("urn:t:odd", "C")
    kinds = [registry.metaclass("urn:t:odd", name) for name in "XYAB"]
    assert all(isinstance(made, kind.interface) for kind in kinds)


def test_two_files_of_one_name_are_not_confused(package):
    types = eclass("T")
    one, other = package("types", types, "a/"), package("types", types, "b/")
    use_one = package("use", eclass("U", "types.ecore#//T"), "a/")
    use_other = package("use", eclass("U", "types.ecore#//T"), "b/")
    registry = registry_with([one, use_one, other, use_other])
    assert registry.metaclass("urn:t:b/use", "U").ancestry[1] == ("urn:t:b/types", "T")
    assert registry.metaclass("urn:t:a/use", "U").ancestry[1] == ("urn:t:a/types", "T")


def test_one_file_by_two_ways_is_one_metamodel(package, tmp_path):
    one = package("one", eclass("A"), "a/")
    (tmp_path / "link").symlink_to(tmp_path / "a")
    two = package("two", eclass("B", "../link/one.ecore#//A") + eclass("C", "../a/./one.ecore#//A"))
    registry = registry_with([one, two])
    assert registry.metaclass("urn:t:two", "B").supertypes == registry.metaclass("urn:t:two", "C").supertypes


@pytest.mark.parametrize(
    "uri",
    [
        "platform:/resource/some.project/model/one.ecore#//A",
        "platform:/plugin/some.project/model/one.ecore#//A",
        "../../some.project/model/one.ecore#//A",
    ],
)
def test_paths_of_an_eclipse_workspace_lead_to_the_file_of_that_name(package, uri):
    registry = registry_with([package("one", eclass("A")), package("two", eclass("B", uri))])
    assert registry.metaclass("urn:t:two", "B").is_kind("urn:t:one", "A")


def test_ecore_itself_may_be_named_as_eclipse_does(package):
    kind = "ecore:EDataType platform:/plugin/org.eclipse.emf.ecore/model/Ecore.ecore#//EInt"
    registry = registry_with([package("one", eclass("A", "", attribute("n", kind)))])
    assert registry.metaclass("urn:t:one", "A").feature("n").type.name == "EInt"


def test_packages_inside_packages_are_metamodels_of_their_own(zoo):
    assert [package.parent for package in zoo.packages][-1] == "urn:test:zoo"
    assert zoo.metaclass("urn:test:zoo:wing", "Parrot").is_kind("urn:test:zoo", "Animal")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (eclass("A", "urn:t:gone#//B"), "urn:t:bad needs the metamodel urn:t:gone"),
        (eclass("A", "gone.ecore#//B"), "urn:t:bad needs the metamodel gone.ecore beside"),
        (eclass("A", "http://127.0.0.1:1/x#//B"), "needs the metamodel http://127.0.0.1:1/x"),
        (eclass("A", "#//A"), "class A inherits from itself"),
        (eclass("A", "#//B") + eclass("B", "#//A"), "inherits from itself"),
        (eclass("A", "#//Bee") + eclass("Be"), "no type Bee in urn:t:bad; did you mean Be?"),
        (eclass("A", "", attribute("n", "EIntt")), "A.n: no type EIntt"),
        (eclass("A", "", attribute("n", "EInt", 'defaultValueLiteral="x"')), "A.n: default 'x': not a whole"),
        (eclass("A", "", attribute("n", "EInt") * 2), "A has two features n"),
        (eclass("A", "", UNTYPED), "A.n: eType is missing"),
        (eclass("A", "urn:mmrs:mission:1.0#//Misson"), "did you mean Mission?"),
        (
            eclass("A", "", attribute("n", "EDate", 'defaultValueLiteral="1500-01-01"')),
            "before 15 October 1582",
        ),
    ],
)
def test_a_faulty_metamodel_names_its_provider_and_the_fault(package, content, message):
    with pytest.raises(PluginError) as raised:
        registry_with([package("bad", content)])
    assert message in str(raised.value)
    assert re.match(r"plugin-bad: \S+bad\.ecore:[0-9]+: ", str(raised.value))
    assert str(raised.value).startswith("plugin-bad: ")


@pytest.mark.parametrize(
    ("kind", "instead"),
    [
        ("Duration", "use EDouble"),
        *((f"G{part}", "use EDate") for part in ("Day", "Month", "MonthDay", "Year")),
    ],
)
def test_a_type_of_xml_schema_that_ecore_has_no_like_of_is_refused_by_name(package, kind, instead):
    source = package("bad", eclass("A", "", attribute("n", f"ecore:EDataType {XML_TYPES}#//{kind}")))
    words = f"A.n: the type {kind} of XML Schema is not supported; {instead}"
    with pytest.raises(PluginError, match=f"^plugin-bad: .*{words}"):
        registry_with([source])


def test_one_ns_uri_twice_is_an_error_that_names_both(package):
    source = package("one", eclass("A"))
    with pytest.raises(PluginError, match=r"other: metamodel urn:t:one is already provided by plugin-one"):
        registry_with([source, MetamodelSource(source.ns_uri, source.ecore, "other")])


def test_a_plug_in_cannot_replace_a_core_language(tmp_path):
    path = tmp_path / "x.ecore"
    path.write_text(f'{HEAD} name="mission" nsURI="urn:mmrs:mission:1.0"/>')
    with pytest.raises(PluginError, match="already provided by core"):
        registry_with([MetamodelSource("urn:mmrs:mission:1.0", path, "x")])


def test_a_file_that_holds_another_metamodel_is_an_error(package):
    source = package("one", eclass("A"))
    with pytest.raises(PluginError, match=r"one\.ecore holds urn:t:one, not urn:t:other"):
        registry_with([MetamodelSource("urn:t:other", source.ecore, "p")])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<x/>", "no metamodel"),
        (f"{HEAD}/>", "name is missing"),
        (f'{HEAD} name="a"/>', "nsURI is missing"),
        (f'{HEAD} name="a" nsURI="urn:a"><eClassifiers name="A"/></ecore:EPackage>', "no kind of classifier"),
        (f"{HEAD} {TWICE}", "a.ecore:1: eClassifiers: EEnum A is declared twice, before in line 1"),
        ("<!DOCTYPE x><x/>", "DOCTYPE"),
        ("junk", "not well-formed"),
    ],
)
def test_a_file_that_is_no_metamodel_is_unreadable(tmp_path, text, message):
    path = tmp_path / "a.ecore"
    path.write_text(text)
    with pytest.raises(UnreadableError, match=message) as refused:
        registry_with([MetamodelSource("urn:a", path, "p")])
    assert re.match(r"p: \S+a\.ecore:[0-9]+: ", str(refused.value))
    with pytest.raises(UnreadableError, match=r"^p: gone\.ecore: no such file"):
        registry_with([MetamodelSource("urn:a", Path("gone.ecore"), "p")])
