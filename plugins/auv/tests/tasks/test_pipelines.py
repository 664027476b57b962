from math import hypot

import pytest
import shapely
from mmrs_auv.names import PIPELINE
from mmrs_auv.tasks.pipelines import beside, pipeline_work

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.positions import refuse_blocked
from mmrs_core.scene import Part

LINE = ((10.0, 0.0, -20.0), (60.0, 0.0, -20.0), (60.0, 60.0, -26.0))
PIPE = Part((PIPELINE,), {"name": "outfall", "points": LINE, "diameter": 0.4})


def follow(task, **more):
    return task("FollowPipelineTask", **{"pipeline": "outfall", "height": 1.5, "offset": 0.0, **more})


def test_a_pipeline_is_followed_above_it(robot, scene, task):
    (stroke,) = pipeline_work(follow(task), robot(), scene(elements=(PIPE,))).strokes
    assert stroke.points == ((10.0, 0.0, -18.5), (60.0, 0.0, -18.5), (60.0, 60.0, -24.5))
    assert stroke.reversible
    assert len(stroke.cuts) == 2


def test_it_may_be_followed_from_its_other_end(robot, scene, task):
    (stroke,) = pipeline_work(follow(task, inverted=True), robot(), scene(elements=(PIPE,))).strokes
    assert stroke.points[0] == (60.0, 60.0, -24.5)


@pytest.mark.parametrize("offset", [2.0, -2.0])
def test_a_way_beside_it_keeps_to_its_side_at_its_distance(robot, scene, task, offset):
    (stroke,) = pipeline_work(follow(task, offset=offset), robot(), scene(elements=(PIPE,))).strokes
    line, way = (shapely.LineString([point[:2] for point in points]) for points in (LINE, stroke.points))
    side = shapely.offset_curve(line, -offset, join_style="mitre")
    assert way.hausdorff_distance(side) <= 1e-9


def test_a_bend_that_is_too_sharp_is_refused_beside_it_only():
    sharp = ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    assert beside(sharp, 0.0) == sharp
    with pytest.raises(InfeasibleError, match="bends too sharply to be followed 1 m beside it"):
        beside(sharp, -1.0)


def test_nobody_comes_nearer_than_its_clearance(robot, scene, task):
    place = scene(elements=(PIPE,))
    assert pipeline_work(follow(task, height=0.3, offset=0.4), robot(), place).strokes
    assert hypot(0.3, 0.39) < 0.5
    with pytest.raises(
        InfeasibleError, match=r"comes 0\.49 m near to the pipeline, its clearance is 0\.50 m"
    ):
        pipeline_work(follow(task, height=0.3, offset=0.39), robot(), place)


def test_a_pipeline_that_is_not_there_is_told(robot, scene, task):
    with pytest.raises(InfeasibleError, match="no pipelines of the context are called 'outfall'"):
        pipeline_work(follow(task), robot(), scene())


@pytest.mark.parametrize("inverted", [False, True])
def test_a_pipeline_under_an_obstacle_is_followed_as_far_as_its_way_is_clear(robot, scene, task, inverted):
    place = scene((40.0, 0.0, 1.0), elements=(PIPE,))
    asked = follow(task, inverted=inverted, startAction="Record", stopAction="Record", deviceId="sonar")
    work = pipeline_work(asked, robot(), place)
    (gap,) = work.gaps
    assert gap.at == (pytest.approx(40.0), 0.0, -18.5)
    assert (gap.line, gap.area) == ("the pipeline", "'block 0'")
    ways = [stroke.points[::-1] if inverted else stroke.points for stroke in work.strokes]
    one, two = ways[::-1] if inverted else ways
    assert one[0] == (10.0, 0.0, -18.5)
    assert one[1] == (pytest.approx(10.0 + gap.begin), 0.0, -18.5)
    assert two[0] == (pytest.approx(10.0 + gap.begin + gap.length), 0.0, -18.5)
    assert two[1:] == ((60.0, 0.0, -18.5), (60.0, 60.0, -24.5))
    for stroke in work.strokes:
        assert stroke.actions[0].at == 0.0
        assert len(stroke.actions) == 2
        refuse_blocked(robot(), place, stroke.points, "a part")


def test_a_pipeline_of_which_nothing_is_left_is_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="nothing is left of the pipeline"):
        pipeline_work(follow(task), robot(), scene((40.0, 30.0, 60.0), elements=(PIPE,)))
