"""What happened is told in words, and what a vehicle said as it said it."""

from __future__ import annotations

from mmrs_core.pictures.flights.planned import Planned
from mmrs_core.pictures.report.making import Given, report_of
from mmrs_core.pictures.report.sections import events
from mmrs_core.pictures.report.summary import tiles


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


def test_faults_that_were_answered_count_although_the_program_went_on(
    behaviour, place, run, contributions, as_run, make
):
    alpha = (
        make.entry(2.0, "decision", what="BATTERY_LOW", why="20 % is left", response="RETURN"),
        make.entry(9.0, "decision", what="resume", why="its log ends", response="goes the way it came"),
    )
    told = tiles(
        report_of(
            Given(behaviour, place, as_run(alpha={"entries": alpha}), Planned(run), contributions.move_kinds)
        )
    )
    assert "<dt>faults</dt><dd>1 (battery low)</dd>" in told


def test_a_fault_that_ended_a_program_counts_once(behaviour, place, run, contributions, as_run, make):
    alpha = {
        "entries": (make.entry(2.0, "decision", what="LINK_LOST", why="nothing heard", response="RETURN"),),
        "records": make.records("alpha", (2.0, "fault", "a2", "LINK_LOST: nothing heard")),
    }
    given = Given(behaviour, place, as_run(alpha=alpha), Planned(run), contributions.move_kinds)
    assert "<dt>faults</dt><dd>1 (link lost)</dd>" in tiles(report_of(given))
