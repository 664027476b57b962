"""Forms of .ecore files that tools write, and what hostile ones run into."""

import tracemalloc
from pathlib import Path

import pytest

from mmrs_core.errors import MmrsError, PluginError, UnreadableError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.element import Element
from mmrs_core.languages.metamodels import ecore_file
from mmrs_core.languages.metamodels.ecore_file import MOST_REFERENCES, EcoreFile
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.registry import MetamodelSource

NAMESPACES = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    f'xmi:version="2.0" xmlns:ecore="{ECORE}"'
)
NUMBER = f'eType="ecore:EDataType {ECORE}#//EInt"'
ONE_MEGABYTE = 1_000_000


def packaged(body, name="a"):
    head = f'name="{name}" nsURI="urn:{name}" nsPrefix="{name}"'
    return f"<ecore:EPackage {NAMESPACES} {head}>\n{body}</ecore:EPackage>"


def classed(name, body="", rest=""):
    return f'<eClassifiers xsi:type="ecore:EClass" name="{name}" {rest}>{body}</eClassifiers>'


def attribute(name, rest=NUMBER):
    return f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{name}" {rest}/>'


def reference(name, kind):
    return f'<eStructuralFeatures xsi:type="ecore:EReference" name="{name}" eType="{kind}"/>'


@pytest.fixture
def registry_of(tmp_path):
    """Return a function that gives the registry of metamodels (text by file name), the first one given."""

    def make(texts, installed=()):
        for name, text in texts.items():
            (tmp_path / name).write_text(text, encoding="utf-8")
        return registry_of_files([tmp_path / next(iter(texts))], installed)[0]

    return make


def test_what_lies_in_other_files_is_referred_to_by_elements_of_their_own(registry_of):
    link = '<eType xsi:type="ecore:EClass" href="b.ecore#//B"/><eOpposite href="b.ecore#//B/a"/>'
    held = f'<eStructuralFeatures xsi:type="ecore:EReference" name="b">{link}</eStructuralFeatures>'
    back = reference("a", "ecore:EClass a.ecore#//A").replace("/>", '><eOpposite href="a.ecore#//A/b"/>')
    registry = registry_of(
        {
            "a.ecore": packaged(classed("A", f'<eSuperTypes href="b.ecore#//B"/>{held}')),
            "b.ecore": packaged(classed("B", f"{back}</eStructuralFeatures>"), "b"),
        }
    )
    feature = registry.metaclass("urn:a", "A").by_name["b"]
    assert registry.metaclass("urn:a", "A").is_kind("urn:b", "B")
    assert feature.type is registry.metaclass("urn:b", "B")
    assert feature.opposite is registry.metaclass("urn:b", "B").by_name["a"]


def test_references_by_id_lead_to_what_has_it(registry_of):
    body = classed("B", "", 'xmi:id="_1"') + classed("A", reference("r", "_1"), 'eSuperTypes="_1"')
    kind = registry_of({"a.ecore": packaged(body)}).metaclass("urn:a", "A")
    assert [above.name for above in kind.supertypes] == ["B"]
    assert kind.by_name["r"].type.name == "B"


def test_keys_by_id_lead_to_what_has_it(registry_of):
    keyed = reference("r", "#//B").replace("/>", ' upperBound="-1" eKeys="_n"/>')
    body = classed("B", attribute("n", f'{NUMBER} xmi:id="_n"')) + classed("A", keyed)
    assert registry_of({"a.ecore": packaged(body)}).metaclass("urn:a", "A").by_name["r"].keys == ("n",)


def test_an_id_that_nothing_has_is_refused_with_its_place(tmp_path):
    (tmp_path / "a.ecore").write_text(packaged(classed("A", reference("r", "_9"))))
    with pytest.raises(UnreadableError, match=r"a\.ecore:2: eStructuralFeatures: eType: '_9' leads to no"):
        registry_of_files([tmp_path / "a.ecore"], ())


def test_a_number_says_which_of_several_packages_is_meant(registry_of):
    one = '<ecore:EPackage name="one" nsURI="urn:1">' + classed("A") + "</ecore:EPackage>"
    body = classed("B", reference("r", "#/0/A") + reference("s", "#/1/B") + reference("t", "//A"))
    two = f'<ecore:EPackage name="two" nsURI="urn:2">{body}</ecore:EPackage>'
    registry = registry_of({"a.ecore": f"<xmi:XMI {NAMESPACES}>{one}{two}</xmi:XMI>"})
    types = [feature.type.key for feature in registry.metaclass("urn:2", "B").features]
    assert types == [("urn:1", "A"), ("urn:2", "B"), ("urn:1", "A")]


def test_a_number_of_no_package_is_refused(registry_of):
    body = classed("A", reference("r", f"#/{'9' * 5000}/A"))
    with pytest.raises(PluginError, match=r"urn:a: #/9{20,}\.\.\.: no package 9"):
        registry_of({"a.ecore": packaged(body)})


