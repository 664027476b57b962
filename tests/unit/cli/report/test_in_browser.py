"""A real browser shows a report: nothing is fetched and nothing runs, whatever vehicles say."""

from __future__ import annotations

import subprocess

import pytest

from mmrs_core.cli.flights.planned import Planned
from mmrs_core.cli.preview.from_flight import picture_of_flight
from mmrs_core.cli.preview.from_run import Surroundings
from mmrs_core.cli.report.making import Given, report_of
from mmrs_core.cli.report.page import page

OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-logging=stderr",
    "--virtual-time-budget=3000",
)

pytestmark = pytest.mark.peer


@pytest.fixture
def markup(behaviour, place, run, contributions, as_run, make):
    """Return a function: the page of a flight that went as planned, with entries of alpha's black box."""

    def made(*entries):
        flight = as_run(alpha={"entries": entries})
        planned = Planned(run)
        given = Given(behaviour, place, flight, planned, contributions.move_kinds)
        around = Surroundings(place.areas, types=place.types)
        picture = picture_of_flight(behaviour, flight, planned, contributions, around)
        return page(report_of(given), given, picture)

    return made


@pytest.fixture
def shown(need_program, tmp_path):
    """Return a function: what the browser makes of a page, and what it complains of."""
    browser = need_program("chromium", "it shows the report as a person sees it")

    def show(text, *more):
        file = tmp_path / "page.html"
        file.write_text(text, encoding="utf-8")
        command = [browser, *OPTIONS, f"--user-data-dir={tmp_path / 'profile'}", *more, "--dump-dom"]
        done = subprocess.run([*command, file.as_uri()], capture_output=True, text=True, timeout=120)
        return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]

    return show


def test_the_browser_has_nothing_to_complain_of(shown, markup):
    dom, complaints = shown(markup())
    assert complaints == []
    assert dom.count("<svg") >= 5


def test_what_vehicles_say_runs_nothing(shown, markup, make):
    bait = "<img src=x onerror=document.title='caught'><script>document.title='caught'</script>"
    entries = (
        make.entry(1.0, "text", severity="ERROR", text=bait),
        make.entry(2.0, "reported", name=bait, content={bait: bait}),
        make.entry(3.0, "decision", what=bait, why=bait, response=bait),
        make.entry(4.0, "start", vehicle=bait, firmware=bait, link=bait),
    )
    dom, complaints = shown(markup(*entries))
    assert "<title>caught</title>" not in dom
    assert "<img" not in dom
    assert complaints == []
