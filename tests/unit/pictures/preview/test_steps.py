"""Every way of a choice is shown, and every place at which a robot stays."""

import pytest
from svg_reading import tip, with_class

from mmrs_core.pictures.preview.from_plan import arms_of, picture_of_plan
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.pictures.preview.page import page
from mmrs_core.pictures.preview.profile import profile_of
from mmrs_core.pictures.preview.timeline import timeline_of
from mmrs_core.scene import ActionAt, Branch, Plan, RobotPlan, Serve, Stroke, Transit

HERE, THERE, LOW = (50.0, 30.0, 20.0), (80.0, 50.0, 30.0), (20.0, 30.0, 5.0)


def serve(begin, end, task, at, hold=0.0, actions=()):
    return Serve(begin, end, task, Stroke((at,), actions, hold=hold), 5.0, "observe", True, True)


LONG = (Transit(10.0, 15.0, "look", (HERE, THERE)), serve(15.0, 45.0, "look", THERE, 30.0))
SHORT = (Transit(10.0, 12.0, "dip", (HERE, LOW)), serve(12.0, 13.0, "dip", LOW))
CHOICE = Branch(10.0, 45.0, "fork", (("windy", SHORT), (None, LONG)), THERE)
STEPS = (
    Transit(0.0, 10.0, "", ((0.0, 0.0, 20.0), HERE)),
    CHOICE,
    Transit(45.0, 55.0, "", (THERE, (0.0, 0.0, 20.0))),
)


@pytest.fixture
def chooser(scene):
    """Return a picture in which one robot has a choice."""
    plan = Plan((RobotPlan("Alba", STEPS), RobotPlan("Brezza", ())), 55.0, {}, {})
    return picture_of_plan(scene, plan, {})


def test_every_way_of_a_choice_has_its_bars():
    arms = list(arms_of(STEPS))
    assert [(arm.words, arm.begin, arm.end, arm.longest) for arm in arms] == [
        ("if windy", 10.0, 13.0, False),
        ("otherwise", 10.0, 45.0, True),
    ]
    assert [[(bar.kind, bar.task) for bar in arm.bars] for arm in arms] == [
        [("transit", "dip"), ("work", "dip")],
        [("transit", "look"), ("work", "look")],
    ]


def test_inner_choices_follow_the_way_that_they_are_on():
    outer = Branch(0.0, 45.0, "", (("calm", (CHOICE,)), (None, ())), HERE)
    assert [(arm.words, arm.level) for arm in arms_of([outer])] == [
        ("if calm", 0), ("if windy", 1), ("otherwise", 1), ("otherwise", 0),
    ]  # fmt: skip


def test_the_timeline_names_every_way_beneath_its_robot(chooser):
    markup = timeline_of(chooser)
    names = ["".join(name.xpath("text()")) for name in with_class(markup, "arm-name")]
    assert names == ["if windy", "otherwise"]
    assert len(with_class(markup, "choice")) == 1
    ys = [float(name.get("y")) for name in with_class(markup, "robot-name")]
    inside = [float(name.get("y")) for name in with_class(markup, "arm-name")]
    assert ys[0] < inside[0] < inside[1] < ys[1]


def test_a_bar_of_a_way_tells_when_it_is_done(chooser):
    tips = [tip(bar) for bar in with_class(timeline_of(chooser), "work")]
    assert "Alba, if windy, works for dip, 0:12 to 0:13" in tips


def test_heights_follow_the_longest_way_and_never_go_back_in_time(chooser):
    heights = chooser.robots[0].heights
    assert [time for time, _ in heights] == sorted(time for time, _ in heights)
    assert (15.0, 30.0) in heights
    assert 5.0 not in {up for _, up in heights}


def test_heights_on_other_ways_are_drawn_too(chooser):
    tips = [tip(line) for line in with_class(profile_of(chooser), "aside")]
    assert tips == ["altitude of Alba, if windy"]


def test_the_table_names_the_tasks_of_every_way(chooser):
    assert dict(chooser.robots[0].summary)["tasks"] == "dip, look"


def test_a_place_at_which_a_robot_stays_has_a_mark_that_tells_why(chooser):
    stays = with_class(map_of(chooser), "stay")
    assert [tip(stay) for stay in stays] == [
        "Alba: work for dip, 0:12 to 0:13, up 5.0 m, if windy",
        "Alba: work for look, 0:15 to 0:45, up 30.0 m, otherwise, holds for 0:30",
    ]


def test_stays_at_one_place_share_a_mark(scene):
    steps = (
        serve(0.0, 2.0, "look", HERE, actions=(ActionAt(0.0, "StartVideo"),)),
        serve(2.0, 9.0, "look", HERE, 7.0),
    )
    plan = Plan((RobotPlan("Alba", steps),), 9.0, {}, {})
    (stay,) = with_class(map_of(picture_of_plan(scene, plan, {})), "stay")
    first, second = tip(stay).splitlines()
    assert first.endswith("StartVideo")
    assert second.endswith("holds for 0:07")


def test_ways_aside_are_not_for_the_player(chooser):
    assert '"tip": "Alba: work for look' in page(chooser)
    assert '"tip": "Alba: work for dip' not in page(chooser)
