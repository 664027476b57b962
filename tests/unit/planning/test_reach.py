"""Routes that stay in range of the radio, and what would bring tasks into it, worked out by hand."""

import re
from dataclasses import replace
from itertools import pairwise
from math import dist

import pytest
from plain_scenes import DRONE, box, road, robot, scene, task

from mmrs_core.errors import InfeasibleError, UnreachableError
from mmrs_core.planning.corridors import Corridors
from mmrs_core.planning.paths import Space
from mmrs_core.planning.planner import plan
from mmrs_core.planning.radio_remedies import for_radio, remedies_for
from mmrs_core.planning.reach import reach_of
from mmrs_core.planning.travel import Spaces
from mmrs_core.scene import Corridor, Part, Stroke
from mmrs_core.scene.relays import RELAY, Relay, relays_of

HOME = (0.0, 0.0, 0.0)
HILL = Relay("hill", (90.0, 0.0, 0.0), 100.0)


def one(range=100.0, home=HOME):
    part = Part((), {"communicationRange": range})
    made = robot(home=home)
    return replace(made, type=replace(made.type, part=part))


def reach(*relays, range=100.0, error=0.0):
    found = reach_of(one(range), relays, error)
    assert found is not None
    return found


def remedies(relays, strokes):
    return [words for words, *_ in remedies_for(one(), relays, 0.0, strokes)]


def length(route):
    return sum(dist(a, b) for a, b in pairwise(route))


def test_a_leg_from_ball_to_ball_is_covered_where_both_meet():
    covers = reach(HILL)
    assert covers.contains(((-50.0, 0.0, 0.0), (180.0, 0.0, 0.0)))
    assert not covers.contains(((0.0, 95.0, 0.0), (90.0, 95.0, 0.0)))
    assert not covers.contains(((-50.0, 0.0, 0.0), (191.0, 0.0, 0.0)))
    assert covers.contains((HOME,))
    assert not covers.contains(((0.0, 0.0, 101.0),))


def test_balls_are_smaller_by_the_position_error():
    assert reach(error=5.0).contains(((95.0, 0.0, 0.0),))
    assert not reach(error=5.0).contains(((95.1, 0.0, 0.0),))


def test_a_route_turns_where_two_ranges_meet_and_is_as_short_as_can_be():
    space = Space((), 1.0).within(reach(HILL))
    start, goal = (0.0, 95.0, 0.0), (90.0, 95.0, 0.0)
    route = space.route(start, goal)
    corner = (45.0, (100.0**2 - 45.0**2) ** 0.5, 0.0)
    assert length(route) == pytest.approx(dist(start, corner) + dist(corner, goal), abs=0.02)
    assert space.in_range(route)
    assert Space((), 1.0).route(start, goal) == (start, goal)


def test_a_route_goes_around_an_obstacle_on_the_side_that_is_in_range():
    wall = box("wall", 45.0, 10.0, 55.0, 80.0)
    ends = (20.0, 75.0, 0.0), (60.0, 75.0, 0.0)
    free, held = Space((wall,), 1.0), Space((wall,), 1.0).within(reach())
    beyond, route = free.route(*ends), held.route(*ends)
    assert not held.in_range(beyond)
    assert held.in_range(route)
    assert free.is_clear(route)
    assert length(route) > length(beyond) + 20.0


def test_there_is_no_route_where_an_obstacle_leaves_no_room_in_range():
    wall = box("wall", 40.0, -120.0, 50.0, 120.0)
    with pytest.raises(UnreachableError, match="keeps clear of 'wall' and stays in range of its radio"):
        Space((wall,), 1.0, ceiling=30.0).within(reach()).route(HOME, (80.0, 0.0, 0.0))


def test_ranges_that_meet_at_another_height_only_are_changed_there():
    mast = Relay("mast", (0.0, 0.0, 98.0), 100.0)
    low, high = (99.0, 0.0, 0.0), (95.0, 20.0, 98.0)
    space = Space((), 1.0).within(reach(mast))
    assert not space.in_range((low, high))
    assert space.in_range(space.route(low, high))


def test_the_goal_out_of_range_is_named_with_the_nearest_relay():
    severed = Relay("far", (500.0, 0.0, 0.0), 100.0)
    with pytest.raises(UnreachableError) as refused:
        Space((), 1.0).within(reach(HILL, severed)).route(HOME, (200.0, 0.0, 0.0))
    assert str(refused.value) == (
        "goal (200.0, 0.0, 0.0) is out of range: 110.00 m from relay 'hill' at (200.0, 0.0, 0.0),"
        " its radio reaches 100.00 m; no chain of relays leads home from relay 'far':"
        " it is 410.00 m from relay 'hill', they reach each other within 100.00 m"
    )


def test_a_relay_that_would_do_is_named_with_its_range_and_place():
    strokes = (Stroke(((180.0, 0.0, 0.0), (180.0, 40.0, 0.0))),)
    found = remedies((), strokes)
    assert found == ["a relay of range 93 m at (92, 10, 0)", "a communicationRange of 185 m"]


