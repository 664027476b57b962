"""The check of radio range with relays, worked out by hand: the robot's radio reaches 100 m."""

from math import hypot

import pytest
from checking import finding, given, rover

from mmrs_core.analysis.radio import RANGE
from mmrs_core.contributions.checks import Status
from mmrs_core.diagnostics import Place
from mmrs_core.scene import Part
from mmrs_core.scene.relays import RELAY
from mmrs_core.testing.small_programs import go, robot

RADIO = rover(attributes={"communicationRange": 100.0})


def relay(name, at, range):
    return Part((RELAY,), {"name": name, "position": at, "range": range}, Place(path="//@elements.0"))


def judged(*places, relays=(), **more):
    moves = [go(f"m{i}", place) for i, place in enumerate(places)]
    return finding("range", given(robot("a", moves), type=RADIO, elements=relays, **more))


def test_a_relay_passes_on_what_home_does_not_reach():
    assert judged((180.0, 0.0, 0.0)).margin == pytest.approx(-80.0)
    verdict = judged((180.0, 0.0, 0.0), relays=[relay("hill", (95.0, 0.0, 0.0), 100.0)])
    assert (verdict.status, verdict.move, verdict.caveat) == (Status.SAFE, "m0", "")
    assert verdict.margin == pytest.approx(15.0)
    assert verdict.message == (
        "a: GoTo 'm0' leads 85.00 m away from relay 'hill' at (180.0, 0.0, 0.0), the radio reaches 100.00 m"
    )


def test_a_robot_and_a_relay_reach_each_other_within_the_smaller_range():
    small = judged((180.0, 0.0, 0.0), relays=[relay("hill", (80.0, 0.0, 0.0), 80.0)])
    assert small.margin == pytest.approx(80.0 - 100.0)
    large = judged((180.0, 0.0, 0.0), relays=[relay("hill", (80.0, 0.0, 0.0), 900.0)])
    assert large.margin == pytest.approx(0.0)


def test_the_worst_place_is_found_in_the_middle_of_a_move_though_both_ends_are_in_range():
    path = (0.0, 90.0, 0.0), (100.0, 90.0, 0.0)
    verdict = judged(*path, relays=[relay("hill", (100.0, 0.0, 0.0), 100.0)])
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "m1")
    assert verdict.margin == pytest.approx(100.0 - hypot(50.0, 90.0))
    assert "at (50.0, 90.0, 0.0)" in verdict.message


def test_a_relay_without_a_chain_counts_for_nothing_and_is_named():
    relays = [relay("near", (90.0, 0.0, 0.0), 100.0), relay("far", (150.0, 0.0, 0.0), 55.0)]
    verdict = judged((50.0, 0.0, 0.0), relays=relays)
    assert verdict.status is Status.SAFE
    assert verdict.caveat == (
        "relay 'far' is left out: it is 60.00 m from relay 'near', they reach each other within 55.00 m"
    )
    assert judged((199.0, 0.0, 0.0), relays=relays).margin == pytest.approx(-9.0)


def test_chains_lead_over_several_relays_in_any_order():
    chain = [relay(f"r{i}", (90.0 * i, 0.0, 0.0), 95.0) for i in (3, 1, 2)]
    assert judged((350.0, 0.0, 0.0), relays=chain).margin == pytest.approx(15.0)
    assert judged((350.0, 0.0, 0.0), relays=chain[::2]).margin == pytest.approx(-250.0)


def test_a_position_error_is_taken_off_every_range():
    relays = [relay("hill", (95.0, 0.0, 0.0), 100.0)]
    assert judged((180.0, 0.0, 0.0), relays=relays, position_error=16.0).margin == pytest.approx(-1.0)


def test_the_check_has_a_hint_that_names_relays():
    assert "relay" in RANGE.hint
