"""Robots come from home to their tasks, and go back, through corridors."""

from dataclasses import replace

import pytest
from plain_scenes import CRAWLER, box, road, robot, scene, task, visit, with_kinematics
from plan_replay import complaints, flat

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.corridors import gone_through
from mmrs_core.planning.explaining import explain
from mmrs_core.planning.planner import plan
from mmrs_core.planning.team import Team
from mmrs_core.scene import AreaUse, Corridor, Launch, Recharge, Transit
from mmrs_runtime.policies import Policy

NORTH = Corridor("north gate", ((0.0, 100.0), (100.0, 100.0)), 10.0)
SOUTH = Corridor("south gate", ((0.0, -150.0), (100.0, -150.0)), 10.0)
SPOT = visit((300.0, 0.0, 20.0))


def sound(whole, **options):
    found = plan(whole, **options)
    assert complaints(whole, found) == []
    return found


def through(whole, found, number=0):
    return gone_through(flat(found.robots[number].steps), whole.corridors)


def reason(whole):
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    (words,) = caught.value.reasons
    return words


def errand(*corridors, work=SPOT, team=None, **features):
    return scene(team or (robot(),), {"a": work}, corridors=corridors, **features)


def test_a_sortie_leads_in_and_out_through_the_corridor_that_costs_least():
    whole = errand(NORTH, SOUTH)
    assert through(whole, sound(whole)) == {"in": ["north gate"], "out": ["north gate"]}
    free, one, other = (plan(errand(*each)).makespan for each in ((), (NORTH,), (SOUTH,)))
    assert free < one < other
    assert plan(whole).makespan == one


def test_ways_in_and_out_are_chosen_each_for_itself():
    whole = errand(NORTH, SOUTH, work=road((300.0, 300.0, 20.0), (300.0, -400.0, 20.0)))
    found = through(whole, sound(whole))
    assert sorted((*found["in"], *found["out"])) == ["north gate", "south gate"]


@pytest.mark.parametrize(("use", "there", "back"), [("ENTRY", 1, 0), ("EXIT", 0, 1)])
def test_the_other_direction_of_a_one_way_corridor_is_free(use, there, back):
    whole = errand(replace(NORTH, use=use))
    found = through(whole, sound(whole))
    assert (len(found["in"]), len(found["out"])) == (there, back)


