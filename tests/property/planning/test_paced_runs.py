"""The time of any run of parts is that of the strokes which they are together."""

from dataclasses import replace
from itertools import pairwise
from math import dist

from hypothesis import assume, given
from hypothesis import strategies as st
from plain_scenes import photo, road, robot, scene, visit, with_kinematics

from mmrs_core.planning.pacing import paced
from mmrs_core.planning.strokes import joined, parts_of, serve_seconds, turned
from mmrs_core.planning.team import Team
from mmrs_core.scene import Repetition
from mmrs_runtime.timing import LegTiming

STEP = LegTiming(2.5, deceleration=1.5, jerk=5.0, spread=0.18)
QUICK_STEP = LegTiming(0.5, spread=0.18)
MISSION = LegTiming(2.5, jerk=0.9, corner_radius=2.0, settling=1.55, spread=0.18)

places = st.tuples(st.integers(0, 400), st.integers(0, 400), st.sampled_from([20, 30]))


@st.composite
def cut_roads(draw):
    points = [tuple(map(float, each)) for each in draw(st.lists(places, min_size=2, max_size=5))]
    assume(all(one != two for one, two in pairwise(points)))
    length = sum(dist(one, two) for one, two in pairwise(points))
    shares = st.floats(0.01, 0.99).map(lambda share: round(share * length, 3))
    cuts = tuple(sorted(set(draw(st.lists(shares, min_size=1, max_size=6)))))
    actions = sorted(draw(st.lists(st.one_of(shares, st.sampled_from(cuts)), max_size=4)))
    (stroke,) = road(*points, cuts=cuts, actions=tuple(map(photo, actions))).strokes
    if not actions and draw(st.booleans()):
        stroke = replace(stroke, repetition=Repetition(30.0, "TakePicture", "camera"))
    parts = parts_of(stroke)
    return tuple(turned(part) for part in reversed(parts)) if draw(st.booleans()) else parts


def seconds_of(parts, pilot):
    return sum(serve_seconds(each, pilot.robot, pilot.kinematics) for each in joined(parts))


def pilot_with(acceleration):
    each = with_kinematics(robot(), timing=LegTiming(acceleration))
    return Team(scene([each], {"a": visit((0.0, 9.0, 20.0))})).pilots["r1"]


@given(cut_roads(), st.data(), st.sampled_from([0.5, 3.0, float("inf")]))
def test_a_run_never_takes_longer_than_counted(parts, data, acceleration):
    pilot = pilot_with(acceleration)
    spans = paced(parts, pilot)
    first = data.draw(st.integers(0, len(parts) - 1))
    last = data.draw(st.integers(first, len(parts) - 1))
    run = seconds_of(parts[first : last + 1], pilot)
    assert spans[last][1] - spans[first][0] >= run - 1e-6


@given(cut_roads(), st.data())
def test_a_run_takes_no_less_than_it_may_at_the_soonest_and_no_more_than_at_the_latest(parts, data):
    each = with_kinematics(robot(), timing=LegTiming(0.5, spread=0.2, reporting=2.0))
    pilot = Team(scene([each], {"a": visit((0.0, 9.0, 20.0))})).pilots["r1"]
    first = data.draw(st.integers(0, len(parts) - 1))
    last = data.draw(st.integers(first, len(parts) - 1))
    for bound in (-1, 1):
        spans = paced(parts, pilot, bound)
        alone = paced(joined(parts[first : last + 1]), pilot, bound)
        more = spans[last][1] - spans[first][0] - (alone[-1][1] - alone[0][0])
        assert bound * more >= -1e-6


@given(cut_roads(), st.sampled_from([0.5, 3.0]))
def test_the_whole_takes_exactly_what_is_counted(parts, acceleration):
    pilot = pilot_with(acceleration)
    spans = paced(parts, pilot)
    assert abs(spans[-1][1] - seconds_of(parts, pilot)) < 1e-6


@given(cut_roads(), st.data())
def test_without_inertia_every_run_takes_exactly_what_is_counted(parts, data):
    pilot = pilot_with(float("inf"))
    spans = paced(parts, pilot)
    first = data.draw(st.integers(0, len(parts) - 1))
    run = seconds_of(parts[first:], pilot)
    assert abs(spans[-1][1] - spans[first][0] - run) < 1e-6


@given(cut_roads(), st.data())
def test_the_soonest_is_never_later_than_the_latest_and_even_speed_without_actions(parts, data):
    pilot = pilot_with(0.5)
    late, soon = paced(parts, pilot), paced(parts, pilot, -1)
    first = data.draw(st.integers(0, len(parts) - 1))
    last = data.draw(st.integers(first, len(parts) - 1))
    quickest = soon[last][1] - soon[first][0]
    assert quickest <= late[last][1] - late[first][0] + 1e-6
    assert quickest <= seconds_of(parts[first : last + 1], pilot) + 1e-6
    steady = pilot_with(float("inf"))
    if not any(part.commands for part in parts[first : last + 1]):
        even = seconds_of(parts[first : last + 1], steady)
        assert quickest <= even + 1e-6


@given(cut_roads(), st.data(), st.sampled_from([STEP, QUICK_STEP]))
def test_parts_that_become_missions_with_hops_take_no_longer_than_counted(parts, data, timing):
    each = with_kinematics(robot(), timing=timing, mission=MISSION, noticing=0.5)
    pilot = Team(scene([each], {"a": visit((0.0, 9.0, 20.0))})).pilots["r1"]
    spans = paced(parts, pilot, 1)
    first = data.draw(st.integers(0, len(parts) - 1))
    last = data.draw(st.integers(first, len(parts) - 1))
    alone = paced(joined(parts[first : last + 1]), pilot, 1)
    assert spans[last][1] - spans[first][0] >= alone[-1][1] - alone[0][0] - 1e-6
