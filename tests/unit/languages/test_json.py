"""Models as JSON: every value as it is in XMI, every fault with its line."""

import json
import math
from pathlib import Path

import jsonschema
import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages import json_form
from mmrs_core.languages.element import held, place_of
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.writing import to_json, to_xmi, write_model

HEAD = '"$languages": {"zoo": "urn:test:zoo", "wing": "urn:test:zoo:wing"}, "$type": "zoo:Zoo", "name": "z"'


@pytest.fixture
def read(zoo):
    """Return a function that reads a zoo with the given members."""

    def read(members: str, name: str = "zoo.json"):
        return read_text(f"{{{HEAD}, {members}}}".encode(), name, zoo)

    return read


@pytest.fixture
def lion(read):
    """Return a function that reads a lion with the given members; it must be without fault."""

    def lion(members: str):
        model = read(f'"animals": [{{"$type": "zoo:Lion", "name": "Leo", {members}}}]')
        assert model.diagnostics == ()
        return model.roots[0].animals[0]

    return lion


@pytest.fixture
def faults(read):
    """Return a function that reads members, each on a line of its own from 2 on: (code, line, message)."""

    def faults(*members: str):
        model = read("\n" + ",\n".join(members))
        return [(fault.code, fault.place.line, fault.message) for fault in model.diagnostics]

    return faults


@pytest.mark.parametrize(
    ("members", "attribute", "value"),
    [
        ('"weight": 1e-320', "weight", 1e-320),
        ('"weight": 0.1', "weight", 0.1),
        ('"weight": 90', "weight", 90.0),
        ('"weight": "Infinity"', "weight", math.inf),
        ('"weight": "1.5d"', "weight", 1.5),
        ('"teeth": 7', "teeth", 7),
        ('"teeth": "7"', "teeth", 7),
        ('"steps": "9007199254740993"', "steps", 2**53 + 1),
        ('"steps": 9007199254740993', "steps", 2**53 + 1),
        ('"tame": true', "tame", True),
        ('"tame": "true"', "tame", True),
        ('"grade": "7"', "grade", "7"),
        ('"grade": 55', "grade", "7"),
        ('"grade": "\\ud800"', "grade", "\ud800"),
        ('"mood": "is-hungry"', "mood", "HUNGRY"),
        ('"chip": "00FF"', "chip", b"\x00\xff"),
        ('"motto": null', "motto", None),
        ('"motto": ""', "motto", ""),
        ('"tags": ["a b", ""]', "tags", ["a b", ""]),
        ('"tags": "a b"', "tags", ["a b"]),
        ('"weights": [1, 1.5]', "weights", [1.0, 1.5]),
    ],
)
def test_a_value_is_read_by_its_type(lion, members, attribute, value):
    assert getattr(lion(members), attribute) == value


def test_minus_zero_keeps_its_sign(lion, zoo):
    read = lion('"weight": -0.0')
    assert math.copysign(1, read.weight) == -1
    assert b'"weight": -0.0' in to_json([read.zoo], zoo)


@pytest.mark.parametrize(
    ("attribute", "value", "text"),
    [
        ("weight", 1e22, '"weight": 1e+22'),
        ("weight", math.nan, '"weight": "NaN"'),
        ("steps", 2**53 + 1, '"steps": "9007199254740993"'),
        ("steps", 2**53 - 1, '"steps": 9007199254740991'),
        ("grade", "7", '"grade": "7"'),
        ("grade", "\ud800", '"grade": "\\ud800"'),
        ("hungry", "CALM", '"hungry": "is-calm"'),
        ("tags", ["ü", '"'], '"tags": ["ü", "\\""]'),
    ],
)
def test_a_value_is_written_so_that_readers_of_json_keep_it(zoo, attribute, value, text):
    element = zoo.create("urn:test:zoo", "Lion", name="Leo", **{attribute: value})
    written = to_json([element], zoo)
    assert text in written.decode()
    json.loads(written)


@pytest.mark.parametrize("attribute", ["age", "teeth", "hungry", "motto", "tags", "star"])
def test_what_is_not_set_is_not_written(zoo, attribute):
    assert f'"{attribute}"'.encode() not in to_json([zoo.create("urn:test:zoo", "Lion", name="x")], zoo)


