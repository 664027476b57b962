"""Texts of any kind as values of any type."""

from datetime import datetime, timedelta, timezone

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.languages.datatypes import ECORE, ECORE_CLASSES, XML_CLASSES, XML_TYPES, builtin_type
from mmrs_core.languages.values.dates import parse_date, render_date

XML_TEXTS = ("QName", "Token", "NMTOKENS", "AnyURI")
TYPES = [builtin_type(ECORE, name) for name in ECORE_CLASSES]
TYPES += [builtin_type(XML_TYPES, name) for name in (*XML_CLASSES, *XML_TEXTS)]
NUMBERS = st.from_regex(
    r"\s?[+-]?(0x)?[0-9a-f٣]{0,30}\.?[0-9]{0,5}([eEpP][+-]?[0-9]{1,25})?[fFdD\s]?", fullmatch=True
)
DATES = st.from_regex(
    r"[ \t]?\d{1,10}-\d{1,9}-\d{1,9}"
    r"(T\d{1,9}:\d{1,9}(:\d{1,9}(\.\d{1,12}([ ]?[+-]\d\d:?\d\d|Z|GMT|UTC)?)?)?)?.?",
    fullmatch=True,
)
TEXTS = st.one_of(
    NUMBERS, DATES, st.text(max_size=20), st.sampled_from(["NaN", "INF", "-Infinity", "TRUE", "P1D"])
)


@pytest.mark.parametrize("count", [pytest.param(400), pytest.param(20_000, marks=pytest.mark.thorough)])
def test_a_text_is_refused_in_words_or_comes_back_as_the_same_value(count):
    @settings(max_examples=count, deadline=None, suppress_health_check=[*HealthCheck])
    @given(kind=st.sampled_from(TYPES), text=TEXTS)
    def check(kind, text):
        try:
            value = kind.parse(text)
        except ValueError:
            return
        assert kind.accepts(value)
        again = kind.parse(kind.render(value))
        assert again == value or (again != again and value != value)
        assert kind.render(again) == kind.render(value)
        assert kind.doubt is None or isinstance(kind.doubt(value), str)

    check()


ZONES = st.integers(-86_399, 86_399).map(lambda seconds: timezone(timedelta(seconds=seconds)))


@given(date=st.datetimes(datetime(1582, 10, 16), datetime(9999, 12, 29), timezones=ZONES))
def test_any_date_of_whole_milliseconds_comes_back_from_its_text(date):
    date = date.replace(microsecond=date.microsecond // 1000 * 1000)
    assert parse_date(render_date(date)) == date


@given(text=DATES)
def test_a_date_keeps_its_text_whatever_it_is(text):
    try:
        value = parse_date(text)
    except ValueError:
        return
    assert render_date(value) == text
