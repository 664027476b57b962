"""Diversions to emergency areas, worked out by hand: robots go 2 m/s, of 1000 s they may use 800 s."""

from dataclasses import replace
from math import hypot, inf

import pytest
from checking import MOVE_KINDS, finding, given, kind, land, recharge, rover, square, take_off, uneven

from mmrs_core.contributions.checks import Status
from mmrs_core.scene import AreaUse
from mmrs_core.testing.small_programs import go, hold, robot

LAUNCHES = {"robot_kind": kind(launches=True)}


def meadow(east, north=0.0):
    return square("meadow", (east, north), 20.0, use=AreaUse.EMERGENCY)


def diverting(*robots, places=((500.0, 0.0),), areas=(), **more):
    """Return the verdict where a policy leads all robots to the middle of a meadow at each place."""
    meadows = tuple(meadow(*each) for each in places)
    points = {each.id: places for each in robots}
    return finding("diversion", given(*robots, areas=(*meadows, *areas), rally_points=points, **more))


def out(*moves):
    return robot("a", [go("out", (100.0, 0.0, 0.0)), *moves])


def test_a_robot_that_no_policy_leads_to_an_emergency_area_is_not_checked():
    verdict = finding("diversion", given(out(), areas=(meadow(9e9),)))
    assert (verdict.status, verdict.message) == (
        Status.NOT_CHECKED,
        "a: no policy leads it to an emergency area",
    )


@pytest.mark.parametrize(
    ("places", "warning"),
    [
        (
            [(1700.5, 0.0)],
            "it would not reach one from everywhere: after Start 'start' it has used up to 0.0 s of one"
            " charge and needs up to 850.2 s from there to emergency area 'meadow', 800.0 s are allowed:"
            " 51 s short",
        ),
        ([(1700.5, 0.0), (500.0, 0.0)], ""),
        ([], "no emergency area has room for it"),
    ],
)
def test_a_robot_that_no_policy_leads_to_areas_out_of_its_reach_has_a_warning(places, warning):
    areas = tuple(meadow(*each) for each in places)
    verdict = finding("diversion", given(out(), areas=areas, unasked_rally_points={"a": tuple(places)}))
    assert (verdict.status, verdict.caveat) == (Status.NOT_CHECKED, warning)


def test_what_is_not_known_of_a_robot_that_no_policy_leads_to_an_area_makes_no_difference():
    homeless = replace(out(), home=None)
    far = {"areas": (meadow(1700.5),), "unasked_rally_points": {"a": ((1700.5, 0.0),)}}
    verdict = finding("diversion", given(homeless, **far))
    assert (verdict.status, verdict.caveat) == (Status.NOT_CHECKED, "")


def test_without_a_context_nothing_is_checked():
    verdict = finding("diversion", given(out(), rally_points={"a": ()}))
    assert (verdict.status, verdict.message) == (Status.NOT_CHECKED, "a: no context was given")


def test_what_is_left_is_the_charge_less_what_is_used_less_the_diversion():
    verdict = diverting(out(hold("h", 30.0)))
    assert (verdict.status, verdict.move) == (Status.SAFE, "h")
    assert verdict.margin == pytest.approx(800.0 - 50.0 - 30.0 - 200.0)


def test_the_farthest_place_counts_not_the_last_one():
    verdict = diverting(out(go("back", (0.0, 0.0, 0.0))), places=((-500.0, 0.0),))
    assert verdict.margin == pytest.approx(800.0 - 100.0 - 250.0)
    verdict = diverting(robot("a", [go("near", (400.0, 0.0, 0.0)), go("off", (-400.0, 0.0, 0.0))]))
    assert (verdict.move, verdict.margin) == ("off", pytest.approx(800.0 - 600.0 - 450.0))


def test_an_area_that_is_too_far_is_a_violation_with_figures():
    verdict = diverting(out(), places=((1700.5, 0.0),))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "start")
    assert verdict.message == (
        "a: after Start 'start' it has used up to 0.0 s of one charge and needs up to 850.2 s from there to"
        " emergency area 'meadow', 800.0 s are allowed: 51 s short"
    )


def test_the_nearest_of_several_areas_counts():
    verdict = diverting(out(), places=((9000.0, 0.0), (140.0, 0.0)))
    assert verdict.margin == pytest.approx(800.0 - 50.0 - 20.0)


def test_the_longest_times_count():
    verdict = diverting(out(), moves=uneven())
    assert verdict.margin == pytest.approx(800.0 - 2.0 * 50.0 - 200.0)