def test_unset_and_set_to_the_default_stay_apart(lion, zoo):
    assert b'"age": 0' in to_json([lion('"age": 0').zoo], zoo)
    assert b'"age"' not in to_json([lion('"tame": true').zoo], zoo)


def test_an_element_of_the_feature_s_own_class_does_not_say_its_class(read, zoo):
    model = read('"keepers": [{"badge": "k1"}]')
    assert b'{"badge": "k1"}' in to_json(model.roots, zoo)


def test_references_are_paths_ids_or_hrefs(read):
    zoo = read(
        '"star": "//@animals.1", "favourites": ["leo", {"$ref": "#//@animals.1"}],'
        ' "animals": [{"$type": "zoo:Lion", "$id": "leo", "name": "a"}, {"$type": "zoo:Otter", "name": "b"}]'
    ).roots[0]
    assert zoo.star is zoo.animals[1]
    assert zoo.favourites == [zoo.animals[0], zoo.animals[1]]


def test_elements_of_other_files_are_contained_by_reference(zoo, tmp_path):
    (tmp_path / "leo.json").write_text('{"$type": "urn:test:zoo#Lion", "name": "Leo"}')
    text = f'{{{HEAD}, "animals": [{{"$ref": "leo.json#/"}}], "star": "leo.json#/"}}'
    (tmp_path / "zoo.json").write_text(text)
    model = read_model(tmp_path / "zoo.json", zoo)
    assert model.diagnostics == ()
    assert model.roots[0].star.name == "Leo"
    xmi = to_xmi(model.roots, zoo, file=tmp_path / "zoo.xmi")
    assert xmi.count(b'href="leo.json#/"') == 2
    (tmp_path / "zoo.xmi").write_bytes(xmi)
    again = read_model(tmp_path / "zoo.xmi", zoo)
    assert to_json(again.roots, zoo, file=tmp_path / "x.json").count(b'"leo.json#/"') == 2


def test_several_roots_stand_in_a_list(zoo):
    roots = [zoo.create("urn:test:zoo", "Lion", name=name) for name in ("a", "b")]
    roots[0].mate = roots[1]
    text = to_json(roots, zoo)
    assert json.loads(text)["$roots"][0]["mate"] == "/1"
    assert to_json(read_text(text, "a.json", zoo).roots, zoo) == text


def test_a_model_without_roots_is_written_and_read(zoo):
    text = to_json([], zoo)
    model = read_text(text, "a.json", zoo)
    assert (model.roots, model.diagnostics) == ((), ())


def test_a_feature_that_begins_with_a_dollar_gets_a_second_one(tmp_path):
    from mmrs_core.languages.registry import MetamodelSource, registry_with

    ecore = tmp_path / "d.ecore"
    ecore.write_text(
        '<ecore:EPackage xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="d" nsURI="urn:d"'
        ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">'
        '<eClassifiers xsi:type="ecore:EClass" name="D">'
        '<eStructuralFeatures xsi:type="ecore:EAttribute" name="$type"'
        ' eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EString"/>'
        "</eClassifiers></ecore:EPackage>"
    )
    registry = registry_with([MetamodelSource("urn:d", ecore)])
    text = to_json(read_text(b'{"$type": "urn:d#D", "$$type": "x"}', "a.json", registry).roots, registry)
    assert json.loads(text) == {"$languages": {"d": "urn:d"}, "$type": "d:D", "$$type": "x"}


def test_elements_know_file_and_line(read):
    model = read('"animals": [\n {"$type": "zoo:Lion", "name": "Leo"},\n\n {"$type": "zoo:Lion"}]')
    assert [str(place_of(animal)) for animal in model.roots[0].animals] == ["zoo.json:2", "zoo.json:4"]


