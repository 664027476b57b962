"""Forms of .ecore files that EMF reads: ours say the same of each; what EMF calls a fault is refused."""

from __future__ import annotations

import pytest
from emf_description import metamodel_lines, name

from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.datatypes import ECORE, XML_TYPES
from mmrs_core.languages.metamodels.export import export_metamodels, exported_names
from mmrs_core.languages.metamodels.parsing import read_tables
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import MetamodelSource, core_registry, registry_with
from mmrs_core.languages.writing import write_model

pytestmark = pytest.mark.peer

TOLD = ("PACKAGE", "CLASS", "SUPER", "FEATURE", "LITERAL", "DATATYPE")
NAMESPACES = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    f'xmi:version="2.0" xmlns:ecore="{ECORE}"'
)
TYPES = f"{XML_TYPES}#//"


def packaged(body, uri="urn:a"):
    head = f'name="{uri[4:]}" nsURI="{uri}" nsPrefix="{uri[4:]}"'
    return f"<ecore:EPackage {NAMESPACES} {head}>{body}</ecore:EPackage>"


def classed(called, body="", rest=""):
    return f'<eClassifiers xsi:type="ecore:EClass" name="{called}" {rest}>{body}</eClassifiers>'


def attribute(called, kind="EInt", rest=""):
    kind = kind if "#" in kind else f"{ECORE}#//{kind}"
    ecore = f'eType="ecore:EDataType {kind}"'
    return f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{called}" {ecore} {rest}/>'


def reference(called, kind, rest=""):
    kind = f'eType="{kind}"' if kind else ""
    return f'<eStructuralFeatures xsi:type="ecore:EReference" name="{called}" {kind} {rest}/>'


def generic(called, kind, content):
    head = f'<eStructuralFeatures xsi:type="ecore:{kind}" name="{called}">'
    return f"{head}<eGenericType {content}/></eStructuralFeatures>"


def linked(called, content):
    return f'<eStructuralFeatures xsi:type="ecore:EReference" name="{called}">{content}</eStructuralFeatures>'


