"""Tasks that leave open how many robots they want are done no later than with any number asked for."""

from dataclasses import replace

import pytest
from random_scenes import random_scene

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan


def asking(whole, name, count):
    tasks = tuple(replace(each, wanted=count) if each.name == name else each for each in whole.tasks)
    return replace(whole, tasks=tasks)


def makespan(whole, seed):
    try:
        return plan(whole, seed=seed).makespan
    except InfeasibleError:
        return float("inf")


def worst(whole, seed):
    """Return by how many seconds some number that is asked for makes the mission end sooner."""
    open_to_choice = makespan(whole, seed)
    names = [each.name for each in whole.tasks if (each.name, whole.robots[0].name) in whole.works]
    asked = [
        makespan(asking(whole, name, count), seed)
        for name in names
        for count in range(1, len(whole.robots) + 1)
    ]
    return max((open_to_choice - each for each in asked if each < float("inf")), default=0.0)


@pytest.mark.parametrize("seed", [63, pytest.param(68, marks=pytest.mark.thorough)])
def test_no_number_that_is_asked_for_ends_a_random_mission_sooner(seed):
    assert worst(random_scene(seed), seed) <= 1e-3
