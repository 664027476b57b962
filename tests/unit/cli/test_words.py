"""What is said of plans, verdicts and runs is short and complete."""

from dataclasses import replace
from pathlib import Path

import pytest

from mmrs_core.cli.output import table
from mmrs_core.cli.plan_words import plan_lines, plan_summary
from mmrs_core.cli.tree_words import title_of
from mmrs_core.cli.verdict_words import verdict_line, verdict_table, warnings
from mmrs_core.contributions.checks import Status, Verdict
from mmrs_core.languages.registry import MetamodelSource, registry_with

SAFE = Verdict("clearance", Status.SAFE, "Alba", 3.5, "m", "m1", "tower")
SAFER = Verdict("clearance", Status.SAFE, "Brezza", 4.5, "m", "m2", "tower")
BROKEN = Verdict(
    "clearance", Status.VIOLATED, "Brezza", -0.5, "m", "m2", "barn", "Brezza: GoTo 'm2' comes too near"
)
UNKNOWN = Verdict("depth", Status.UNKNOWN, "Alba", message="Alba: water density is missing")


def test_the_robot_of_a_violation_is_named_whether_its_message_does_so_or_not():
    named = "clearance: violated, Brezza: GoTo 'm2' comes too near, margin -0.5 m"
    assert verdict_line(BROKEN) == named
    assert verdict_line(replace(BROKEN, message="GoTo 'm2' comes too near")) == named


def test_a_safe_property_is_one_line_with_its_least_margin():
    assert list(verdict_table([SAFE, SAFER])) == ["  clearance  safe, least margin 3.5 m (Alba, near tower)"]


def test_violations_and_unknowns_are_spelt_out():
    lines = list(verdict_table([SAFE, BROKEN, UNKNOWN]))
    assert lines == [
        "  clearance  violated, least margin -0.5 m (Brezza, near barn)",
        "    - clearance: violated, Brezza: GoTo 'm2' comes too near, margin -0.5 m",
        "  depth      unknown",
        "    - depth: unknown, Alba: water density is missing",
    ]


def test_what_was_not_checked_and_falls_short_is_a_warning_of_a_plan():
    short = Verdict("diversion", Status.NOT_CHECKED, "Alba", message="Alba: no policy", caveat="9 s short")
    assert list(warnings([SAFE, short, replace(short, caveat="")])) == [
        "  warning: diversion: not checked, Alba: no policy; 9 s short"
    ]
    assert list(warnings([short] * 5))[-1] == "  and 2 more warnings: see mmrs check"


def test_a_verdict_without_message_names_robot_move_and_area():
    assert verdict_line(SAFE) == "clearance: safe, Alba, m1, tower, margin 3.5 m"


@pytest.mark.parametrize(
    ("messages", "told"),
    [
        (("no wind", "no wind"), "no wind (a, b)"),
        (("no wind", "wired"), "no wind (a), and 1 more"),
        (["no wind"] * 5, "no wind (a, b, c and 2 more)"),
    ],
)
def test_robots_that_are_not_checked_for_one_reason_are_named_together(messages, told):
    named = zip("abcde", messages, strict=False)
    reasons = [Verdict("wind", Status.NOT_CHECKED, name, message=f"{name}: {why}") for name, why in named]
    assert list(verdict_table(reasons)) == [f"  wind  not checked: {told}"]


def test_what_was_checked_of_some_robots_only_says_both():
    open_ = Verdict("clearance", Status.NOT_CHECKED, "Cirro", message="Cirro: no context")
    said = "  clearance  safe, least margin 3.5 m (Alba, near tower); not checked: no context (Cirro)"
    assert list(verdict_table([SAFE, open_])) == [said]


def test_a_plan_is_told_robot_by_robot(scene, plan):
    lines = list(plan_lines(scene, plan))
    assert lines[0] == "two drones: 3 tasks, 2 active robots, mission time 1:12"
    assert lines[2].split() == ["Alba", "quad", "field", "170", "m", "0:50", "10.0", "Wh", "1"]
    assert lines[3].split()[-3:] == ["not", "known", "1"]
    assert lines[4] == "  note: terrain is taken as flat"


def test_a_plan_is_told_as_values_too(scene, plan):
    told = plan_summary(scene, plan)
    assert told["robots"][0]["tasks"] == ("field",)
    assert [robot["energy"] for robot in told["robots"]] == [36000.0, None]
    assert told["tasks"][1] == {"name": "fork", "begin": 31.0, "end": 31.0}


@pytest.mark.parametrize(
    ("least", "said"),
    [
        (71.0, "1:12 (within 2 % of the best possible)"),
        (72.0, "1:12 (within 0 % of the best possible)"),
        (30.0, "1:12 (at most 2.40 times the best possible)"),
        (0.0, "1:12"),
    ],
)
def test_a_mission_time_is_compared_with_the_least_possible_one(scene, plan, least, said):
    first = next(plan_lines(scene, replace(plan, makespan=72.0, lower_bound=least)))
    assert first.endswith(f"mission time {said}")


def test_a_lower_bound_is_compared_with_the_planned_time_where_the_simulated_one_is_another(scene, plan):
    first = next(plan_lines(scene, replace(plan, makespan=72.0, lower_bound=80.0, planned=100.0)))
    assert first.endswith("mission time 1:12 (planned as 1:40, which is within 25 % of the best possible)")


def test_long_cells_are_cut_but_for_the_last():
    row = "  xxxxxxxxx…  " + "y" * 50
    assert list(table(("a", "b"), [("x" * 50, "y" * 50)], widest=10)) == [f"  a{'b':>12}", row]


def test_line_breaks_in_names_do_not_break_a_table():
    assert list(table(("a",), [("x\ny",)])) == ["  a", "  x y"]


def test_an_element_is_not_called_by_a_character_that_nobody_gave_it():
    ecore = Path(__file__).parents[2] / "fixtures" / "models" / "values.ecore"
    registry = registry_with([MetamodelSource("urn:test:values", ecore, "values")])
    assert title_of(registry.create("urn:test:values", "Value")) == "Value"
    assert title_of(registry.create("urn:test:values", "Value", EChar="x")) == "Value x"
