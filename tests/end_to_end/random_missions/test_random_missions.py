"""Random missions through the whole chain: nothing unsafe comes out, nothing solvable is refused."""

from collections import Counter

import pytest
from mission_generator.missions import DEMANDING, sample
from mission_generator.outcome import outcome_of

BATCH = 10
FAST = (25, 28, 29, 31, 33, 34, 36, 37)
"""Solvable missions, others that are planned, and one that is refused: each takes two seconds at most."""


def check(seeds, contributions, tmp_path):
    outcomes = [outcome_of(seed, contributions, tmp_path / str(seed)) for seed in seeds]
    tally = Counter(
        ("solvable, " if outcome.solvable else "wild, ") + ("refused" if outcome.refused else "planned")
        for outcome in outcomes
    )
    print(f"seeds {seeds}: {dict(sorted(tally.items()))}")
    assert {o.seed: o.complaints for o in outcomes if o.complaints} == {}
    assert {o.seed: o.refused for o in outcomes if o.solvable and o.refused} == {}
    return tally


def test_behaviours_pass_and_solvable_missions_are_not_refused(contributions, tmp_path):
    kinds = {"solvable, planned", "wild, planned", "wild, refused"}
    assert check(FAST, contributions, tmp_path).keys() == kinds


@pytest.mark.thorough
@pytest.mark.parametrize("first", [*range(0, 500, BATCH), *range(DEMANDING, DEMANDING + 500, BATCH)])
def test_a_thousand_behaviours_pass_and_solvable_missions_are_not_refused(first, contributions, tmp_path):
    check(range(first, first + BATCH), contributions, tmp_path)


def test_a_plan_whose_charge_barely_suffices_is_safe(contributions, tmp_path):
    outcome = outcome_of(2015, contributions, tmp_path)
    assert (outcome.refused, outcome.complaints) == ("", [])


def test_a_plan_through_corridors_of_which_robots_keep_apart_is_safe(contributions, tmp_path):
    assert sample(122, contributions.languages).context.corridors
    outcome = outcome_of(122, contributions, tmp_path)
    assert (outcome.refused, outcome.complaints, outcome.separation) == ("", [], 8.0)


@pytest.mark.parametrize(
    "seed",
    [
        101050,
        101709,
        103012,
        104827,
        202280,
        295361,
        300112,
        300229,
        310445,
        340099,
        320921,
        603046,
        700133,
        704599,
        706756,
        720530,
    ],
    ids=[
        "quicker than it cruises through a corridor",
        "a relay waits for a robot in a corridor",
        "a robot that may be early waits for another",
        "photos of all but a hundred-thousandth",
        "a robot goes home once it needs no relay",
        "photos by a robot that is not as quick as others",
        "times, a crew and priorities",
        "a choice",
        "a cross hatch by robots of two types",
        "a level on which a robot comes to a task before its time",
        "photos on arms of a choice",
        "a robot whose plan stays the same waits longer for the signal of one that may be late",
        "a robot waits for a time, and for a signal that may come later than that",
        "a cross hatch beside an area",
        "a branch without work that ends in the field, behind a corridor",
        "a way through a corridor and a hop beyond it are one mission, which takes longer",
    ],
)
def test_a_small_mission_is_planned_and_safe(seed, contributions, tmp_path):
    outcome = outcome_of(seed, contributions, tmp_path, (3, 3))
    assert (outcome.refused, outcome.complaints) == ("", [])
    assert min(outcome.coverage.values(), default=1.0) > 1.0 - 1e-6


@pytest.mark.thorough
def test_robots_that_keep_apart_only_in_turns_and_by_signals_are_planned(contributions, tmp_path):
    outcome = outcome_of(300431, contributions, tmp_path, (3, 3))
    assert (outcome.refused, outcome.complaints) == ("", [])


def test_a_deadline_that_is_broken_if_a_condition_holds_is_refused(contributions, tmp_path):
    outcome = outcome_of(707074, contributions, tmp_path, (3, 3))
    late = "task 'task 2' ends 845 s after the start, its deadline is 844.6 s: 1 s late"
    assert outcome.refused == f"{late}; a deadline of 845 s would do"
