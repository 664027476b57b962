"""Work along lines that areas block in part."""

from math import inf

import pytest
from plain_scenes import box, photo, robot, scene
from sound_plans import sound

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.open_lines import work_along
from mmrs_core.planning.positions import refuse_blocked
from mmrs_core.scene import Stroke

SPANS = [(f"span {n}", ((100.0 * n, 50.0, 20.0), (100.0 * n + 100.0, 50.0, 20.0))) for n in range(3)]


def along(whole, **features):
    return work_along(
        whole,
        whole.robots[0],
        SPANS,
        lambda name, line: Stroke(line, (photo(0.0),)),
        rule="wires",
        **features,
    )


def test_a_line_that_nothing_blocks_is_one_stroke():
    work = along(scene([robot()], {}), ordered=False)
    assert [(each.part, each.points, each.stretch) for each in work.strokes] == [
        (name, line, (0.0, 100.0)) for name, line in SPANS
    ]
    assert (work.gaps, work.rule, work.divisible, work.ordered) == ((), "wires", True, False)


def test_what_is_too_near_to_an_area_is_left_out_and_told():
    """A tree beside one span splits it; the others are done whole."""
    whole = scene([robot()], {}, areas=[box("tree", 140.0, 48.0, 150.0, 52.0, high=inf)])
    work = along(whole)
    (gap,) = work.gaps
    assert (gap.line, gap.area, gap.closed_in) == ("span 1", "'tree'", False)
    assert gap.begin == pytest.approx(40.0 - 3.0, abs=0.1)
    assert gap.length == pytest.approx(10.0 + 2 * 3.0, abs=0.1)
    assert [each.part for each in work.strokes] == ["span 0", "span 1", "span 1", "span 2"]
    for stroke in work.strokes:
        refuse_blocked(whole.robots[0], whole, stroke.points, "a part")
        assert stroke.actions == (photo(0.0),)
    sound(scene(whole.robots, {"wires": work}, areas=whole.areas))


def test_lines_of_which_nothing_is_left_are_refused_with_what_is_too_near():
    whole = scene([robot()], {}, areas=[box("wood", -50.0, 0.0, 350.0, 100.0)])
    with pytest.raises(InfeasibleError, match=r"nothing is left of span 0: it is too near to 'wood'"):
        along(whole)
