import copy
import pickle
from datetime import UTC, datetime, timedelta, timezone

import pytest

from mmrs_core.languages.values.dates import WrittenDate, doubt_of_date, parse_date, render_date


def test_a_date_that_emf_wrote_is_a_plain_one():
    assert type(parse_date("2024-05-01T10:11:12.123+0200")) is datetime


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2024-05-01", datetime(2024, 5, 1)),
        ("2024-05-01T10:11:12", datetime(2024, 5, 1, 10, 11, 12)),
        ("2024-05-01T10:11:12.5+0000", datetime(2024, 5, 1, 10, 11, 12, 5000)),
        ("2024-05-01T10:11:12.123456+0000", datetime(2024, 5, 1, 10, 13, 15, 456000)),
        ("2024-05-01T10:11:12.123+02:00", datetime(2024, 5, 1, 10, 11, 12, 123000)),
        ("2024-05-01T10:11:12+0200", datetime(2024, 5, 1, 10, 11, 12)),
        ("2024-13-45", datetime(2025, 2, 14)),
        ("1582-10-15T00:00:00.000+0000", datetime(1582, 10, 15)),
        ("1582-10-14T24:00:00.000+0000", datetime(1582, 10, 15)),
    ],
)
def test_a_date_is_what_emf_takes_it_for(text, value):
    assert parse_date(text) == value.replace(tzinfo=UTC)


@pytest.mark.parametrize(
    "text", ["2024-05-01", "2024-05-01T10:11:12.5+0200", " 2024-13-45", "2024-05-01T1:2Z"]
)
@pytest.mark.parametrize(
    "same", [lambda date: date, copy.copy, copy.deepcopy, lambda d: pickle.loads(pickle.dumps(d))]
)
def test_a_date_keeps_the_text_of_its_file_and_so_do_its_copies(text, same):
    assert render_date(same(parse_date(text))) == text


def test_a_date_that_was_changed_is_written_as_emf_writes_dates():
    assert render_date(parse_date("2024-05-01") + timedelta(hours=2)) == "2024-05-01T02:00:00.000+0000"
    assert render_date(parse_date("2024-05-01").replace(year=2025)) == "2025-05-01T00:00:00.000+0000"


def test_a_date_equals_any_other_of_its_instant_whatever_its_text():
    assert parse_date("2024-05-01") == datetime(2024, 5, 1, 2, tzinfo=timezone(timedelta(hours=2)))


@pytest.mark.parametrize(
    ("text", "doubt"),
    [
        ("2024-05-01T10:11:12.123+0200", ""),
        (" 2024-05-01T10:11:12.123-0000", ""),
        (
            "2024-05-01T10:11:12.5+0200",
            "is read as 2024-05-01T10:11:12.005+0200, as by Eclipse; "
            "write 2024-05-01T10:11:12.500+0200 if that is meant, else 2024-05-01T10:11:12.005+0200",
        ),
        (
            "2024-05-01T10:11:12.123+02:00",
            "is read as 2024-05-01T10:11:12.123+0000, and by Eclipse in the time zone of its machine; "
            "write 2024-05-01T10:11:12.123+0200 if that is meant, else 2024-05-01T10:11:12.123+0000",
        ),
        (
            "2024-05-01",
            "is read as 2024-05-01T00:00:00.000+0000, and by Eclipse in the time zone of its machine; "
            "write 2024-05-01T00:00:00.000+0000",
        ),
    ],
)
def test_what_is_not_plain_from_a_text_is_told_with_what_to_write_instead(text, doubt):
    assert doubt_of_date(parse_date(text)) == doubt


@pytest.mark.parametrize("zone", [UTC, timezone(timedelta(hours=2, seconds=1)), None])
@pytest.mark.parametrize("moment", [datetime(1582, 10, 14, 23, 59), datetime(1500, 3, 10), datetime(1, 1, 1)])
def test_a_date_of_before_the_calendar_was_changed_is_not_written(moment, zone):
    with pytest.raises(ValueError, match=rf"^{moment.year:04}-\S*: before 15 October 1582, when the cal"):
        render_date(moment.replace(tzinfo=zone))


def test_a_date_in_a_zone_of_odd_seconds_is_written_in_utc():
    date = datetime(1850, 5, 1, tzinfo=timezone(timedelta(minutes=53, seconds=28)))
    assert render_date(date) == "1850-04-30T23:06:32.000+0000"


def test_a_date_without_zone_is_written_as_utc_and_told():
    assert render_date(datetime(2024, 5, 1)) == "2024-05-01T00:00:00.000+0000"
    assert doubt_of_date(datetime(2024, 5, 1)) == "has no zone and is written as UTC; state its zone"


def test_a_date_finer_than_milliseconds_is_refused():
    with pytest.raises(ValueError, match=r"2024-05-01T00:00:00\.000001: finer than milliseconds"):
        render_date(datetime(2024, 5, 1, microsecond=1))


def test_a_date_that_leaves_the_years_of_python_by_its_zone_is_refused():
    odd = timezone(-timedelta(hours=2, seconds=1))
    with pytest.raises(ValueError, match="or after the year 9999: not supported"):
        render_date(datetime(9999, 12, 31, 23, tzinfo=odd))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("12024-01-01", "or after the year 9999"),
        ("999999999-01-01", "or after the year 9999"),
        ("1582-10-14T23:59:59.999+0000", "before 15 October 1582, when the calendar changed"),
        ("1581-30-01", "before 15 October 1582"),
        ("1583-01--999999999", "before 15 October 1582"),
        ("0000-01-01", "before 15 October 1582"),
        ("-44-03-15", "before 15 October 1582"),
        ("9999999999-01-01", "not a date such as"),
        ("2024-05-01T10:11:12.1234567890", "not a date such as"),
        ("2024-05-01T10:11:12.123 PST", "a zone by name; write it as"),
        ("1" * 1_000_000, "not a date such as"),
        ("", "not a date such as"),
    ],
)
def test_what_python_or_emf_has_no_date_for_is_refused(text, words):
    with pytest.raises(ValueError, match=words):
        parse_date(text)


def test_a_written_date_without_a_text_is_like_any_other():
    assert render_date(WrittenDate(2024, 5, 1, tzinfo=UTC)) == "2024-05-01T00:00:00.000+0000"