def test_every_sortie_leads_through_corridors_and_batteries_must_last_for_that():
    folded = road(
        *((300.0 + 200.0 * (k % 2), 20.0 * (k // 2), 20.0) for k in range(12)), cuts=range(100, 2200, 100)
    )
    team = (with_kinematics(robot(), endurance=180.0, energy=1e9),)
    whole = errand(NORTH, work=folded, team=team)
    found = sound(whole)
    sorties = [step for step in found.robots[0].steps if isinstance(step, Launch)]
    assert len(sorties) > len(
        [step for step in plan(errand(work=folded, team=team)).robots[0].steps if isinstance(step, Launch)]
    )
    assert any(isinstance(step, Recharge) for step in found.robots[0].steps)


def test_between_tasks_robots_are_free():
    whole = scene((robot(),), {"a": SPOT, "b": visit((300.0, 50.0, 20.0))}, corridors=(NORTH,))
    entries = [
        step
        for step in sound(whole).robots[0].steps
        if isinstance(step, Transit) and gone_through((step,), whole.corridors)["in"]
    ]
    assert len(entries) == 1


def test_a_robot_goes_through_at_a_height_of_the_corridor():
    whole = errand(replace(NORTH, low=40.0, high=50.0))
    steps = sound(whole).robots[0].steps
    heights = {
        point[2] for step in steps if isinstance(step, Transit) for point in step.route if point[1] == 100.0
    }
    assert heights == {41.0}


def test_a_transit_altitude_is_kept_where_the_corridor_allows_it():
    whole = errand(replace(NORTH, low=40.0, high=80.0), transit_altitude=60.0)
    route = next(step.route for step in sound(whole).robots[0].steps if isinstance(step, Transit))
    assert {point[2] for point in route[:-1]} == {60.0}


def test_robots_of_other_types_go_where_they_like():
    whole = errand(replace(NORTH, types=frozenset({"rover"})))
    assert through(whole, sound(whole)) == {"in": [], "out": []}


def test_a_robot_that_stays_in_the_field_needs_no_way_out():
    whole = errand(NORTH, team=(with_kinematics(robot(returns=False), recharge=None),))
    assert through(whole, sound(whole)) == {"in": ["north gate"], "out": []}


def test_a_robot_on_the_ground_drives_through():
    team = (robot(kinematics=CRAWLER),)
    whole = errand(NORTH, work=visit((300.0, 0.0, 0.0)), team=team)
    assert through(whole, sound(whole)) == {"in": ["north gate"], "out": ["north gate"]}


def test_a_task_beside_home_is_reached_by_the_corridor_too():
    whole = errand(NORTH, work=visit((0.0, 0.0, 20.0)))
    assert through(whole, sound(whole)) == {"in": ["north gate"], "out": ["north gate"]}


def test_a_corridor_leads_over_an_obstacle_in_it():
    shed = box("shed", 40.0, 95.0, 60.0, 105.0, low=0.0, high=30.0)
    whole = errand(NORTH, areas=(shed,))
    route = next(step.route for step in sound(whole).robots[0].steps if isinstance(step, Transit))
    assert {point[2] for point in route if point[1] == 100.0} == {33.001}


def test_of_two_corridors_one_that_is_blocked_is_not_taken():
    wall = box("wall", 40.0, 95.0, 60.0, 105.0)
    whole = errand(NORTH, SOUTH, areas=(wall,))
    assert through(whole, sound(whole)) == {"in": ["south gate"], "out": ["south gate"]}


@pytest.mark.parametrize(
    ("corridor", "areas", "fault", "remedy"),
    [
        (
            replace(NORTH, width=1.2),
            (),
            "is 1.20 m wide, 2.00 m are needed: 0.80 m too narrow",
            "for 'r1' a width of 2 m of corridor 'north gate'",
        ),
        (
            replace(NORTH, low=30.0, high=31.0),
            (),
            "is 1.00 m high, 2.00 m are needed: 1.00 m too low",
            "for 'r1' a minHeight of 29 m of corridor 'north gate'",
        ),
        (
            replace(NORTH, low=150.0),
            (),
            "begins 151 m up for it, it may go up to 120 m: 31.0 m short",
            "for 'r1' a minHeight of 119 m of corridor 'north gate'",
        ),
        (
            replace(NORTH, width=1.2, low=30.0, high=31.0),
            (),
            "is 1.20 m wide, 2.00 m are needed: 0.80 m too narrow",
            "for 'r1' a width of 2 m and a minHeight of 29 m of corridor 'north gate'",
        ),
        (
            NORTH,
            (box("wall", 40.0, 102.0, 60.0, 105.0),),
            "is blocked by 'wall': 1.00 m too near to its line",
            "for 'r1' a passage through 'wall'",
        ),
    ],
)
def test_a_corridor_that_no_robot_can_use_is_refused_by_name_and_by_how_much(corridor, areas, fault, remedy):
    begin = "task 'a' can be reached by no robot (r1: no corridor leads it in: corridor 'north gate'"
    assert reason(errand(corridor, areas=areas)) == f"{begin} {fault}); {remedy} would do"


def test_robots_are_chosen_by_their_ways_through_corridors():
    team = (robot("r1", (250.0, 0.0, 0.0)), robot("r2", (0.0, 90.0, 0.0)))
    found = sound(errand(NORTH, team=team))
    assert not found.robots[0].steps
    assert sound(errand(team=team)).robots[0].steps


def test_many_robots_and_tasks_are_planned_through_corridors():
    team = tuple(robot(f"r{i}", (10.0 * i, 0.0, 0.0)) for i in range(8))
    works = {f"t{i}": visit((200.0 + 37.0 * (i % 9), 41.0 * (i // 9), 20.0)) for i in range(40)}
    whole = scene(team, works, corridors=(NORTH, SOUTH))
    sound(whole)


def test_robots_keep_apart_in_a_corridor_with_two_directions():
    team = (robot("r1"), robot("r2", (20.0, 0.0, 0.0)))
    works = {"a": SPOT, "b": visit((300.0, 60.0, 20.0))}
    whole = scene(
        team,
        works,
        corridors=(replace(NORTH, low=19.0, high=21.0),),
        minimum_separation=5.0,
        tasks={"a": task("a"), "b": task("b")},
    )
    sound(whole)


def test_an_explanation_says_what_corridors_cost():
    whole = errand(NORTH)
    found = plan(whole)
    (limit,) = (each for each in explain(whole, found).limits if each.name == "corridors")
    assert limit.cost == pytest.approx(found.makespan - plan(errand()).makespan)
    assert limit.margin == "'r1' comes in through 'north gate'; 'r1' goes out through 'north gate'"


def test_a_diversion_may_begin_as_high_above_home_as_a_corridor_ends():
    escapes = (Policy("LINK_LOST", "EMERGENCY_AREA"),)
    meadow = box("meadow", -200.0, -20.0, -160.0, 20.0, use=AreaUse.EMERGENCY)
    free, high = (
        Team(errand(*each, areas=(meadow,), policies=escapes)).pilots["r1"].diversions
        for each in ((), (replace(NORTH, low=80.0),))
    )
    assert {*high.travel.above_home((20.0,))} - {*free.travel.above_home((20.0,))} == {(0.0, 0.0, 81.0)}


def test_a_task_after_one_that_no_robot_can_do_is_refused_with_it():
    far = {"a": visit((300.0, 0.0, 500.0)), "b": visit((9e4, 0.0, 20.0))}
    whole = scene((robot(),), far, after=(("a", "b"),))
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    assert [words.split(" (")[0] for words in caught.value.reasons] == [
        "task 'a' can be done by no robot",
        "task 'b' is too long for every robot",
    ]
