"""Laws of what is drawn: names survive or are replaced, never obeyed."""

import json
import re

from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from mmrs_core.cli.output import printable
from mmrs_core.pictures.preview.markup import element, number, text

ANY = st.text(st.characters(), max_size=60)
FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def readable(words):
    return FORBIDDEN.sub("\ufffd", words)


@given(ANY)
def test_any_text_stays_text(words):
    parsed = etree.fromstring(element("a", None, text(words)).encode("utf-8", "surrogatepass"))
    assert len(parsed) == 0
    assert (parsed.text or "") == readable(words).replace("\r\n", "\n").replace("\r", "\n")


@given(ANY)
def test_any_attribute_stays_one_attribute(words):
    parsed = etree.fromstring(element("a", {"b": words}).encode("utf-8", "surrogatepass"))
    assert list(parsed.attrib) == ["b"]


@given(st.floats(-1e7, 1e7))
def test_numbers_keep_two_decimals_and_no_exponent(value):
    assert abs(float(number(value)) - value) <= 0.005 + 1e-9 * abs(value)
    assert "e" not in number(value)


@given(ANY)
def test_what_is_printed_steers_no_terminal(words):
    shown = printable(words)
    assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\u2028\u2029]", shown)
    assert json.dumps(shown, ensure_ascii=False).encode("utf-8")
