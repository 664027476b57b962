"""In random plans, robots have enough left from where each step ends to fly straight to an emergency area."""

from dataclasses import replace
from math import dist

import numpy as np
import pytest
from plain_scenes import box
from plan_replay import complaints
from random_scenes import random_scene

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan
from mmrs_core.scene import AreaUse, Branch, Launch, Recover, Serve, Transit
from mmrs_runtime.policies import Policy


def escaping(seed):
    """Return a random scene with one large emergency area, to which robots go when a link is lost."""
    east, north = np.random.default_rng(seed).uniform(-900.0, 900.0, 2).tolist()
    area = box("meadow", east, north, east + 80.0, north + 80.0, use=AreaUse.EMERGENCY)
    whole = random_scene(seed)
    escapes = (Policy("LINK_LOST", "EMERGENCY_AREA"), *whole.policies)
    return replace(whole, areas=(*whole.areas, area), policies=escapes), (east + 40.0, north + 40.0)


def least_left(whole, found, middle):
    """Return the fewest seconds that any robot has left over a straight flight to the area's nearest side."""
    left = []
    robots = {each.name: each for each in whole.robots}
    for each in found.robots:
        kinematics, launched = robots[each.robot].kinematics, 0.0
        for step, place in places(each.steps):
            launched = step.begin if isinstance(step, Launch) else launched
            away = max(0.0, dist(place[:2], middle) - 57.0) / kinematics.cruise
            diversion = away + place[2] / kinematics.descent
            left.append(kinematics.endurance - (step.end - launched) - diversion)
    return min(left)


def places(steps):
    """Yield the steps that end in the air, with where they do."""
    here = None
    for step in steps:
        match step:
            case Launch():
                here = (*step.at[:2], step.up)
            case Recover():
                here = None
            case Branch():
                here = step.exit
            case Transit():
                here = step.route[-1]
            case Serve():
                here = step.stroke.points[-1]
        if here is not None:
            yield step, here


def check(seed):
    whole, middle = escaping(seed)
    try:
        found = plan(whole, seed=seed)
    except InfeasibleError:
        return False
    assert complaints(whole, found) == []
    assert least_left(whole, found, middle) >= -1e-6
    return True


@pytest.mark.parametrize("seed", [1, 3, 8])
def test_a_random_plan_leaves_enough_for_diversions(seed):
    assert check(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [21, *range(30, 130)])
def test_many_random_plans_leave_enough_for_diversions(seed):
    check(seed)