def test_a_package_inside_an_installed_one_can_be_referred_to(registry_of, zoo):
    source = MetamodelSource("urn:test:zoo", zoo.package("urn:test:zoo").ecore)
    body = classed("Macaw", "", 'eSuperTypes="urn:test:zoo#//wing/Parrot"')
    registry = registry_of({"a.ecore": packaged(body)}, [source])
    assert registry.metaclass("urn:a", "Macaw").is_kind("urn:test:zoo:wing", "Parrot")


def generic(name, kind, parameter):
    head = f'<eStructuralFeatures xsi:type="ecore:{kind}" name="{name}">'
    return f'{head}<eGenericType eTypeParameter="#//Box/{parameter}"/></eStructuralFeatures>'


@pytest.mark.parametrize(
    ("feature", "kind"),
    [
        (generic("x", "EReference", "T"), "Animal"),
        (generic("x", "EReference", "U"), "Animal"),
        (generic("x", "EReference", "V"), "EObject"),
        (generic("x", "EAttribute", "V"), "EJavaObject"),
        (generic("x", "EReference", "W"), "EObject"),
    ],
)
def test_a_type_parameter_stands_for_its_bound(registry_of, feature, kind):
    parameters = (
        '<eTypeParameters name="T"><eBounds eClassifier="#//Animal"/></eTypeParameters>'
        '<eTypeParameters name="U"><eBounds eTypeParameter="#//Box/T"/></eTypeParameters>'
        '<eTypeParameters name="V"/>'
        '<eTypeParameters name="W"><eBounds eTypeParameter="#//Box/W"/></eTypeParameters>'
    )
    body = classed("Animal") + classed("Box", parameters + feature)
    registry = registry_of({"a.ecore": packaged(body)})
    assert registry.metaclass("urn:a", "Box").by_name["x"].type.name == kind


@pytest.mark.parametrize(("upper", "many"), [("-2", False), ("-1", True), ("1", False), ("2", True)])
def test_an_unspecified_upper_bound_means_one_value(registry_of, upper, many):
    body = classed("A", attribute("n", f'{NUMBER} upperBound="{upper}"'))
    feature = registry_of({"a.ecore": packaged(body)}).metaclass("urn:a", "A").by_name["n"]
    assert (feature.many, feature.most) == (many, int(upper) if many else 1)
    assert feature.default == (None if many else 0)


@pytest.mark.parametrize(
    ("rest", "message"),
    [
        ('upperBound="99999999999"', "upperBound: '99999999999' does not fit into 32 bits"),
        ('lowerBound="1_0"', "lowerBound: '1_0' is not a whole number"),
        ('lowerBound=" 1"', "lowerBound: ' 1' is not a whole number"),
        ('unsettable="yes"', "unsettable: 'yes': not true or false"),
        ('volatile="1"', "volatile: '1': not true or false"),
    ],
)
def test_bounds_and_flags_that_emf_cannot_read_are_refused_with_their_place(tmp_path, rest, message):
    (tmp_path / "a.ecore").write_text(packaged(classed("A", attribute("n", f"{NUMBER} {rest}"))))
    with pytest.raises(UnreadableError) as refused:
        registry_of_files([tmp_path / "a.ecore"], ())
    assert str(refused.value) == f"{tmp_path / 'a.ecore'}:2: {message}"


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (
            classed("A", attribute("n", f'{NUMBER} upperbound="-1"')),
            "'upperbound': {}; did you mean upperBound?",
        ),
        (classed("A", "", 'eSuperType="#//A"'), "'eSuperType': {}; did you mean eSuperTypes?"),
        (
            classed("A", "<eStructuralFeature/>"),
            "'eStructuralFeature': {}; did you mean eStructuralFeatures?",
        ),
        ('<x:y xmlns:x="urn:x"/>', "'urn:x y': {}"),
    ],
)
def test_what_ecore_has_no_feature_for_is_refused_with_its_place(tmp_path, body, message):
    (tmp_path / "a.ecore").write_text(packaged(body))
    with pytest.raises(UnreadableError) as refused:
        registry_of_files([tmp_path / "a.ecore"], ())
    said = message.format("Ecore has no such feature")
    assert str(refused.value) == f"{tmp_path / 'a.ecore'}:2: {said}"


def test_elements_of_subclasses_of_ecore_have_its_features(registry_of):
    body = classed(
        "A", reference("to", f"ecore:EClass {ECORE}#//EClassifier"), f'eSuperTypes="{ECORE}#//EClass"'
    )
    registry = registry_of({"a.ecore": packaged(body)})
    thing = registry.create("urn:a", "A", name="Thing", abstract=True)
    thing.to = registry.create("urn:a", "A", name="Other")
    assert (thing.name, thing.interface, thing.to.name) == ("Thing", False, "Other")
    assert isinstance(thing, registry.metaclass(ECORE, "EModelElement").interface)
    assert not [package for package in registry.packages if package.ns_uri == ECORE]


def test_anything_is_an_object_of_ecore(core):
    assert core.metaclass(ECORE, "EObject").interface is Element


