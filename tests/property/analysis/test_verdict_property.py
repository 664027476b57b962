"""Laws of the checks: what a change of the scene does to the margins."""

from dataclasses import replace

import pytest
from checking import findings, given, rover, square
from hypothesis import given as for_all
from hypothesis import settings
from hypothesis import strategies as st

from mmrs_core.contributions.checks import Status
from mmrs_core.testing.small_programs import go, hold, notify, robot

LENGTHS = st.floats(-40.0, 40.0).map(lambda x: round(x, 2))
POINTS = st.tuples(LENGTHS, LENGTHS, LENGTHS)
SIZES = st.floats(0.5, 5.0).map(lambda x: round(x, 2))


@st.composite
def areas(draw):
    at = (draw(LENGTHS), draw(LENGTHS))
    low = draw(LENGTHS)
    return square("area", at=at, half=draw(SIZES), low=low, high=low + draw(SIZES), distance=draw(SIZES))


def smallest(points, area, **more):
    made = robot("a", [go(f"m{i}", point) for i, point in enumerate(points)], home=points[0])
    (verdict,) = findings("clearance", given(made, areas=(area,), **more))
    return verdict


@settings(max_examples=60, deadline=None)
@for_all(st.lists(POINTS, min_size=1, max_size=5), areas(), SIZES)
def test_a_larger_safety_distance_lowers_the_margin_by_as_much(points, area, more):
    before = smallest(points, area)
    after = smallest(points, replace(area, safety_distance=area.safety_distance + more))
    assert after.margin == pytest.approx(before.margin - more, abs=1e-9)


@settings(max_examples=60, deadline=None)
@for_all(st.lists(POINTS, min_size=1, max_size=5), areas(), SIZES)
def test_a_position_error_lowers_the_margin_by_as_much(points, area, error):
    before = smallest(points, area)
    after = smallest(points, area, position_error=error)
    assert after.margin == pytest.approx(before.margin - error, abs=1e-9)


@settings(max_examples=60, deadline=None)
@for_all(st.lists(POINTS, min_size=1, max_size=5), areas())
def test_a_margin_below_zero_is_violated_and_no_other(points, area):
    verdict = smallest(points, area)
    assert verdict.status is (Status.VIOLATED if verdict.margin < -1e-6 else Status.SAFE)


@settings(max_examples=40, deadline=None)
@for_all(st.lists(POINTS, min_size=1, max_size=4), st.lists(areas(), min_size=1, max_size=5))
def test_the_smallest_margin_is_that_of_the_worst_area_alone(points, several):
    made = robot("a", [go(f"m{i}", point) for i, point in enumerate(points)], home=points[0])
    named = tuple(replace(area, name=f"area {i}") for i, area in enumerate(several))
    together = findings("clearance", given(made, areas=named))
    alone = [smallest(points, area).margin for area in named]
    assert together[0].margin == pytest.approx(min(alone), abs=1e-9)
    violated = {verdict.area for verdict in together if verdict.status is Status.VIOLATED}
    assert violated == {area.name for area, margin in zip(named, alone, strict=True) if margin < -1e-6}


@settings(max_examples=60, deadline=None)
@for_all(st.lists(st.floats(0.0, 100.0), min_size=1, max_size=6), st.floats(0.0, 100.0))
def test_a_longer_hold_lowers_the_endurance_by_as_much(seconds, more):
    def margin(durations):
        made = robot("a", [hold(f"h{i}", each) for i, each in enumerate(durations)])
        return findings("endurance", given(made))[0].margin

    assert margin([*seconds[:-1], seconds[-1] + more]) == pytest.approx(margin(seconds) - more, abs=1e-6)


@st.composite
def chains(draw):
    """Draw robots each of which waits for the one before it, after so many moves."""
    number = draw(st.integers(2, 5))
    made = []
    for i in range(number):
        names = [f"m{j}" for j in range(draw(st.integers(1, 4)))]
        tell = (notify(f"r{i + 1}.go"),) if i + 1 < number else ()
        at = draw(st.sampled_from(names))
        moves = [hold(name, draw(st.floats(1, 9)), after=tell if name == names[-1] else ()) for name in names]
        made.append(robot(f"r{i}", moves, waits={at: ["go"]} if i else {}))
    return made