def test_a_chain_of_relays_is_named_where_one_is_not_enough():
    strokes = (Stroke(((300.0, 0.0, 0.0),)),)
    found = remedies((), strokes)
    assert found == [
        "2 relays of range 100 m at (100, 0, 0) and (200, 0, 0)",
        "a communicationRange of 300 m",
    ]
    chain = (Relay("mast", (100.0, 0.0, 0.0), 100.0),)
    assert remedies(chain, strokes)[0] == "a relay of range 100 m at (200, 0, 0)"


def test_no_chain_is_named_where_three_are_not_enough():
    strokes = (Stroke(((401.0, 0.0, 0.0),)),)
    assert remedies((), strokes) == ["a communicationRange of 401 m"]
    wide = (Stroke(((0.0, 150.0, 0.0), (250.0, 150.0, 0.0))),)
    assert remedies((), wide) == ["a communicationRange of 292 m"]


def in_short(endurance, wanted=None, homes=(HOME,)):
    """Return what is said to help robots of that endurance with a task out of range, and the scene of it."""
    kinematics = replace(DRONE, endurance=endurance, recharge=None)
    team = [replace(one(home=each), name=f"r{i}", kinematics=kinematics) for i, each in enumerate(homes)]
    lines = road((180.0, 0.0, 20.0), (180.0, 40.0, 20.0), cuts=(20.0,))
    whole = scene(team, {"a": lines}, tasks={"a": task("a", wanted=wanted)})
    works = {each.name: lines for each in team}
    return for_radio(replace(whole, works={}), whole.tasks[0], works, team[0], ()), whole


def test_what_brings_a_task_into_range_would_do_where_a_plan_is_then_found():
    words, whole = in_short(1200.0)
    assert (
        words == "; for 'r0', a relay of range 95 m at (93, 10, 0) or a communicationRange of 186 m would do"
    )
    mast = Relay("mast", (93.0, 10.0, 0.0), 95.0)
    assert plan(replace(whole, stations=(mast,))).robots[0].steps
    wide = replace(whole.robots[0], type=one(186.0).type)
    assert plan(replace(whole, robots=(wide,))).robots[0].steps
    with pytest.raises(InfeasibleError):
        plan(whole)


def test_what_brings_a_task_into_range_and_is_not_enough_is_named_with_what_is_short_then():
    words, whole = in_short(30.0)
    found = re.fullmatch(
        r"; with a relay of range 95 m at \(93, 10, 0\), task 'a' is too long for every robot"
        r" \(.* 36 s short\); for 'r0', a lifetime of (\d+) s \(now 38 s\) would do",
        words,
    )
    assert found is not None
    lasting = replace(whole.robots[0], kinematics=replace(DRONE, endurance=0.8 * float(found[1])))
    mast = Relay("mast", (93.0, 10.0, 0.0), 95.0)
    assert plan(replace(whole, robots=(lasting,), stations=(mast,))).robots[0].steps


def test_a_range_that_is_enough_for_one_robot_only_is_not_named_where_two_are_wanted():
    words, _ = in_short(1200.0, 2, (HOME, (20.0, 0.0, 0.0)))
    assert words == "; for 'r0', a relay of range 95 m at (93, 10, 0) would do"
    words, _ = in_short(1200.0, 2, (HOME, (-70.0, 0.0, 0.0)))
    assert words.startswith(
        "; with a relay of range 95 m at (93, 10, 0), task 'a' wants 2 robots, 1 can share"
    )


def test_a_corridor_out_of_range_is_refused_with_the_nearest_station():
    through = Corridor("canyon", ((60.0, 80.0), (120.0, 80.0)), 10.0)
    flying = robot(home=HOME)
    assert flying.kinematics is not None
    made = Corridors([through], "in", flying, flying.kinematics, Space((), 1.0).within(reach()), ())
    assert made.passages(10.0) == []
    assert made.why_not(10.0) == (
        "no corridor leads it in: corridor 'canyon' is out of range:"
        " 144.57 m from home at (120.0, 80.0, 10.0), its radio reaches 100.00 m"
    )


def team(*robots, **features):
    works = {"t": road((50.0, 0.0, 5.0), (60.0, 0.0, 5.0))}
    return Spaces(scene(robots, works, **features))


def test_robots_that_are_in_range_wherever_they_may_go_share_a_space():
    a, b = one(range=500.0), one(range=500.0, home=(5.0, 0.0, 0.0))
    shared = team(a, b)
    assert shared.of(a) is shared.of(b)
    assert shared.of(a).reach is None
    wall = box("wall", 300.0, 0.0, 310.0, 600.0)
    apart = team(a, b, areas=[wall])
    assert apart.of(a) is not apart.of(b)
    assert apart.of(a).anywhere is apart.of(b).anywhere
    assert team(a, transit_altitude=600.0).of(a).reach is not None


def test_relays_of_types_that_plug_ins_add_count_too():
    boat = Part((("urn:boats", "Boat"), RELAY), {"name": "tug", "position": (90.0, 0.0, 0.0), "range": 80.0})
    mooring = Part((("urn:boats", "Mooring"),), {"name": "m", "position": (0.0, 0.0, 0.0), "range": 80.0})
    assert relays_of([mooring, boat]) == (Relay("tug", (90.0, 0.0, 0.0), 80.0),)
