"""What happened is told in words, and what a vehicle said as it said it."""

from mmrs_core.pictures.flights.planned import Planned
from mmrs_core.pictures.report.assembly import Given, report_of
from mmrs_core.pictures.report.page import figures
from mmrs_core.pictures.report.tables import events


def test_codes_are_spelt_out_and_names_of_things_and_of_others_stay(
    behaviour, place, run, contributions, as_run, make
):
    entries = (
        make.entry(1.0, "text", severity="CRITICAL", text="EKF Failsafe: changed to LAND Mode"),
        make.entry(2.0, "decision", what="POSITION_LOST", why="it has no GPS fix", response="EMERGENCY_AREA"),
    )
    flight = as_run(alpha={"entries": entries})
    table = events(report_of(Given(behaviour, place, flight, Planned(run), contributions))).tables[0]
    assert [row[3:] for row in table.rows] == [
        ("EKF Failsafe: changed to LAND Mode", "critical"),
        ("position lost", "it has no GPS fix; response: emergency area"),
    ]


def test_faults_that_were_answered_count_although_the_program_went_on(
    behaviour, place, run, contributions, as_run, make
):
    alpha = (
        make.entry(2.0, "decision", what="BATTERY_LOW", why="20 % is left", response="RETURN"),
        make.entry(9.0, "decision", what="resume", why="its log ends", response="goes the way it came"),
    )
    flight = as_run(alpha={"entries": alpha})
    made = report_of(Given(behaviour, place, flight, Planned(run), contributions))
    assert dict(figures(made))["faults"] == "1 (battery low)"


def test_a_fault_that_ended_a_program_counts_once(behaviour, place, run, contributions, as_run, make):
    alpha = {
        "entries": (make.entry(2.0, "decision", what="LINK_LOST", why="nothing heard", response="RETURN"),),
        "records": make.records("alpha", (2.0, "fault", "a2", "LINK_LOST: nothing heard")),
    }
    given = Given(behaviour, place, as_run(alpha=alpha), Planned(run), contributions)
    assert dict(figures(report_of(given)))["faults"] == "1 (link lost)"
