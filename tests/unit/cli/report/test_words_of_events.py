"""What happened is told in words, and what a vehicle said as it said it."""

from __future__ import annotations

from mmrs_core.cli.flights.planned import Planned
from mmrs_core.cli.report.making import Given, report_of
from mmrs_core.cli.report.sections import events


def test_codes_are_spelt_out_and_names_of_things_and_of_others_stay(
    behaviour, place, run, contributions, as_run, make
):
    entries = (
        make.entry(1.0, "text", severity="CRITICAL", text="EKF Failsafe: changed to LAND Mode"),
        make.entry(2.0, "decision", what="POSITION_LOST", why="it has no GPS fix", response="EMERGENCY_AREA"),
    )
    flight = as_run(alpha={"entries": entries})
    told = events(report_of(Given(behaviour, place, flight, Planned(run), contributions.move_kinds)))
    assert "EKF Failsafe: changed to LAND Mode" in told
    assert "position lost" in told
    assert "it has no GPS fix; response: emergency area" in told
