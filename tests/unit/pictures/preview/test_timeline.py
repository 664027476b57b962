"""The timeline and the heights tell when things happen."""

import re
from dataclasses import replace

from svg_reading import SVG, parsed, tip, with_class

from mmrs_core.pictures.preview.page import page
from mmrs_core.pictures.preview.picture import Arm, Bar
from mmrs_core.pictures.preview.profile import profile_of
from mmrs_core.pictures.preview.timeline import TimeAxis, stretches, timeline_of


def test_a_bar_begins_and_ends_with_its_step(picture):
    axis = TimeAxis(picture.makespan)
    wait = with_class(timeline_of(picture), "wait")[0]
    assert abs(float(wait.get("x")) - axis.at(20.0)) < 0.01
    assert abs(float(wait.get("width")) - (axis.at(31.0) - axis.at(20.0))) < 0.02


def test_an_arrow_leads_from_the_teller_to_the_waiter(picture):
    arrows = with_class(timeline_of(picture), "handover")
    assert [tip(arrow) for arrow in arrows] == ["Alba releases Brezza at 0:31: field has ended"]


def test_an_arrow_is_dashed_where_nobody_has_to_wait_for_it(picture):
    early = replace(picture.handovers[0], since=40.0, released=40.0)
    arrows = with_class(timeline_of(replace(picture, handovers=(early,))), "handover")
    assert [arrow.get("class") for arrow in arrows] == ["handover early"]
    assert with_class(timeline_of(picture), "early") == []


def test_a_task_without_duration_is_a_mark(picture):
    marks = with_class(timeline_of(picture), "task-mark")
    assert [tip(mark) for mark in marks] == ["fork: fork, 0:31 to 0:31"]


def test_a_task_that_was_done_in_part_says_how_much(picture):
    tasks = tuple(replace(task, part=0.934) for task in picture.tasks if task.name == "field")
    markup = timeline_of(replace(picture, tasks=tasks))
    (bar,) = with_class(markup, "partly")
    assert tip(bar).endswith(", done to 93 %")
    assert "93 %" in [words.text for words in with_class(markup, "task-name")]


def test_names_stand_on_bars_only_where_they_fit(picture):
    wide = with_class(timeline_of(picture), "bar-words")
    robots = tuple(
        replace(robot, bars=(Bar("work", 0.0, 0.5, "a task with a very long name"),))
        for robot in picture.robots
    )
    assert [e.text for e in wide] == ["field", "road"]
    assert with_class(timeline_of(replace(picture, robots=robots)), "bar-words") == []


def test_a_recharge_parts_the_stretches_of_a_task():
    bars = tuple(
        Bar(kind, begin, begin + 10.0, "field")
        for kind, begin in (
            ("work", 0.0),
            ("transit", 10.0),
            ("work", 20.0),
            ("recharge", 30.0),
            ("work", 40.0),
        )
    )
    assert list(stretches(bars)) == [("field", 0.0, 30.0), ("field", 40.0, 50.0)]


def test_a_timeline_without_robots_is_still_a_picture(without_robots):
    assert parsed(timeline_of(without_robots)).tag == f"{SVG}svg"


def test_marks_of_time_are_about_a_dozen_at_most():
    assert all(
        2 <= len(list(TimeAxis(end).marks())) <= 14 for end in (1.0, 7.0, 61.0, 600.0, 5000.0, 1e5, 3e6)
    )


def test_heights_follow_the_robot(picture):
    heights = dict(picture.robots[0].heights)
    assert heights[0.0] == 0.0
    assert heights[7.0] == 20.0
    assert heights[50.0] == 0.0


def test_each_robot_has_a_line_of_heights(picture):
    assert len(with_class(profile_of(picture), "height")) == 2


def test_limits_outside_the_chart_are_left_out(picture):
    limits = [tip(line) for line in with_class(profile_of(picture), "limit")]
    assert limits == ["floor of Alba: 1.0 m", "floor of Brezza: 1.0 m"]


def test_the_water_surface_is_drawn_for_those_under_it(picture):
    wet = replace(picture, surface=1.0)
    assert len(with_class(profile_of(wet), "surface")) == len(picture.robots)
    assert with_class(profile_of(picture), "surface") == []


def test_the_time_axis_has_a_name(picture):
    for markup in (timeline_of(picture), profile_of(picture)):
        (axis,) = with_class(markup, "axis")
        assert axis.findtext(f"{SVG}text") == "time"


def test_what_was_planned_to_end_later_is_in_the_chart(picture):
    late = 2.0 * picture.makespan
    bar = Bar("transit", 0.0, late)
    robot = replace(
        picture.robots[0], arms=(Arm("as planned", 0.0, late, (bar,)),), planned_heights=((late, 5.0),)
    )
    flown = replace(picture, robots=(robot, *picture.robots[1:]))
    frame = with_class(timeline_of(flown), "arm-frame")[0]
    right = float(frame.get("x")) + float(frame.get("width"))
    assert right == TimeAxis(late).at(late)
    assert re.search(r'<input type="range"[^>]* max="([\d.]+)"', page(flown)).group(1) == f"{late:g}"
