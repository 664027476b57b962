"""A real browser shows a report: nothing is fetched and nothing runs, whatever vehicles say."""

import pytest

from mmrs_core.pictures.flights.planned import Planned
from mmrs_core.pictures.preview.from_flight import picture_of_flight
from mmrs_core.pictures.report.assembly import Given, report_of
from mmrs_core.pictures.report.page import page

pytestmark = pytest.mark.peer


@pytest.fixture
def markup(behaviour, place, run, contributions, as_run, make):
    """Return a function: the page of a flight that went as planned, with entries of alpha's black box."""

    def made(*entries):
        flight = as_run(alpha={"entries": entries})
        planned = Planned(run)
        given = Given(behaviour, place, flight, planned, contributions)
        picture = picture_of_flight(behaviour, flight, planned, contributions, place)
        return page(report_of(given), given, picture)

    return made


def test_the_browser_has_nothing_to_complain_of(in_browser, markup):
    dom, complaints = in_browser(markup())
    assert complaints == []
    assert dom.count("<svg") >= 5


def test_what_vehicles_say_runs_nothing(in_browser, markup, make):
    bait = "<img src=x onerror=document.title='caught'><script>document.title='caught'</script>"
    entries = (
        make.entry(1.0, "text", severity="ERROR", text=bait),
        make.entry(2.0, "reported", name=bait, content={bait: bait}),
        make.entry(3.0, "decision", what=bait, why=bait, response=bait),
        make.entry(4.0, "start", vehicle=bait, firmware=bait, link=bait),
    )
    dom, complaints = in_browser(markup(*entries))
    assert "<title>caught</title>" not in dom
    assert "<img" not in dom
    assert complaints == []
