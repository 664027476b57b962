"""Laws of what is drawn: names survive or are replaced, never obeyed."""

import json
import re

from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from mmrs_core.cli.output import printable
from mmrs_core.pictures.documents import number, render

ANY = st.text(st.characters(), max_size=60)
FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def readable(words):
    return FORBIDDEN.sub("\ufffd", words)


def chart_of(words):
    """Return a small picture with words as a name, in an attribute and in text."""
    values = dict.fromkeys(("width", "height", "left", "right", "top", "bottom"), 1.0)
    drawn = render("chart.svg", name=words, colour="ink", ticks=(), levels=(), limit=None, lines=(), **values)
    return etree.fromstring(drawn.encode("utf-8", "surrogatepass"))


@given(ANY)
def test_any_text_stays_text(words):
    title = chart_of(words)[0]
    assert len(title) == 0
    assert (title.text or "") == readable(words).replace("\r\n", "\n").replace("\r", "\n")


@given(ANY)
def test_any_attribute_stays_one_attribute(words):
    assert {*chart_of(words).attrib} == {*chart_of("").attrib}


@given(st.floats(-1e7, 1e7))
def test_numbers_keep_two_decimals_and_no_exponent(value):
    assert abs(float(number(value)) - value) <= 0.005 + 1e-9 * abs(value)
    assert "e" not in number(value)


@given(ANY)
def test_what_is_printed_steers_no_terminal(words):
    shown = printable(words)
    assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\u2028\u2029]", shown)
    assert json.dumps(shown, ensure_ascii=False).encode("utf-8")