@settings(max_examples=60, deadline=None)
@for_all(chains(), st.data())
def test_leaving_out_one_notify_strands_all_that_wait_behind_it(chain, data):
    cut = data.draw(st.integers(0, len(chain) - 2))
    moves = tuple(replace(move, after=()) for move in chain[cut].moves)
    mutant = [*chain[:cut], replace(chain[cut], moves=moves), *chain[cut + 1 :]]
    assert findings("synchronisation", given(*chain))[0].status is Status.SAFE
    found = findings("synchronisation", given(*mutant))
    stuck = [verdict for verdict in found if verdict.status is Status.VIOLATED]
    assert [verdict.robot for verdict in stuck] == behind(chain, cut + 1)
    # those before the cut share no slots with those behind it, and are judged apart
    assert [verdict.status for verdict in found if verdict not in stuck] == [Status.SAFE] * (cut > 0)


def behind(chain, first):
    """Return who is stuck if that robot is: those after it, up to one that has told before it waits."""
    stuck = []
    for each in chain[first:]:
        stuck.append(each.id)
        last = len(each.moves) - 2
        if each.transitions[last].waits:
            break
    return stuck


@settings(max_examples=60, deadline=None)
@for_all(chains(), st.data())
def test_a_notify_turned_round_strands_the_robot_that_it_was_for(chain, data):
    cut = data.draw(st.integers(0, len(chain) - 2))
    moves = tuple(
        replace(move, after=tuple(replace(action, active=False) for action in move.after))
        for move in chain[cut].moves
    )
    mutant = [*chain[:cut], replace(chain[cut], moves=moves), *chain[cut + 1 :]]
    found = findings("synchronisation", given(*mutant))
    assert (Status.VIOLATED, f"r{cut + 1}") in [(verdict.status, verdict.robot) for verdict in found]


@st.composite
def fleets(draw):
    """Draw robots that each go to some places in a field of their own, 1000 m from the next."""
    made = []
    for i in range(draw(st.integers(1, 4))):
        places = draw(st.lists(POINTS, min_size=1, max_size=5))
        moves = [go(f"m{j}", (e + 1000.0 * i, n, up)) for j, (e, n, up) in enumerate(places)]
        made.append(robot(f"r{i}", moves, home=(1000.0 * i, 0.0, 0.0)))
    return made


@settings(max_examples=60, deadline=None)
@for_all(fleets(), st.data())
def test_an_area_put_around_a_waypoint_is_violated_by_that_robot_alone(fleet, data):
    culprit = data.draw(st.sampled_from(fleet))
    move = data.draw(st.sampled_from([move for move in culprit.moves if move.target]))
    e, n, up = move.target.position
    area = square("trap", at=(e, n), half=2.0, low=up - 1.0, high=up + 1.0)
    found = findings("clearance", given(*fleet, areas=(area,)))
    violated = [verdict for verdict in found if verdict.status is Status.VIOLATED]
    assert [(verdict.robot, verdict.area) for verdict in violated] == [(culprit.id, "trap")]
    assert violated[0].margin == pytest.approx(-0.5)
    assert {verdict.robot for verdict in found} == {each.id for each in fleet}


@settings(max_examples=60, deadline=None)
@for_all(fleets(), st.floats(0.01, 0.99))
def test_a_lifetime_shorter_than_a_robot_needs_is_violated_by_the_robots_that_need_more(fleet, part):
    needed = [800.0 - verdict.margin for verdict in findings("endurance", given(*fleet))]
    enough = part * max(needed) / 0.8
    found = findings("endurance", given(*fleet, type=rover(lifetime=enough)))
    short = {verdict.robot for verdict in found if verdict.status is Status.VIOLATED}
    assert short == {each.id for each, use in zip(fleet, needed, strict=True) if use > 0.8 * enough + 1e-3}