def test_power_against_the_wind_counts():
    windy = kind()
    drawn = replace(windy, kinematics=lambda one, scene: replace(windy.kinematics(one, scene), draw=1.6))
    verdict = diverting(out(), robot_kind=drawn, type=rover(energy=3.6e6))
    assert verdict.margin == pytest.approx(800.0 / 1.6 - 50.0 - 200.0)


def test_landing_counts_and_a_robot_that_has_landed_needs_no_area():
    moves = [take_off("up", 20.0), go("out", (100.0, 0.0, 20.0)), land("down")]
    verdict = diverting(robot("a", moves), **LAUNCHES)
    assert (verdict.status, verdict.move) == (Status.SAFE, "up")
    assert verdict.margin == pytest.approx(800.0 - 10.0 - 250.0 - 10.0)


def test_a_recharge_begins_a_new_charge():
    moves = [go("out", (600.0, 0.0, 0.0)), go("home", (0.0, 0.0, 0.0)), recharge("r", 60.0)]
    verdict = diverting(robot("a", [*moves, go("again", (50.0, 0.0, 0.0))]), places=((0.0, 300.0),))
    assert verdict.margin == pytest.approx(800.0 - 600.0 - 150.0)


def test_a_detour_leads_around_what_is_in_the_way():
    wall = square("wall", (300.0, 0.0), 50.0, distance=9.0)
    verdict = diverting(robot("a", [hold("h", 10.0)]), areas=(wall,))
    least = hypot(250.0, 60.0) + 100.0 + hypot(150.0, 60.0)
    assert verdict.status is Status.SAFE
    assert (800.0 - 10.0 - verdict.margin) * 2.0 == pytest.approx(least, rel=0.02)
    assert (800.0 - 10.0 - verdict.margin) * 2.0 > least - 15.0


def test_a_detour_may_lead_over_what_is_in_the_way():
    wall = square("wall", (250.0, 0.0), 200.0, high=20.0)
    verdict = diverting(
        robot("a", [go("high", (0.0, 0.0, 40.0)), go("low", (0.0, 0.0, 10.0))]), areas=(wall,)
    )
    assert verdict.move == "low"
    assert verdict.margin == pytest.approx(800.0 - (40.0 + 30.0) / 2.0 - (30.0 + 500.0 + 40.0) / 2.0)


def test_a_place_behind_what_is_in_the_way_is_reached_by_the_robots_own_path():
    wall = square("wall", (250.0, 0.0), 50.0)
    around = [go("aside", (250.0, 80.0, 0.0)), go("beyond", (400.0, 80.0, 0.0))]
    verdict = diverting(robot("a", around), areas=(wall,), places=((500.0, 80.0),))
    assert verdict.margin == pytest.approx(800.0 - (hypot(250.0, 80.0) + 150.0 + 100.0) / 2.0)


def test_a_robot_that_is_walled_in_reaches_no_area():
    walls = [square(f"wall{k}", at, 30.0) for k, at in enumerate(((60.0, 0.0), (0.0, 60.0), (-60.0, 0.0)))]
    corners = [square(f"corner{k}", (x, y), 31.0) for k, (x, y) in enumerate(((60.0, 60.0), (-60.0, 60.0)))]
    south = square("south", (0.0, -80.0), 60.0)
    verdict = diverting(robot("a", [hold("h", 1.0)]), areas=(*walls, *corners, south))
    assert (verdict.status, verdict.margin) == (Status.VIOLATED, -inf)
    assert "no clear path to an emergency area was found" in verdict.message


def test_a_rally_point_outside_all_emergency_areas_is_none():
    input = given(out(), areas=(meadow(500.0),), rally_points={"a": ((521.0, 0.0), (519.9, 0.0))})
    narrow = replace(input, rally_points={"a": ((521.0, 0.0),)})
    assert finding("diversion", narrow).status is Status.VIOLATED
    assert "no emergency area has room for it" in finding("diversion", narrow).message


def test_a_wired_robot_is_not_checked():
    verdict = diverting(out(), type=rover(lifetime=None, energy=0.0))
    assert verdict.status is Status.NOT_CHECKED


def test_a_move_of_unknown_kind_leaves_it_unknown():
    moves = {name: each for name, each in MOVE_KINDS.items() if name[1] != "HoldPosition"}
    assert diverting(out(hold("h", 1.0)), moves=moves).status is Status.UNKNOWN
