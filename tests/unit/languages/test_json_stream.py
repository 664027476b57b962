"""JSON is read member by member: in whatever order they come, and in little memory."""

import json
import tracemalloc

import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.comparison.changes import changes_between
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.schema_location import first_kind, stated_places
from mmrs_core.languages.writing import to_json

HEAD = '"$languages": {"zoo": "urn:test:zoo", "far": "urn:test:far"}, "$type": "zoo:Zoo", "name": "z"'
MODEL = {
    "$languages": {"zoo": "urn:test:zoo"},
    "$type": "zoo:Zoo",
    "name": "z",
    "star": "leo",
    "animals": [
        {"$type": "zoo:Lion", "$id": "leo", "name": "Leo", "cubs": [{"$type": "zoo:Otter", "name": "Ot"}]},
        {"$type": "zoo:Otter", "name": "Ottilie"},
    ],
    "keepers": [{"badge": "k1"}],
}
A_MEGABYTE = 1_000_000
BEHAVIOUR = "urn:mmrs:behaviour:1.0"


def backwards(value: object) -> object:
    """Return JSON with the members of every object in reverse order."""
    if isinstance(value, dict):
        return {key: backwards(value[key]) for key in reversed(value)}
    return [backwards(each) for each in value] if isinstance(value, list) else value


@pytest.mark.parametrize(
    "text",
    [
        json.dumps(backwards(MODEL)),
        json.dumps(MODEL, sort_keys=True),
        json.dumps(backwards(MODEL), indent=2),
        json.dumps(MODEL).replace("$type", "\\u0024type"),
        json.dumps(MODEL).replace('"$languages"', '"$l\\u0061nguages"'),
    ],
)
def test_members_may_come_in_any_order_and_spelling(zoo, text):
    expected = read_text(json.dumps(MODEL).encode(), "a.json", zoo)
    found = read_text(text.encode(), "a.json", zoo)
    assert found.diagnostics == expected.diagnostics == ()
    assert changes_between(expected.roots, found.roots) == ()


def test_several_roots_may_stand_before_their_languages(zoo):
    text = b'{"$roots": [{"name": "a", "$type": "z:Lion"}], "$languages": {"z": "urn:test:zoo"}}'
    model = read_text(text, "a.json", zoo)
    assert (model.diagnostics, [root.name for root in model.roots]) == ((), ["a"])


def test_a_late_type_that_is_wrong_is_a_fault_on_its_line(zoo):
    text = f'{{{HEAD}, "animals": [{{"name": "x",\n"$type": "zoo:Lio"}}]}}'
    (fault,) = read_text(text.encode(), "a.json", zoo).diagnostics
    assert (fault.code, fault.place.line) == ("XMI002", 2)


def test_of_several_elements_where_one_is_taken_the_first_is(zoo):
    one = '{"$type": "zoo:Lion", "name": "a"}'
    model = read_text(f'{{{HEAD}, "guest": [{one}, {one}, 3]}}'.encode(), "a.json", zoo)
    assert [fault.message for fault in model.diagnostics] == [
        "guest: takes objects",
        "guest: a list of 3, takes one",
    ]
    assert model.roots[0].guest.name == "a"


def test_an_object_of_an_unknown_class_is_kept_with_all_that_it_says(zoo):
    alien = '{"$type": "far:Alien", "tame": true, "x": [1.50, null, {"$type": "zoo:Lion", "é": "\\ud800"}]}'
    model = read_text(f'{{{HEAD}, "animals": [{alien}]}}'.encode(), "a.json", zoo)
    assert json.loads(to_json(model.roots, zoo))["animals"] == [json.loads(alien)]
    assert b"1.50" in to_json(model.roots, zoo)


def test_an_object_of_an_unknown_class_is_kept_where_another_became_known(zoo):
    members = '"animals": [{"$type": "zoo:Lion", "$xml": "<a name=\'b\'/>"}, {"$type": "far:X", "y": true}]'
    model = read_text(f"{{{HEAD}, {members}}}".encode(), "a.json", zoo)
    assert json.loads(to_json(model.roots, zoo))["animals"] == [
        {"$type": "zoo:Lion", "name": "b"},
        {"$type": "far:X", "y": True},
    ]


def test_many_references_in_one_list_lead_where_they_did(zoo):
    animals = ", ".join(f'{{"$type": "zoo:Lion", "name": "{index}"}}' for index in range(1200))
    links = ", ".join(f'"//@animals.{index}"' for index in reversed(range(1200)))
    model = read_text(f'{{{HEAD}, "animals": [{animals}], "favourites": [{links}]}}'.encode(), "a.json", zoo)
    assert model.diagnostics == ()
    assert model.roots[0].favourites == model.roots[0].animals[::-1]


