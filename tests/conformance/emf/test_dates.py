"""Dates, as EMF reads them on machines in two time zones, and as we do."""

from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import pytest
from emf_description import model_lines
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.languages.writing import write_model

pytestmark = [pytest.mark.together("emf"), pytest.mark.peer]

ECORE = Path(__file__).parents[2] / "fixtures" / "models" / "values.ecore"
CERTAIN = [
    "2024-05-01T10:11:12.123+0000",
    "2024-05-01T10:11:12.123+0200",
    "2024-05-01T10:11:12.123-0330",
    "2024-05-01T10:11:12.123-0000",
    "2024-05-01T10:11:12.123+2359",
    " 2024-05-01T10:11:12.123+0200 ",
    "9999-12-31T23:59:59.999+0000",
    "1970-01-01T00:00:00.000+0000",
    "1582-10-15T00:00:00.000+0000",
]
"""What EMF itself writes, but for signs of zero and blanks around."""
SURPRISING = [
    "2024-05-01T10:11:12.5+0200",
    "2024-05-01T10:11:12.12+0200",
    "2024-05-01T10:11:12.1234+0200",
    "2024-05-01T10:11:12.123456+0200",
    "2024-05-01T10:11:12.000000000123+0000",
    "2024-05-01T10:11:12.123 +0200",
    "2024-05-01T10:11:12. 123+0200",
    "2024-05-01T10:11:12.123+0200x",
    "2024-05-01T10:11:12.123+02005",
    "2024-05-01T10:11:12.123UTC",
    "2024-05-01T10:11:12.123 gmt",
    "2024-05-01T10:11:12.123GMT+2:00",
    "2024-5-1T1:2:3.4+0000",
    "2024-13-45T00:00:00.000+0000",
    "2024-00-00T00:00:00.000+0000",
    "2023-02-29T00:00:00.000+0000",
    "2024-05-01T24:00:00.000+0000",
    "2024-05-01T10:11:60.000+0000",
    "2024-05-01T99:99:99.999+0000",
    "1700-02-29T00:00:00.000+0000",
    "1582-10-14T24:00:00.000+0000",
    "1582-10-04T300:00:00.000-0200",
    "1582-13-01T00:00:00.000+0000",
    "2024--5--1T-1:-1:-1.-1+0000",
]
"""What EMF takes for the same instant everywhere, though not for the one that people would think of."""
LOCAL = [
    "2024-05-01",
    "2024-05-01T10:11",
    "2024-05-01T10:11:12",
    "2024-05-01T10:11:12.5",
    "2024-05-01T10:11:12.123",
    "2024-05-01T10:11:12.123456",
    "2024-05-01T10:11:12.123Z",
    "2024-05-01T10:11:12.123z",
    "2024-05-01T10:11:12.123+02:00",
    "2024-05-01T10:11:12.123+2400",
    "2024-05-01T10:11:12.123+2360",
    "2024-05-01T10:11:12.123+020",
    "2024-05-01T10:11:12.123+ 0200",
    "2024-05-01T10:11:12+0200",
    "2024-05-01T10:11:12Z",
    "2024-05-01T10:11+0200",
    "2024-05-01+0200",
    "2024-05-01 10:11:12",
    "2024-05-01t10:11:12.123+0200",
    "2024-05-01T10:11:12,123+0200",
    "2024-05-01T10",
    "2024-05-01T10:11:",
    "2024-05-01T10:11:12.x",
    "2024-05-01T10:11:12.123x",
    "2024-05-01\n",
    " 2024-5-1 ",
    "2024-13-45",
    "٢٠٢٤-05-01",
]
"""What EMF takes in the time zone of its machine, whatever zone it states."""


@pytest.fixture(scope="module")
def known(referee):
    with referee.knowing(ECORE):
        yield referee


@pytest.fixture(scope="module")
def far(elsewhere):
    with elsewhere.knowing(ECORE):
        yield elsewhere


@pytest.fixture(scope="module")
def values():
    return registry_with([MetamodelSource("urn:test:values", ECORE, "values")])


def written(file, text):
    escaped = text.replace("\n", "&#10;")
    file.write_text(f'<v:Value xmlns:v="urn:test:values" EDate="{escaped}"/>', encoding="utf-8")
    return file


def told(referee, file):
    """Return what EMF finds in a file, which it reads without a word."""
    answer = referee.ask("dump", file)
    assert answer.faults == []
    return list(answer.lines[1:])


@pytest.mark.parametrize("text", [*CERTAIN, *SURPRISING, *LOCAL])
def test_a_date_is_the_instant_that_emf_reads_where_the_clock_shows_utc(known, values, tmp_path, text):
    file = written(tmp_path / "case.xmi", text)
    model = read_model(file, values)
    assert model.diagnostics == ()
    assert list(model_lines(model.roots, "case.xmi")) == told(known, file)


@pytest.mark.parametrize("text", [*CERTAIN, *SURPRISING, *LOCAL])
def test_a_date_that_is_written_again_is_the_same_for_emf_in_any_zone(known, far, values, tmp_path, text):
    file = written(tmp_path / "case.xmi", text)
    roots = read_model(file, values).roots
    write_model(roots, tmp_path / "ours.xmi", values)
    write_model(roots, tmp_path / "ours.json", values)
    write_model(read_model(tmp_path / "ours.json", values).roots, tmp_path / "back.xmi", values)
    for referee in (known, far):
        assert "EQUAL" in referee.ask("equal", file, tmp_path / "ours.xmi").lines
        assert "EQUAL" in referee.ask("equal", file, tmp_path / "back.xmi").lines


@pytest.mark.parametrize("text", [*CERTAIN, *SURPRISING, *LOCAL])
def test_a_date_that_depends_on_emfs_machine_is_told_as_such(known, far, values, tmp_path, text):
    file = written(tmp_path / "case.xmi", text)
    model = read_model(file, values)
    found = check_conformance(model, values)
    depends = told(known, file) != told(far, file)
    assert depends is (text in LOCAL)
    assert [fault.code for fault in found] == ([] if text in CERTAIN else ["ECO014"])
    assert (
        "time zone of its machine" in "".join(f"{fault.message} {fault.hint}" for fault in found)
    ) is depends


ZONES = st.integers(-23 * 60 - 59, 23 * 60 + 59).map(lambda minutes: timezone(timedelta(minutes=minutes)))
DATES = st.datetimes(datetime(1582, 10, 15), datetime(9999, 12, 29), timezones=ZONES).map(
    lambda date: date.replace(microsecond=date.microsecond // 1000 * 1000, fold=0)
)
COUNTS = [pytest.param(100), pytest.param(1000, marks=pytest.mark.thorough)]


@pytest.mark.parametrize("count", COUNTS)
def test_emf_reads_every_date_that_we_write_as_that_instant_wherever_it_is(far, values, tmp_path, count):
    file = tmp_path / "dates.xmi"

    @seed(20261121)
    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=[*HealthCheck],
    )
    @given(dates=st.lists(DATES, min_size=20, max_size=20))
    def check(dates):
        root = values.create("urn:test:values", "Value", manyEDate=dates)
        write_model([root], file, values)
        epoch = datetime(1970, 1, 1, tzinfo=UTC)
        instants = ", ".join(str((date - epoch) // timedelta(milliseconds=1)) for date in dates)
        assert f"VALUE dates.xmi#0 manyEDate [{instants}]" in told(far, file)
        assert check_conformance(read_model(file, values), values) == ()

    check()
