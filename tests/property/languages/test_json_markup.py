"""Laws of places in JSON texts: what stands there is what the text says there."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.json_form.markup import JsonMarkup, JsonTag, Member, inserted, taken_away

NAMES = st.text(st.characters(exclude_categories=["Cs"]), max_size=6).filter(lambda name: name[:1] != "$")
PLAIN = st.one_of(st.booleans(), st.integers(), st.floats(allow_nan=False, allow_infinity=False), NAMES)
OBJECTS = st.recursive(
    st.dictionaries(NAMES, PLAIN, max_size=4),
    lambda inner: st.dictionaries(
        NAMES, st.one_of(PLAIN, inner, st.lists(inner, max_size=3), st.lists(PLAIN, max_size=3)), max_size=4
    ),
    max_leaves=12,
)
LAYOUTS = st.sampled_from([{}, {"indent": 2}, {"separators": (",", ":")}, {"ensure_ascii": False}])


def text_of(value, layout):
    return json.dumps(value, **layout).encode()


def things(markup):
    return [each for each in markup.root.everything() if isinstance(each, JsonTag)]


@given(OBJECTS, LAYOUTS)
def test_every_object_and_value_stands_where_it_is_said_to(value, layout):
    data = text_of(value, layout)
    for thing in things(JsonMarkup(data, "m.json")):
        said = json.loads(data[thing.begin : thing.end])
        members = said.items() if isinstance(said, dict) else ()
        plain = {key for key, inner in members if not isinstance(inner, dict | list)}
        assert {member.name for member in thing.attributes} == plain
        for member in thing.attributes:
            assert isinstance(member, Member)
            assert json.loads(b'"' + data[member.begin : member.end] + b'"') == member.name
            found = json.loads(data[member.value_begin : member.value_end])
            assert found == said[member.name]
            assert member.bare == (not isinstance(found, str))


@given(OBJECTS, LAYOUTS)
def test_lines_are_those_of_the_text(value, layout):
    data = text_of(value, layout)
    for thing in things(JsonMarkup(data, "m.json")):
        assert thing.line == data.count(b"\n", 0, thing.begin) + 1
        assert thing.lines[2] == data.count(b"\n", 0, thing.end - 1) + 1


@given(OBJECTS, LAYOUTS, st.data())
def test_what_is_taken_away_is_all_that_goes(value, layout, draw):
    data = text_of(value, layout)
    inner = things(JsonMarkup(data, "m.json"))[1:]
    if inner:
        begin, end = taken_away(draw.draw(st.sampled_from(inner)))
        rest = json.loads(data[:begin] + data[end:])
        assert _size(rest) < _size(value)


@given(OBJECTS, LAYOUTS, st.sampled_from(["new", "xsi:type", "xmlns:p"]), NAMES | st.just("0.5"))
def test_what_is_put_in_is_all_that_comes(value, layout, name, text):
    value.pop("new", None)
    data = text_of(value, layout)
    root = JsonMarkup(data, "m.json").root
    assert isinstance(root, JsonTag)
    begin, words = inserted(root, name, text, data)
    after = json.loads(data[:begin] + words.encode() + data[begin:])
    (found,) = [after.pop(key) for key in ("new", "$type", "$languages") if key in after]
    if name == "xmlns:p":
        assert found == {"p": text}
    else:
        assert found == text or (name == "new" and found == json.loads(text))
    assert after == value


@pytest.mark.parametrize("data", [b"", b"[]", b"{", b"3", b'"a"', '{"a": 1}'.encode("utf-16")])
def test_what_is_no_object_in_utf_8_is_refused(data):
    with pytest.raises(UnreadableError):
        JsonMarkup(data, "m.json")


def test_several_roots_are_told_apart():
    markup = JsonMarkup(b'{"$roots": [{"$type": "m:A"},\n {"$type": "m:B", "xs": [1, 2]}]}', "m.json")
    assert [root.attribute("xsi:type").value for root in markup.models()] == ["m:A", "m:B"]
    assert markup.at("/", 2) is markup.models()[1]
    assert [markup.data[x.inside : x.closing] for x in markup.models()[1].named("xs")] == [b"1", b"2"]


def _size(value):
    if isinstance(value, dict):
        return 1 + sum(map(_size, value.values()))
    return 1 + sum(map(_size, value)) if isinstance(value, list) else 1
