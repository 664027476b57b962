"""What was asked, and how much of it was achieved."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import go_to, robot_program, take_off

from mmrs_core.pictures.flights.planned import legs_of
from mmrs_core.pictures.report.contents import TaskStatus
from mmrs_core.pictures.report.tasks import task_reports
from mmrs_core.testing.programs import move, program


@pytest.fixture
def told(behaviour, run, contributions):
    def reports(flight, plan=run, of=behaviour):
        legs = {
            robot.id: legs_of(robot, flown, contributions.move_kinds)
            for robot in of.robots
            for flown in (flight.robots[robot.id],)
        }
        return {task.name: task for task in task_reports(of, flight, plan, legs)}

    return reports


def until(records, move, label="begin"):
    """Return the records up to the first of that label of a move."""
    index = next(i for i, record in enumerate(records) if (record.move, record.label) == (move, label))
    return records[: index + 1]


def test_a_run_as_planned_has_done_every_task(told, as_run):
    tasks = told(as_run())
    assert {name: (task.status, task.part) for name, task in tasks.items()} == {
        "photos": (TaskStatus.DONE, 1.0),
        "look": (TaskStatus.DONE, 1.0),
    }
    assert tasks["photos"].flown == pytest.approx(tasks["photos"].planned)
    assert tasks["photos"].robots == ("alpha",)


def test_a_task_that_nobody_came_to_is_not_done(told, as_run):
    records = until(as_run().robots["beta"].records, "b1")
    look = told(as_run(beta={"records": records}))["look"]
    assert (look.status, look.part, look.flown) == (TaskStatus.NOT_DONE, 0.0, None)


def test_a_task_that_was_broken_off_is_told_in_parts_of_its_planned_time(told, as_run, run):
    flight = as_run()
    records = until(flight.robots["alpha"].records, "a3", "begin")
    begun = records[-1].time
    track = flight.robots["alpha"].track
    kept = track.times <= begun
    cut = replace(track, **{n: getattr(track, n)[kept] for n in ("times", "positions", "energies", "broken")})
    photos = told(as_run(alpha={"records": records, "track": cut}))["photos"]
    planned = {r.move: r.time for r in run.records if r.robot == "alpha" and r.label == "begin"}
    whole = photos.planned[1] - planned["a1"]
    assert photos.status is TaskStatus.PART
    assert photos.part == pytest.approx((begun - planned["a1"]) / whole, abs=0.02)
    assert photos.flown == (planned["a1"], None)


def test_half_of_a_way_counts_as_half_of_its_move(make, told, contributions):
    of = program(robot_program("alpha", [take_off("up", 5.0), go_to("a", (100.0, 0.0, 5.0), task="t")]))
    records = make.records(
        "alpha", (0.0, "begin", "start"), (0.0, "end", "start"), (0.0, "take", "start", "up"),
        (0.0, "begin", "up"), (5.0, "end", "up"), (5.0, "take", "up", "a"), (5.0, "begin", "a"),
    )  # fmt: skip
    track = make.track([(0, 0, 0, 0), (5, 0, 0, 5), (15, 40, 0, 5)])
    flight = make.flight(make.flown("alpha", records, track))
    assert told(flight, None, of)["t"].part == pytest.approx(0.4)


def test_moves_that_only_lead_to_a_task_are_none_of_it(make, told):
    way = replace(go_to("way", (9.0, 0.0, 5.0), task="t"), rule="transit")
    of = program(robot_program("alpha", [way]))
    assert told(make.flight(make.flown("alpha")), None, of) == {}


def test_a_task_on_the_other_way_of_a_choice_was_not_needed(make, told, run, as_run):
    of = program(
        robot_program(
            "alpha", [take_off("up", 5.0), move("wait", "HoldPosition", task="extra", duration=1.0)]
        )
    )
    skipped = replace(run, records=tuple(r for r in run.records if r.move in ("start", "up")))
    flight = make.flight(replace(as_run().robots["alpha"], records=()))
    assert told(flight, skipped, of)["extra"].status is TaskStatus.NOT_CHOSEN
