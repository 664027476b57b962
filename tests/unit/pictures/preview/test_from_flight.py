"""The picture of a flight shows what logs and black boxes say, over what was planned."""

import pytest
from flights_by_hand import flight_as, track_of

from mmrs_core.pictures.flights.planned import Planned
from mmrs_core.pictures.preview.from_flight import picture_of_flight
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.pictures.preview.page import page
from mmrs_core.pipeline import BehaviourContext
from mmrs_runtime.records.entries import Entry
from mmrs_runtime.records.steps import StepRecord


@pytest.fixture
def shown(behaviour, run, types, contributions):
    """Return a function: the picture of a flight that went as planned, but for what is given by robot."""

    def picture(**changed):
        flight = flight_as(run, behaviour, **changed)
        around = BehaviourContext(types)
        return picture_of_flight(behaviour, flight, Planned(run), contributions, around)

    return picture


def test_every_leg_is_where_and_when_the_robot_was(shown):
    alpha = shown().robots[0]
    assert [leg.moves for leg in alpha.legs] == [
        f"move {id}" for id in ("up", "a1", "a2", "a3", "a4", "back", "down")
    ]
    for before, after in zip(alpha.legs[:-1], alpha.legs[1:], strict=True):
        assert before.points[-1] == pytest.approx(after.points[0], abs=0.3)
    assert all(len(leg.times) == len(leg.points) for leg in alpha.legs)


def test_what_was_planned_lies_beneath(shown):
    alpha = shown().robots[0]
    assert len(alpha.planned) == 7
    assert alpha.planned_heights[-1][1] == pytest.approx(0.0)
    assert [arm.words for arm in alpha.arms] == ["as planned"]
    assert map_of(shown()).count('class="planned"') == 2


def test_a_gap_is_not_drawn(shown):
    whole = shown().robots[0]
    points = [(leg.begin, *leg.points[0]) for leg in whole.legs]
    cut = shown(alpha={"track": track_of(points, broken=[2])}).robots[0]
    begin, end = points[2][0], points[3][0]
    assert not any(leg.begin < end and leg.end > begin for leg in cut.legs)


def test_a_way_that_no_move_says_is_not_in_the_plan(shown, run):
    records = [record for record in run.records if record.robot == "alpha"]
    index = next(i for i, record in enumerate(records) if (record.label, record.move) == ("begin", "a3"))
    last = records[index]
    fault = StepRecord(
        last.run, "alpha", last.seq + 1, last.lamport + 1, last.time, "fault", "a3", "LINK_LOST"
    )
    points = [(s.time, *s.position) for s in run.tracks["alpha"] if s.time <= last.time]
    home = [(last.time + 20.0, 0.0, 0.0, 20.0), (last.time + 30.0, 0.0, 0.0, 0.0)]
    picture = shown(alpha={"records": (*records[: index + 1], fault), "track": track_of([*points, *home])})
    alpha = picture.robots[0]
    assert [leg.kind for leg in alpha.legs][-1] == "response"
    assert alpha.legs[-1].points[-1] == (0.0, 0.0, 0.0)
    assert (alpha.bars[-1].kind, alpha.bars[-1].end) == ("response", last.time + 30.0)
    assert [mark.kind for mark in alpha.marks] == ["fault"]


def test_time_at_home_for_a_battery_is_not_work(shown, run):
    records = [record for record in run.records if record.robot == "alpha"]
    begun = next(r.time for r in records if (r.label, r.move) == ("begin", "a3"))
    pause = 100.0
    later = tuple(r._replace(time=r.time + pause) if r.time > begun + 1.0 else r for r in records)
    samples = [(s.time, *s.position) for s in run.tracks["alpha"]]
    before = [row for row in samples if row[0] <= begun]
    home = [(begun + 30.0, 0.0, 0.0, 0.0), (begun + 80.0, 0.0, 0.0, 0.0), (begun + pause, *before[-1][1:])]
    after = [(time + pause, *position) for time, *position in samples if time > begun]
    low = Entry("r", "alpha", begun + 0.5, "", "decision", {"what": "BATTERY_LOW", "response": "RETURN"})
    alpha = shown(
        alpha={"records": later, "track": track_of([*before, *home, *after]), "entries": (low,)}
    ).robots[0]
    away = next(bar for bar in alpha.bars if bar.kind == "response")
    assert (away.begin, away.end) == pytest.approx((begun + 0.5, begun + pause))
    assert not any(bar.kind == "work" and bar.begin < away.end and bar.end > away.begin for bar in alpha.bars)
    assert [leg.kind for leg in alpha.legs if leg.begin < away.end and leg.end > away.begin] == ["response"]


def test_a_robot_of_which_nobody_knows_where_it_was_is_said_to_be_one(shown):
    picture = shown(beta={"track": track_of([])})
    assert picture.robots[1].legs == ()
    assert "beta: its track is unknown, there is no black box of it" in picture.notes
    assert ("distance", "unknown") in picture.robots[1].summary


def test_a_photo_that_nobody_confirmed_is_marked(shown):
    assert [mark.kind for mark in shown().robots[0].marks] == ["missing"]


def test_a_map_of_one_robot_keeps_its_style(shown):
    picture = shown()
    only = map_of(picture, only=1)
    assert 'data-robot="1"' in only
    assert 'data-robot="0"' not in only
    assert ">alpha<" not in only


def test_the_page_has_the_times_of_the_ways(shown):
    text = page(shown())
    assert '"times"' in text
    assert "planned paths" in text


def test_a_fault_is_marked_where_it_was_answered_although_the_program_went_on(shown, run):
    times = [sample.time for sample in run.tracks["alpha"]]
    content = {"what": "BATTERY_LOW", "why": "20 % is left", "response": "RETURN"}
    entry = Entry("r", "alpha", times[len(times) // 2], "", "decision", content)
    (mark,) = (mark for mark in shown(alpha={"entries": (entry,)}).robots[0].marks if mark.kind == "fault")
    assert mark.tip.startswith("BATTERY_LOW at ")


def test_a_robot_took_as_long_as_its_program(shown, run):
    last = [record for record in run.records if record.robot == "alpha"][-1]
    later = Entry("r", "alpha", last.time + 500.0, "", "note", {})
    robot = shown(alpha={"entries": (later,)}).robots[0]
    assert dict(robot.summary)["time"] == dict(shown().robots[0].summary)["time"]


def test_what_a_robot_does_about_a_low_battery_is_shown_although_its_log_waits(shown, run):
    records = [record for record in run.records if record.robot == "alpha"]
    index = next(i for i, record in enumerate(records) if (record.label, record.move) == ("begin", "a3"))
    last = records[index].time
    low = Entry("r", "alpha", last + 1.0, "", "decision", {"what": "BATTERY_LOW", "response": "RETURN"})
    points = [(s.time, *s.position) for s in run.tracks["alpha"] if s.time <= last]
    home = [(last + 20.0, 0.0, 0.0, 20.0), (last + 30.0, 0.0, 0.0, 0.0)]
    told = {"records": tuple(records[: index + 1]), "track": track_of([*points, *home]), "entries": (low,)}
    (away,) = (bar for bar in shown(alpha=told).robots[0].bars if bar.kind == "response")
    assert (away.begin, away.end) == (last + 1.0, last + 30.0)