B = {"b.ecore": packaged(classed("B", attribute("x") + reference("f", "#//B", 'xmi:id="_f"')), "urn:b")}
B_WITH_ID = {"b.ecore": B["b.ecore"].replace("<eClassifiers ", '<eClassifiers xmi:id="_b" ')}
TWO_ROOTS = (
    f'<xmi:XMI {NAMESPACES}><ecore:EPackage name="one" nsURI="urn:1" nsPrefix="one">'
    f'{classed("A", attribute("x"))}</ecore:EPackage><ecore:EPackage name="two" nsURI="urn:2" nsPrefix="two">'
    f"{classed('B', reference('r', '#/0/A') + reference('s', '#/1/B') + reference('t', '#//A'))}"
    "</ecore:EPackage></xmi:XMI>"
)
NUMBER = f'<eType xsi:type="ecore:EDataType" href="{ECORE}#//EInt"/>'
BOUND = '<eTypeParameters name="T"><eBounds eClassifier="#//Animal"/></eTypeParameters>'
CHAINED = '<eTypeParameters name="U"><eBounds eTypeParameter="#//Box/T"/></eTypeParameters>'
ARGUMENTS = '<eTypeArguments eClassifier="#//Animal"/>' * 3
BOX = "".join(
    (
        '<eClassifiers xsi:type="ecore:EClass" name="Box">',
        f'{BOUND}{CHAINED}<eTypeParameters name="V" xmi:id="_v"/>',
        generic("bounded", "EReference", 'eTypeParameter="#//Box/T"'),
        generic("chained", "EReference", 'eTypeParameter="#//Box/U"'),
        generic("free", "EReference", 'eTypeParameter="_v"'),
        generic("position", "EReference", 'eTypeParameter="#//Box/@eTypeParameters.0"'),
        generic("value", "EAttribute", 'eTypeParameter="#//Box/V"'),
        "</eClassifiers>",
    )
)
FORMS = {
    "types by href": {
        **B,
        "a.ecore": packaged(
            classed(
                "A",
                linked("r", '<eType xsi:type="ecore:EClass" href="b.ecore#//B"/>')
                + f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="n">{NUMBER}</eStructuralFeatures>',
            )
        ),
    },
    "supertypes by href": {**B, "a.ecore": packaged(classed("A", '<eSuperTypes href="b.ecore#//B"/>'))},
    "opposites by href": {
        "a.ecore": packaged(
            classed("A", reference("b", "#//B", 'containment="true" eOpposite="#//B/a"'))
            + classed(
                "B", linked("a", '<eType href="#//A" xsi:type="ecore:EClass"/><eOpposite href="#//A/b"/>')
            )
        )
    },
    "references by id": {
        "a.ecore": packaged(
            classed("B", attribute("x"), 'xmi:id="_1"')
            + classed("A", reference("r", "_1") + linked("s", '<eType xmi:idref="_1"/>'), 'eSuperTypes="_1"')
            + '<eClassifiers xsi:type="ecore:EEnum" xmi:id="_e" name="E"><eLiterals name="P"/></eClassifiers>'
            + classed("D", '<eStructuralFeatures xsi:type="ecore:EAttribute" name="e" eType="_e"/>')
        )
    },
    "references by id in another file": {
        **B_WITH_ID,
        "a.ecore": packaged(
            classed("A", reference("r", "ecore:EClass b.ecore#_b"), 'eSuperTypes="b.ecore#_b"')
        ),
    },
    "references by position": {
        **B,
        "a.ecore": packaged(
            f'<eSubpackages name="s" nsURI="urn:a:s" nsPrefix="s">{classed("S")}</eSubpackages>'
            + classed("B")
            + classed(
                "A",
                reference("r", "#//@eClassifiers.0")
                + reference("s", "#//@eSubpackages.0/S")
                + reference("t", "#//@eClassifiers[name='B']")
                + reference("u", "ecore:EClass b.ecore#//@eClassifiers.0"),
            )
        ),
    },
    "names in percent": {
        "a.ecore": packaged(
            classed("Bä") + classed("A", reference("r", "#//B%C3%A4") + reference("s", "#//Bä"))
        )
    },
    "no hash": {"a.ecore": packaged(classed("B") + classed("A", reference("r", "//B")))},
    "the type by xmi:type": {
        "a.ecore": packaged(classed("A", attribute("x")).replace("xsi:type", "xmi:type"))
    },
    "XMI 2.1": {
        "a.ecore": packaged(classed("A", attribute("x")))
        .replace("http://www.omg.org/XMI", "http://schema.omg.org/spec/XMI/2.1")
        .replace("xsi:type", "xmi:type")
    },
    "the default namespace": {
        "a.ecore": packaged(classed("A", attribute("x")))
        .replace("ecore:", "")
        .replace("xmlns:ecore", "xmlns")
        .replace("xmlns=", f'xmlns:e="{ECORE}" xmlns=')
        .replace('"EDataType ', '"e:EDataType ')
    },
    "attributes as elements": {
        "a.ecore": packaged(
            classed(
                "A",
                '<eStructuralFeatures xsi:type="ecore:EAttribute"><name>x</name><lowerBound>1</lowerBound>'
                f"<unsettable>true</unsettable>{NUMBER}</eStructuralFeatures>",
            )
        )
    },
    "several packages in one file": {"a.ecore": TWO_ROOTS},
    "several packages in another file": {
        "b.ecore": TWO_ROOTS,
        "a.ecore": packaged(
            classed(
                "A", reference("r", "ecore:EClass b.ecore#/1/B") + reference("s", "ecore:EClass b.ecore#//A")
            )
        ),
    },
    "a package inside that lies elsewhere": {
        **B,
        "a.ecore": packaged(
            '<eSubpackages href="b.ecore#/"/>' + classed("A", reference("r", "ecore:EClass b.ecore#//B"))
        ),
    },
    "generics": {
        "a.ecore": packaged(
            classed("Animal", attribute("n", "EString"))
            + BOX
            + classed("Cage", f'<eGenericSuperTypes eClassifier="#//Box">{ARGUMENTS}</eGenericSuperTypes>')
        )
    },
    "generics by href": {
        "a.ecore": packaged(
            classed("B")
            + classed(
                "A",
                '<eGenericSuperTypes><eClassifier xsi:type="ecore:EClass" href="#//B"/></eGenericSuperTypes>'
                + linked(
                    "r", '<eGenericType><eClassifier xsi:type="ecore:EClass" href="#//B"/></eGenericType>'
                ),
            )
        )
    },
    "unspecified bounds": {
        "a.ecore": packaged(
            classed(
                "A",
                attribute("x", rest='upperBound="-2"')
                + attribute("y", rest='upperBound="-2" defaultValueLiteral="4" lowerBound="+1"')
                + attribute("z", rest='upperBound="-1" unsettable="TRUE"'),
            )
        )
    },
    "defaults in Java's notation": {
        "a.ecore": packaged(
            classed(
                "A",
                attribute("x", "EDouble", 'defaultValueLiteral="0x1p3"')
                + attribute("y", "EInt", 'defaultValueLiteral="+0007"')
                + attribute("z", "EBigInteger", f'defaultValueLiteral="{"9" * 5000}"'),
            )
        )
    },
    "empty literals": {
        "a.ecore": packaged(
            '<eClassifiers xsi:type="ecore:EEnum" name="E"><eLiterals name="P"/>'
            '<eLiterals name="Q" value="-2147483648" literal=""/></eClassifiers>'
        )
    },
    "types of Java": {
        "a.ecore": packaged(
            classed(
                "A",
                "".join(
                    attribute(f"x{kind}", kind, 'transient="true"')
                    for kind in (
                        "EResource",
                        "EResourceSet",
                        "EEnumerator",
                        "EDiagnosticChain",
                        "EFeatureMap",
                    )
                ),
            )
        )
    },
    "references into Ecore": {
        "a.ecore": packaged(
            classed(
                "A",
                "".join(
                    reference(f"x{kind}", f"ecore:EClass {ECORE}#//{kind}", rest)
                    for kind, rest in (
                        ("EClass", ""),
                        ("EPackage", 'containment="true"'),
                        ("EClassifier", 'upperBound="-1"'),
                        ("EModelElement", ""),
                        ("EObject", ""),
                    )
                ),
                f'eSuperTypes="{ECORE}#//EAnnotation"',
            )
        )
    },
    "anything of XML": {
        "a.ecore": packaged(
            classed("A", reference("x", f"ecore:EClass {TYPES}AnyType", 'containment="true"'))
        )
    },
}
REFUSED = {
    "a bound that is too large": (
        classed("A", attribute("x", rest='upperBound="99999999999"')),
        "upperBound",
    ),
    "a bound in Python's notation": (classed("A", attribute("x", rest='lowerBound="1_0"')), "lowerBound"),
    "a bound after a blank": (classed("A", attribute("x", rest='lowerBound=" 1"')), "lowerBound"),
    "a flag that is yes": (classed("A", attribute("x", rest='unsettable="yes"')), "unsettable: 'yes'"),
    "a flag that is empty": (classed("A", attribute("x", rest='ordered=""')), "ordered: ''"),
    "an unknown id": (classed("A", reference("r", "_9")), "eType: '_9' leads to no element"),
    "a name": (classed("A", reference("r", "A")), "eType: 'A' leads to no element"),
    "a type without an address": (classed("A", linked("r", "<eType>#//A</eType>")), "eType: leads nowhere"),
    "a feature of no kind": (classed("A", '<eStructuralFeatures name="r" eType="#//A"/>'), "no xsi:type"),
    "an unknown parameter": (
        classed("A", generic("r", "EReference", 'eTypeParameter="#//A/T"')),
        "no type parameter of A",
    ),
    "a value of an enumeration": (
        '<eClassifiers xsi:type="ecore:EEnum" name="E">'
        '<eLiterals name="P" value="99999999999"/></eClassifiers>',
        "value: '99999999999'",
    ),
    "two classifiers of one name": (classed("A") + classed("A"), "EClass A is declared twice"),
}


@pytest.fixture
def written(tmp_path):
    """Return a function that writes files by name and returns their paths."""

    def write(texts):
        for file, text in texts.items():
            (tmp_path / file).write_text(text, encoding="utf-8")
        return [tmp_path / file for file in texts]

    return write


def registry_of(files):
    return registry_with([MetamodelSource(read_tables(file)[0].ns_uri, file, file.stem) for file in files])


def ours(registry):
    core = frozenset(metamodel_lines(core_registry()))
    return sorted(set(metamodel_lines(registry)) - core)


def theirs(referee):
    return sorted({line for line in referee.ask("describe").lines if line.startswith(TOLD)})


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
        read_tables(file)
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
    with pytest.raises(PluginError, match=r"a: urn:a: A\.r: eType is missing"):
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
