"""All checks together, and what they let pass."""

from math import nan

import pytest
from checking import given, kind, rover, square, strange

from mmrs_core.analysis.checks import CHECKS
from mmrs_core.analysis.verdicts import Margin, judged, refuses, verify
from mmrs_core.contributions.checks import Check, Status, Verdict
from mmrs_core.testing.small_programs import go, robot


def test_every_check_says_something_of_every_robot_or_of_all():
    found = verify(given(robot("a", [go("m1", (9.0, 0.0, 0.0))]), robot("b", [])), CHECKS)
    for check in CHECKS:
        robots = {verdict.robot for verdict in found if verdict.property == check.name}
        assert robots in ({"a", "b"}, {""})


def test_names_of_checks_are_unique():
    assert len({check.name for check in CHECKS}) == len(CHECKS)


def test_a_check_that_says_nothing_is_recorded_as_not_checked():
    (verdict,) = verify(given(robot("a", [])), [Check("silence", "It is quiet.", lambda input: ())])
    assert (verdict.property, verdict.status) == ("silence", Status.NOT_CHECKED)


def test_every_measure_that_is_safe_has_a_margin_and_a_unit():
    made = given(
        robot("a", [go("m1", (9.0, 0.0, 0.0), speed=2.0)]),
        type=rover(attributes={"communicationRange": 90.0}),
        robot_kind=kind(ceiling=10.0),
        areas=(square(at=(0.0, 50.0)),),
    )
    measured = {"clearance", "altitude", "range", "endurance", "energy", "speed", "payload"}
    found = {verdict.property: verdict for verdict in verify(made, CHECKS)}
    for name in measured:
        verdict = found[name]
        assert verdict.status is Status.SAFE
        assert verdict.margin is not None
        assert verdict.margin >= 0.0
        assert verdict.unit


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_a_margin_that_is_not_a_number_is_never_safe(order):
    margins = [Margin(3.0, 1, "keeps 3 m, 0 m are required"), Margin(nan, 2, "keeps nan m, 0 m are required")]
    made = robot("a", [go("m1", (9.0, 0.0, 0.0)), go("m2", (9.0, 0.0, 0.0))])
    (verdict,) = judged("clearance", made, "m", [margins[index] for index in order])
    assert (verdict.status, verdict.margin, verdict.move) == (Status.UNKNOWN, None, "m2")


def test_a_margin_that_is_not_a_number_hides_no_violation():
    margins = [Margin(nan, None, "keeps nan m"), Margin(-3.0, None, "keeps -3 m")]
    found = judged("clearance", robot("a", []), "m", margins)
    assert [verdict.status for verdict in found] == [Status.VIOLATED, Status.UNKNOWN]


VIOLATED = Verdict("clearance", Status.VIOLATED, "a")
UNKNOWN = Verdict("range", Status.UNKNOWN, "a")
SAFE = Verdict("speed", Status.SAFE, "a")
NOT_CHECKED = Verdict("wind", Status.NOT_CHECKED, "a")


def test_violations_and_unknowns_refuse():
    assert refuses([SAFE, VIOLATED, NOT_CHECKED, UNKNOWN]) == (VIOLATED, UNKNOWN)


def test_an_unknown_passes_only_by_its_own_name():
    assert refuses([UNKNOWN], ("range",)) == ()
    assert refuses([UNKNOWN], ("clearance", "Range", "")) == (UNKNOWN,)


def test_a_violation_cannot_be_accepted():
    assert refuses([VIOLATED], ("clearance",)) == (VIOLATED,)


def test_a_strange_move_refuses_the_behaviour():
    found = verify(given(robot("a", [strange("dig")])), CHECKS)
    assert {verdict.property for verdict in refuses(found)} >= {"states", "endurance", "range"}
