"""Models survive the way to JSON and back with every bit."""

from counts import many
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_json, to_xmi
from mmrs_core.testing.instances import instances_of

LANGUAGES = (
    "urn:mmrs:mission:1.0",
    "urn:mmrs:context:1.0",
    "urn:mmrs:robot:1.0",
    "urn:mmrs:behaviour:1.0",
    "urn:test:zoo",
)
RELAXED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


@RELAXED
@given(data=st.data())
def test_json_says_what_xmi_says(registry, data):
    root = data.draw(st.sampled_from(LANGUAGES).flatmap(lambda ns_uri: instances_of(registry, ns_uri)))
    before = to_xmi([root], registry)
    read = read_text(before, "a.xmi", registry)
    text = to_json(read.roots, registry)
    back = read_text(text, "b.json", registry)
    assert back.diagnostics == ()
    assert to_xmi(back.roots, registry) == before
    assert to_json(back.roots, registry) == text


SAMPLE = b"""{
  "$languages": {"zoo": "urn:test:zoo", "far": "urn:test:far"},
  "$type": "zoo:Zoo", "name": "z", "star": "//@animals.0",
  "animals": [
    {"$type": "zoo:Lion", "$id": "leo", "name": "Leo", "tags": ["a", "b"], "teeth": 3, "tame": true},
    {"$type": "zoo:Otter", "name": "Ot", "depth": null, "cubs": [{"$type": "far:Alien", "x": [1, {}]}]},
    {"$type": "far:Thing", "$xml": "<animals/>", "$namespaces": {}}
  ]
}
"""
PIECES = st.sampled_from(
    [
        b"",
        b"{",
        b"}",
        b"[",
        b"]",
        b",",
        b":",
        b'"',
        b"\\",
        b"null",
        b"1e999",
        b"-0.0",
        b"NaN",
        b"\xff",
        b"\x00",
        b'"$type"',
        b'"$ref"',
        b'{"$ref": "x.json#/"}',
        b'"$roots": []',
        b"9" * 500,
        b"[" * 30,
        b'"\\ud800"',
    ]
)


@settings(RELAXED, max_examples=many(5000))
@given(data=st.data())
def test_a_damaged_file_never_breaks_us(registry, data):
    text = bytearray(SAMPLE)
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        text[start : start + data.draw(st.integers(0, 12))] = data.draw(PIECES)
    try:
        model = read_text(bytes(text), "damaged.json", registry)
    except UnreadableError:
        return
    assert all(fault.place.line > 0 for fault in model.diagnostics)
    assert to_json(model.roots, registry)
