from pathlib import Path

from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.reading import read_text

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").rglob("*.xmi"))
PIECES = st.sampled_from(
    [
        b"",
        b"<",
        b">",
        b'"',
        b"/",
        b"&",
        b"&lt;",
        b"<!-- -->",
        b"<!DOCTYPE x>",
        b"<![CDATA[x]]>",
        b"\x00",
        b"\xff",
        b"//@tasks.0",
        b"#",
        b"%2e%2e/",
        b'xsi:nil="true"',
        b'xsi:type="mission:Fork"',
        b'href="x.xmi#/"',
        b'xmi:id="a"',
        b"<tasks/>",
        b"</tasks>",
        b"NaN",
        b"-1",
        b"9" * 400,
    ]
)


def outcome(text, registry):
    """Return the model and no refusal, or no model and what the refusal says."""
    try:
        return read_text(text, "damaged.xmi", registry), ""
    except UnreadableError as refusal:
        return None, str(refusal)


@settings(max_examples=many(5000))
@given(data=st.data())
def test_a_damaged_model_is_unreadable_or_has_faults_but_never_breaks_us(registry, data):
    text = bytearray(data.draw(st.sampled_from(EXAMPLES)).read_bytes()[:4000])
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        text[start : start + data.draw(st.integers(0, 12))] = data.draw(PIECES)
    model, refusal = outcome(bytes(text), registry)
    assert refusal.startswith("damaged.xmi") == (model is None)
    for fault in (*model.diagnostics, *check_conformance(model, registry)) if model else ():
        assert fault.place.file == "damaged.xmi"
        assert fault.place.line > 0


@settings(max_examples=many(1000))
@given(st.binary(max_size=200))
def test_random_bytes_are_unreadable(registry, data):
    model, refusal = outcome(data, registry)
    assert refusal or model.diagnostics


@settings(max_examples=many(1500))
@given(data=st.data())
def test_swapped_words_are_faults_with_a_place(registry, data):
    example = data.draw(st.sampled_from(EXAMPLES))
    words = example.read_text().split('"')
    one, other = data.draw(st.integers(6, len(words) - 2)), data.draw(st.integers(6, len(words) - 2))
    words[one], words[other] = words[other], words[one]
    model, _ = outcome('"'.join(words).encode(), registry)
    for fault in (*model.diagnostics, *check_conformance(model, registry)) if model else ():
        assert fault.place.line > 0