@pytest.mark.parametrize(
    ("member", "code", "message"),
    [
        ('"nam": "x"', "XMI004", "nam: no feature of Zoo 'z'"),
        ('"$href": "x"', "XMI004", "$href: no key of this form, and no feature of Zoo"),
        ('"name2": "x"', "XMI004", "name2: no feature of Zoo 'z'"),
        ('"star": "//@animals.7"', "XMI006", "star: '//@animals.7' leads to no element"),
        ('"star": 3', "XMI010", "star: takes the names or paths of elements, such as //@tasks.0"),
        ('"star": ["/", "/"]', "XMI009", "star: a list of 2, takes one"),
        ('"animals": "x"', "XMI010", "animals: takes objects"),
        ('"animals": [{"name": "x"}]', "XMI003", "Animal: abstract; state a concrete subclass by $type"),
        ('"animals": [{"$type": "zoo:Lio"}]', "XMI002", "Lio: no class of urn:test:zoo"),
        ('"animals": [{"$type": "zo:Lion"}]', "XMI014", "zo:Lion: the prefix 'zo' is not declared"),
        (
            '"animals": [{"$type": 3}]',
            "XMI010",
            "$type: the name of a class, such as mission:Mission, is needed",
        ),
        ('"animals": [{"$type": "zoo:Keeper"}]', "XMI008", "Keeper: not a Animal, which animals takes"),
        ('"keepers": [{"$id": 3}]', "XMI010", "$id: takes a text"),
        (
            '"anything": {"$ref": "x.json#/"}',
            "XMI007",
            "anything: x.json: a text that is not a file cannot refer to files",
        ),
    ],
)
def test_a_fault_is_told_with_its_line(faults, member, code, message):
    assert faults('"notes": []', member) == [(code, 3, message)]


@pytest.mark.parametrize(
    ("member", "message"),
    [
        ('"teeth": 1.5', "teeth: '1.5': not a whole number"),
        ('"teeth": true', "teeth: true: not of the type EInt"),
        ('"teeth": 3000000000', "teeth: '3000000000': does not fit into 32 bits"),
        ('"teeth": null', "teeth: cannot be null"),
        ('"teeth": {}', "teeth: an object: not a value of the type EInt"),
        ('"teeth": [1, 2]', "teeth: a list of 2 values, takes one"),
        ('"tame": 1', "tame: '1': a number, not of the type EBoolean; write it in quotes"),
        ('"motto": 1', "motto: '1': a number, not of the type EString; write it in quotes"),
        ('"mood": "CALMER"', "mood: 'CALMER': not a literal of Mood (is-calm, is-hungry, ANGRY)"),
        ('"tags": [["a"]]', "tags: a list: not a value of the type EString"),
        ('"born": "soon"', "born: 'soon': not a date such as 2024-05-01T10:11:12.123+0200"),
    ],
)
def test_a_value_that_its_type_does_not_allow_is_a_fault_on_its_own_line(faults, member, message):
    (found,) = faults('"animals": [{"$type": "zoo:Lion", "name": "Leo"', f"{member}}}]")
    assert found[1:] == (3, message)


def test_an_id_used_twice_is_a_fault(faults):
    (found,) = faults('"keepers": [{"$id": "a"},\n{"$id": "a"}]')
    assert found == ("XMI012", 3, "a: an id used twice; first on line 2")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"", "a.json:1: not well-formed JSON: expecting value"),
        (b'{"a": 1,\n}', "a.json:2: not well-formed JSON: expecting property name"),
        (b'{"a": 1,\n"b": {"a": 1},\n"a": 2}', "a.json:3: 'a': given twice in one object"),
        (b'{"a": "NaN",\n"b": -Infinity}', "a.json:2: not well-formed JSON: -Infinity is not a number"),
        (b'{"a": NaN}', 'a.json:1: not well-formed JSON: NaN is not a number; write "NaN"'),
        (b"\xff\x00x", "a.json:1: not readable as UTF-8 text"),
        (b'{"a":\n' * 2000, "a.json:801: nested deeper than 800 levels"),
        (b"[" * 900 + b"]" * 900, "a.json:1: nested deeper than 800 levels"),
    ],
)
def test_what_is_no_json_is_unreadable_with_its_line(zoo, text, message):
    with pytest.raises(UnreadableError) as caught:
        read_text(text, "a.json", zoo)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    "text", [b"[]", b"{}", b"3", b'{"eClass": "Mission"}', b'{"$roots": 3}', b'{"$roots": [3]}']
)
def test_json_that_is_no_model_says_what_is_missing(zoo, text):
    (fault,) = read_text(text, "a.json", zoo).diagnostics
    assert fault.code in ("XMI015", "XMI010")


