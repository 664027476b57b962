"""Forms of .ecore files that EMF reads: ours say the same of each; what EMF calls a fault is refused."""

import pytest
from emf_description import metamodel_lines, name
from metamodel_forms import FORMS, NAMESPACES, REFUSED, classed, packaged, reference

from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.datatypes import ECORE, XML_TYPES
from mmrs_core.languages.metamodels.ecore_file import read_ecore
from mmrs_core.languages.metamodels.export import export_metamodels, exported_names
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import MetamodelSource, core_registry, registry_with
from mmrs_core.languages.writing import write_model

pytestmark = [pytest.mark.together("emf"), pytest.mark.peer]

TOLD = ("PACKAGE", "CLASS", "SUPER", "FEATURE", "LITERAL", "DATATYPE")


@pytest.fixture
def written(tmp_path):
    """Return a function that writes files by name and returns their paths."""

    def write(texts):
        for file, text in texts.items():
            (tmp_path / file).write_text(text, encoding="utf-8")
        return [tmp_path / file for file in texts]

    return write


def registry_of(files):
    return registry_with([MetamodelSource(read_ecore(file).ns_uris[0], file, file.stem) for file in files])


def ours(registry):
    core = frozenset(metamodel_lines(core_registry()))
    return sorted(set(metamodel_lines(registry)) - core)


def theirs(referee):
    lines = (line for line in referee.ask("describe").lines if line.startswith(TOLD))
    return sorted({line.replace("..-2 ", "..1 ") for line in lines})  # unspecified, which means one value


@pytest.mark.parametrize("form", FORMS)
def test_every_form_of_a_metamodel_means_to_us_what_it_means_to_emf(referee, written, form):
    files = written(FORMS[form])
    with referee.knowing(*files) as verdict:
        assert verdict.faults == []
        assert ours(registry_of(files)) == theirs(referee)


@pytest.mark.parametrize("form", FORMS)
def test_every_form_is_exported_with_the_same_meaning(referee, written, tmp_path, form):
    registry = registry_of(written(FORMS[form]))
    core = {package.ns_uri for package in core_registry().packages}
    names = {name for ns_uri, name in exported_names(registry).items() if ns_uri not in core}
    export_metamodels(registry, tmp_path / "out")
    files = sorted(tmp_path / "out" / name for name in names)
    with referee.knowing(*files) as verdict:
        assert verdict.faults == []
        assert theirs(referee) == ours(registry)


@pytest.mark.parametrize("form", REFUSED)
def test_what_emf_calls_a_fault_is_refused_with_its_place(referee, written, form):
    body, message = REFUSED[form]
    (file,) = written({"a.ecore": packaged(f"\n{body}")})
    with referee.knowing(file) as verdict:
        assert not verdict.accepted
    with pytest.raises(UnreadableError) as refused:
        registry_of([file])
    assert f"{file}:2: " in str(refused.value)
    assert message in str(refused.value)


REFERRING = """<a:A {namespaces} xmlns:a="urn:a" one="ecore:EClass a.ecore#//A">
  <of xsi:type="ecore:EDataType" href="{ecore}#//EString"/>
  <of xsi:type="ecore:EClass" href="{ecore}#//EClass"/>
  <of xsi:type="ecore:EDataType" href="http://www.eclipse.org/emf/2003/XMLType#//Date"/>
  <of xsi:type="ecore:EClass" href="a.ecore#//A"/>
  <of xsi:type="ecore:EClass" href="a.ecore#//inner/Ä"/>
  <of xsi:type="ecore:EClass" href="#//@own/@eClassifiers.0"/>
  <own name="p" nsURI="urn:p" nsPrefix="p">
    <eClassifiers xsi:type="ecore:EClass" name="K" eSuperTypes="#//@own/@eClassifiers.1"/>
    <eClassifiers xsi:type="ecore:EClass" name="L"/>
  </own>
</a:A>"""


def test_emf_finds_a_model_that_refers_to_metamodels_equal_once_we_wrote_it(referee, written, tmp_path):
    kind = f"ecore:EClass {ECORE}#//"
    features = (
        reference("one", f"{kind}EClass")
        + reference("of", f"{kind}EClassifier", 'upperBound="-1"')
        + reference("own", f"{kind}EPackage", 'containment="true"')
    )
    inner = f'<eSubpackages name="inner" nsURI="urn:a:inner" nsPrefix="i">{classed("Ä")}</eSubpackages>'
    text = REFERRING.format(namespaces=NAMESPACES, ecore=ECORE)
    ecore, model = written({"a.ecore": packaged(classed("A", features) + inner), "a.xmi": text})
    with referee.knowing(ecore):
        assert referee.ask("check", model).faults == []
        registry = registry_of([ecore])
        found = read_model(model, registry)
        assert found.diagnostics == check_conformance(found, registry) == ()
        write_model(found.roots, tmp_path / "again.xmi", registry)
        assert referee.ask("check", tmp_path / "again.xmi").faults == []
        assert "EQUAL" in referee.ask("equal", model, tmp_path / "again.xmi").lines


def test_ecore_itself_is_to_us_what_it_is_to_emf(referee):
    said = set(referee.ask("itself").lines)
    for package in (each for each in core_registry().everything if each.ns_uri in (ECORE, XML_TYPES)):
        for metaclass in package.metaclasses:
            assert [name(above) for above in metaclass.supertypes] == supertypes(said, metaclass)
    mine = [
        line for line in metamodel_lines(_Itself()) if line.startswith(("FEATURE", "PACKAGE", "DATATYPE"))
    ]
    assert [line for line in mine if line not in said] == []
    stored = {line for line in said if line.startswith("FEATURE") and " transient=false " in line}
    types = {line for line in said if line.startswith("DATATYPE")}
    assert [name for name in types - set(mine) if "EFeatureMapEntry" not in name] == []
    lacking = {line for line in stored - set(mine) if "EFeatureMapEntry" not in line}
    assert {line.split()[2] for line in lacking} == {"instanceType"}  # whose class is of feature maps


def test_a_feature_without_a_type_is_refused_as_emf_refuses_it(referee, written):
    (file,) = written({"a.ecore": packaged(classed("A", reference("r", "")))})
    with referee.knowing(file) as verdict:
        assert not verdict.accepted
    with pytest.raises(PluginError, match=r"a\.ecore:1: urn:a: A\.r: eType is missing"):
        registry_of([file])


def supertypes(said, metaclass):
    begin = f"SUPER {name(metaclass)} "
    return [line.removeprefix(begin) for line in said if line.startswith(begin)]


class _Itself:
    """Ecore and the types of XML, in the place of a registry's packages."""

    packages = tuple(each for each in core_registry().everything if each.ns_uri in (ECORE, XML_TYPES))


@pytest.mark.parametrize("prefix", ["a b", "1", "a:b", "größe", "&amp;", "xmlfoo", ""])
def test_emf_reads_what_we_write_whatever_prefix_a_metamodel_states(referee, written, tmp_path, prefix):
    (ecore,) = written({"a.ecore": packaged(classed("A")).replace('nsPrefix="a"', f'nsPrefix="{prefix}"')})
    registry = registry_of([ecore])
    write_model([registry.create("urn:a", "A")], tmp_path / "a.xmi", registry)
    with referee.knowing(ecore):
        assert referee.ask("check", tmp_path / "a.xmi").faults == []