@pytest.mark.parametrize("first", ["from", "from_"])
def test_features_of_different_classes_keep_apart_where_one_inherits_both(registry_of, first):
    second = {"from": "from_", "from_": "from"}[first]
    body = (
        classed("X", attribute(first))
        + classed("Y", attribute(second))
        + classed("Z", "", 'eSuperTypes="#//X #//Y"')
        + classed("W", "", 'eSuperTypes="#//Z #//X"')
    )
    both = registry_of({"a.ecore": packaged(body)}).create("urn:a", "W")
    both.from_, both.from__ = 1, 2
    assert (both.from_, both.from__) == (1, 2)


def test_what_python_cannot_tell_apart_is_refused(registry_of):
    body = (
        classed("X", attribute("a-b"))
        + classed("Y", attribute("a_b"))
        + classed("Z", "", 'eSuperTypes="#//X #//Y"')
    )
    with pytest.raises(
        PluginError, match=r"Z inherits X\.a-b and Y\.a_b, which are both a_b in Python; rename"
    ):
        registry_of({"a.ecore": packaged(body)})


@pytest.mark.parametrize("place", ["loop.ecore", "%00.ecore", f"{'b' * 300}.ecore", "b/" * 3000 + "x.ecore"])
def test_a_place_where_nothing_can_lie_is_a_missing_metamodel(registry_of, tmp_path, place):
    (tmp_path / "loop.ecore").symlink_to("loop.ecore")
    with pytest.raises(PluginError, match="urn:a needs the metamodel"):
        registry_of({"a.ecore": packaged(classed("A", reference("r", f"ecore:EClass {place}#//B")))})


def test_an_absolute_path_is_not_opened(registry_of, tmp_path):
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "junk.xml").write_text("junk")
    kind = f"ecore:EClass {(tmp_path / 'other' / 'junk.xml').as_posix()}#//B"
    with pytest.raises(PluginError, match="needs the metamodel"):
        registry_of({"a.ecore": packaged(classed("A", reference("r", kind)))})


def test_a_link_that_leads_in_a_circle_cannot_be_read(tmp_path):
    (tmp_path / "loop.ecore").symlink_to("loop.ecore")
    with pytest.raises(UnreadableError, match=r"loop\.ecore: cannot be read: too many levels"):
        registry_of_files([tmp_path / "loop.ecore"], ())


def test_a_metamodel_that_is_too_large_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(ecore_file, "LARGEST_METAMODEL", 1024 * 1024)
    with (tmp_path / "a.ecore").open("wb") as stream:
        stream.truncate(1024 * 1024 + 1)
    with pytest.raises(UnreadableError, match=r"a\.ecore: larger than 1 MB"):
        registry_of_files([tmp_path / "a.ecore"], ())


@pytest.mark.parametrize(
    "one",
    [
        "<eOperations/>",
        "<details/>",
        "<name/>",
        "<eBounds/>",
        '<eClassifiers xsi:type="ecore:EClass" name="A%d"/>',
        '<eClassifiers xsi:type="ecore:EClass" xmi:id="_%d" name="A%d" eSuperTypes="_%d"/>',
        '<eClassifiers xsi:type="ecore:EClass" name="A%d" eSuperTypes="#//@eClassifiers.%d"/>',
        '<eClassifiers xsi:type="ecore:EClass" name="A%d" eSuperTypes="#//%%41%d"/>',
    ],
)
def test_memory_for_a_metamodel_grows_with_its_size_only(one):
    """Of what a file says many times over, hardly more is kept than the tables have to hold."""
    count = ONE_MEGABYTE // 4 // len(one)
    words = one.count("%d")
    text = packaged("".join(one % ((index,) * words) for index in range(count))).encode()
    tracemalloc.start()
    try:
        EcoreFile(text, "a.ecore")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 13 * len(text)


def test_elements_that_say_nothing_of_classes_are_not_kept():
    text = packaged("<eOperations/>" * (ONE_MEGABYTE // 16) + classed("A")).encode()
    tracemalloc.start()
    try:
        file = EcoreFile(text, "a.ecore")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert [each.get("name") for each in file.roots[0].children] == ["A"]
    assert peak < 2 * len(text)


@pytest.mark.parametrize("word", ["#//A ", "_ "])
def test_more_supertypes_than_any_class_has_are_refused(registry_of, word):
    text = packaged(classed("A", "", f'eSuperTypes="{word * (MOST_REFERENCES + 1)}"'))
    with pytest.raises(UnreadableError, match="eSuperTypes: more than 10000 references"):
        registry_of({"a.ecore": text})


@pytest.mark.parametrize("one", ["<eOperations>", "<eSubpackages>", "<name>", "<eAnnotations>"])
def test_what_nests_too_deeply_is_refused(one):
    text = packaged(one * 1000 + one.replace("<", "</") * 1000)
    with pytest.raises(MmrsError, match="nested deeper than 400 levels"):
        EcoreFile(text.encode(), "a.ecore")


def test_a_path_with_positions_is_found_among_many(registry_of):
    classes = "".join(classed(f"A{index}") for index in range(300))
    body = classes + classed("Z", "", 'eSuperTypes="#//@eClassifiers.299"')
    registry = registry_of({Path("a.ecore").name: packaged(body)})
    assert [above.name for above in registry.metaclass("urn:a", "Z").supertypes] == ["A299"]