def test_members_beside_several_roots_are_not_lost_silently(zoo):
    (fault,) = read_text(b'{"$roots": [],\n "name": "x"}', "a.json", zoo).diagnostics
    assert (fault.code, fault.place.line) == ("XMI004", 2)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-32"])
def test_other_encodings_of_unicode_are_read(zoo, encoding):
    text = '{"$type": "urn:test:zoo#Zoo", "name": "ü"}'.encode(encoding)
    assert read_text(text, "a.json", zoo).roots[0].name == "ü"


def test_a_file_is_written_by_its_ending(zoo, tmp_path):
    root = zoo.create("urn:test:zoo", "Zoo", name="z")
    write_model([root], tmp_path / "zoo.json", zoo)
    write_model([root], tmp_path / "zoo.xmi", zoo)
    assert (tmp_path / "zoo.json").read_bytes() == to_json([root], zoo)
    assert (tmp_path / "zoo.xmi").read_bytes() == to_xmi([root], zoo)


def test_a_value_of_the_wrong_type_is_refused_with_its_place(zoo):
    root = zoo.create("urn:test:zoo", "Lion", name="x")
    root.teeth = "many"
    with pytest.raises(ValueError, match="/: teeth: 'many' is not of the type EInt"):
        to_json([root], zoo)


def test_a_reference_to_an_element_that_stands_in_no_file_is_refused(zoo):
    root = zoo.create("urn:test:zoo", "Zoo", star=zoo.create("urn:test:zoo", "Lion", name="x"))
    with pytest.raises(ValueError, match=r"^/: star: refers to .*, which stands in no file"):
        to_json([root], zoo)


def test_where_metamodels_lie_is_written_for_the_languages_used(zoo):
    places = {"urn:test:zoo": "zoo.ecore", "urn:other": "other.ecore"}
    text = to_json([zoo.create("urn:test:zoo", "Zoo")], zoo, schema_location=places)
    assert json.loads(text)["$schemaLocation"] == {"urn:test:zoo": "zoo.ecore"}
    assert read_text(text, "a.json", zoo).diagnostics == ()


def test_a_deep_model_is_written_and_read(zoo):
    root = inner = zoo.create("urn:test:zoo", "Otter", name="0")
    for index in range(300):
        inner.cubs = [zoo.create("urn:test:zoo", "Otter", name=str(index))]
        inner = held(inner, inner._mmrs_metaclass.by_name["cubs"])[0]
    text = to_json([root], zoo)
    assert to_json(read_text(text, "a.json", zoo).roots, zoo) == text


SCHEMA = json.loads((Path(json_form.__file__).parent / "model.schema.json").read_text(encoding="utf-8"))
EXAMPLES = sorted((Path(__file__).parents[3] / "examples").rglob("*.xmi"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: "/".join(path.parts[-3:]))
def test_every_example_as_json_is_valid_by_the_schema(everything, example):
    text = to_json(read_model(example, everything).roots, everything, file=example)
    jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(text))


def test_several_roots_and_unknown_elements_are_valid_by_the_schema(core, zoo):
    roots = [zoo.create("urn:test:zoo", "Lion", name="a"), zoo.create("urn:test:zoo", "Zoo", name="b")]
    unknown = read_text(to_xmi(roots[:1], zoo), "a.xmi", core).roots
    for text in (to_json(roots, zoo), to_json(unknown, core), to_json([], zoo)):
        jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(text))


@pytest.mark.parametrize(
    "text", ['{"a": 1}', '{"$type": "Lion"}', '{"$type": "z:L", "a": {"$ref": "x", "b": 1}}', "[]"]
)
def test_what_is_no_model_is_invalid_by_the_schema(text):
    assert not jsonschema.Draft202012Validator(SCHEMA).is_valid(json.loads(text))


def test_what_is_nearly_nothing_but_brackets_is_refused(zoo):
    with pytest.raises(
        UnreadableError, match=r"^a\.json: 20001 objects and lists with next to nothing in them"
    ):
        read_text(b"[" + b"{}," * 19_999 + b"{}]", "a.json", zoo)