def test_a_reference_is_not_taken_for_the_type_of_the_next(zoo):
    model = read_text(f'{{{HEAD}, "favourites": ["a:b", "#c", "/", "d:e"]}}'.encode(), "a.json", zoo)
    told = [fault.message for fault in model.diagnostics]
    assert [word in message for word, message in zip(("'a:b'", "'#c'", "Zoo", "'d:e'"), told, strict=True)]
    assert len(told) == 4


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        (f"{{{HEAD}}}", ("urn:test:zoo", "Zoo")),
        ('{"name": "z", "$type": "a:B", "$languages": {"a": "urn:a"}}', ("urn:a", "B")),
        ('{"$roots": [3, {"x": 1, "$type": "urn:a#C"}, {"$type": "urn:a#D"}]}', ("urn:a", "C")),
        ('{"name": "z"}', ("", "")),
        ("[]", ("", "")),
    ],
)
def test_the_first_class_is_found_wherever_it_stands(tmp_path, text, kind):
    (tmp_path / "a.json").write_text(text)
    assert first_kind(tmp_path / "a.json") == kind


def test_places_of_metamodels_are_found_at_the_end(tmp_path):
    text = f'{{{HEAD}, "animals": [{{"$schemaLocation": {{"x": "y"}}}}], "$schemaLocation": {{"a": "b"}}}}'
    (tmp_path / "a.json").write_text(text)
    assert stated_places(tmp_path / "a.json") == {"a": "b"}


def test_an_object_with_more_members_than_any_class_has_is_refused(zoo):
    members = ", ".join(f'"k{index}": 1' for index in range(10_002))
    with pytest.raises(UnreadableError, match=r"^a\.json:1: more than 10000 members in one object"):
        read_text(f'{{"$type": "urn:test:far#X", {members}}}'.encode(), "a.json", zoo)


def test_a_prefix_for_an_endless_uri_is_a_fault(zoo):
    uri = "u" * 2001
    text = f'{{"$languages": {{"far": "{uri}"}}, "$type": "urn:test:zoo#Zoo"}}'
    (fault,) = read_text(text.encode(), "a.json", zoo).diagnostics
    assert fault.message == "$languages: the nsURI of far is longer than 2000 characters"


def repeated(text: str) -> str:
    return ",".join([text] * (A_MEGABYTE // (len(text) + 1) + 1))


def numbered(text: str, size: int) -> str:
    return ",".join(text % number for number in range(A_MEGABYTE // size))


def in_zoo(feature: str, values: str) -> str:
    return f'{{{HEAD}, "{feature}": [{values}]}}'


def in_lion(feature: str, values: str) -> str:
    return in_zoo("animals", f'{{"$type": "zoo:Lion", "{feature}": {values}}}')


ALIEN = '{"$type": "far:X", "x": [1, {"y": "z"}], "long": "' + "z" * 99 + '"}'
HOSTILE = {
    "small elements": in_zoo("keepers", numbered('{"badge": "%d"}', 20)),
    "late types": in_zoo("animals", numbered('{"name": "%d", "$type": "zoo:Lion"}', 40)),
    "objects in an unknown object": '{"$type": "urn:far#X", "a": [' + repeated('{"x": 123}') + "]}",
    "objects in an unknown member": in_zoo("x", repeated('{"x": 123}')),
    "unknown elements": in_zoo("animals", repeated(ALIEN)),
    "a long text": in_zoo("notes", '"' + "x" * A_MEGABYTE + '"'),
    "a long number": in_lion("weight", "9" * A_MEGABYTE),
    "many numbers": in_lion("weights", "[" + numbered("%d.5", 8) + "]"),
    "many texts": in_lion("tags", "[" + numbered('"%d"', 8) + "]"),
    "many references": in_zoo("favourites", numbered('"//@animals.%d"', 18)),
    "lists in lists": in_zoo("animals", repeated("[1, 2, 3, [4, 5, 6]]")),
    "faults far from their key": in_zoo("keepers", repeated('{"badge": "' + "x" * 99 + '"},\n3')),
}
QUICK = ("unknown elements", "a long text", "a long number", "many references", "faults far from their key")


def bytes_taken(text: str, registry) -> float:
    """Return the most memory that reading a text takes at any time, for each byte of it."""
    data = text.encode()
    tracemalloc.start()
    try:
        read_text(data, "a.json", registry)
    except UnreadableError:  # too many faults, which are found without more memory than anything else
        pass
    finally:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    return peak / len(data)


def test_a_usual_model_is_read_in_little_memory(core):
    moves = [
        core.create(BEHAVIOUR, "GoTo", name=f"m{number}", task="survey", rule="cover", speed=number / 8)
        for number in range(10_000)
    ]
    robot = core.create(BEHAVIOUR, "Robot", id="r", moves=moves)
    text = to_json([core.create(BEHAVIOUR, "Behaviour", name="b", robots=[robot])], core)
    assert len(text) > 900_000
    assert bytes_taken(text.decode(), core) < 5


@pytest.mark.timeout(60)
@pytest.mark.parametrize("kind", QUICK)
def test_no_file_takes_many_times_its_size_in_memory(zoo, kind):
    assert bytes_taken(HOSTILE[kind], zoo) < 11


@pytest.mark.thorough
@pytest.mark.timeout(60)
@pytest.mark.parametrize("kind", sorted({*HOSTILE} - {*QUICK}))
def test_no_odd_file_takes_many_times_its_size_in_memory(zoo, kind):
    assert bytes_taken(HOSTILE[kind], zoo) < 11
