"""What a plan says of what it leaves out."""

from dataclasses import replace

from plain_scenes import box, road, robot, scene

from mmrs_core.planning.planner import plan
from mmrs_core.scene import Coverage, Gap

TWO = (robot("r1"), robot("r2", (20.0, 0.0, 0.0)))


def test_a_plan_names_what_it_leaves_out_of_a_line_once():
    gap = Gap("the line", 40.0, 4.5, (142.2, 0.0, 20.0), "'mast'")
    line = replace(road((100.0, 0.0, 20.0), (140.0, 0.0, 20.0)), gaps=(gap,))
    (left,) = plan(scene(TWO, {"a": line})).left_out
    assert (left.task, left.amount, left.unit, left.at) == ("a", 4.5, "m", gap.at)
    assert left.where == "from 40.0 m along the line, about (142.2, 0.0), too near to 'mast'"


def test_a_plan_names_the_share_of_an_area_that_it_leaves_out():
    west, shell = ((100.0, 0.0), (104.0, 0.0), (104.0, 9.0), (100.0, 9.0)), box("", 100, 0, 110, 9).shell
    covered = Coverage(shell, (), ((west, ()),), 5.0, 0.0)
    work = replace(road((100.0, 0.0, 20.0), (103.0, 0.0, 20.0)), coverage=covered)
    (left,) = plan(scene(TWO, {"a": work}, areas=[box("mast", 107, -5, 112, 15, high=20.0)])).left_out
    assert str(left) == "task 'a' leaves out 54.0 m² about (107.0, 4.5), too near to 'mast'"


def test_a_plan_names_what_closes_in_a_part_that_it_leaves_out():
    walls = [
        box("west", 110, -20, 115, 30),
        box("east", 145, -20, 150, 30),
        box("south", 110, -20, 150, -15),
        box("north", 110, 25, 150, 30),
    ]
    shell, west = box("", 100, 0, 140, 9).shell, ((100.0, 0.0), (104.0, 0.0), (104.0, 9.0), (100.0, 9.0))
    covered = Coverage(shell, (), ((west, ()),), 5.0, 0.0)
    gap = Gap("the line", 40.0, 4.5, (130.0, 0.0, 20.0), "'west', 'east'", closed_in=True)
    work = replace(road((100.0, 0.0, 20.0), (103.0, 0.0, 20.0)), coverage=covered, gaps=(gap,))
    line, beside, inside = map(str, plan(scene(TWO, {"a": work}, areas=walls)).left_out)
    assert line.endswith("about (130.0, 0.0), closed in by 'west', 'east'")
    assert beside.endswith("too near to 'west'")
    assert inside.endswith("closed in by 'west', 'east', 'south', 'north'")
