"""Plans of random scenes, carried out step by step by code that shares nothing with planning."""

import pytest
from plain_scenes import DRONE, field_work, robot, scene
from plan_replay import complaints
from random_scenes import random_scene

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan


def check(seed):
    """Return whether a random scene has a plan, which can be carried out."""
    whole = random_scene(seed)
    try:
        found = plan(whole, seed=seed)
    except InfeasibleError:
        return False
    assert complaints(whole, found) == []
    return True


@pytest.mark.parametrize("seed", [1, 3, 4, 6, 9, *range(20, 24)])
def test_a_random_plan_can_be_carried_out(seed):
    assert check(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [0, 2, 5, 7, 8, 24, *range(40, 440)])
def test_many_random_plans_can_be_carried_out(seed):
    check(seed)


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_more_robots_are_never_later(count):
    """The makespan of a shared field comes near to an even division of the work."""
    team = tuple(robot(f"r{k}", (15.0 * k, 0.0, 0.0), kinematics=DRONE) for k in range(count))
    shell = ((0.0, 50.0), (300.0, 50.0), (300.0, 300.0), (0.0, 300.0))
    works = {"a": field_work(scene(team, {}), shell, width=12.0)}
    alone = plan(scene(team[:1], works)).makespan
    assert plan(scene(team, works)).makespan <= alone / count + 80.0
