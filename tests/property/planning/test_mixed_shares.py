"""Robots of different sorts share random areas: together they cover what one of them would."""

import numpy as np
import pytest
from plain_scenes import DRONE, box, field_work, robot, scene, task, with_kinematics
from plan_replay import complaints, flat

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Serve


def fields(seed, sorts):
    """Return a scene in which every robot has to share one area, with a work of its own."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(5, 10))
    angles = (np.arange(count) + rng.uniform(0.0, 0.8, count)) * 2 * np.pi / count
    rim = rng.uniform(80.0, 150.0, (count, 1)) * np.column_stack([np.cos(angles), np.sin(angles)]) + 200.0
    shell = tuple((east, north) for east, north in rim.tolist())
    corners = rng.uniform(120.0, 260.0, (int(rng.integers(0, 3)), 2))
    areas = [
        box(f"area {k}", *at, *(at + rng.uniform(5.0, 30.0, 2))) for k, at in enumerate(corners.tolist())
    ]
    team, works = [], {}
    for k in range(sorts):
        each = robot(f"r{k}", (15.0 * k, 0.0, 0.0), kinematics=DRONE, clearance=float(rng.uniform(0.3, 3.0)))
        speed = float(rng.uniform(4.0, 15.0))
        team.append(with_kinematics(each, cruise=speed, endurance=float(rng.choice([400.0, 2000.0]))))
        width, length = float(rng.uniform(8.0, 30.0)), float(rng.choice([0.0, rng.uniform(8.0, 30.0)]))
        own, up = scene(team[-1:], {}, areas=areas), float(rng.choice([20.0, 25.0]))
        works[each.name] = field_work(own, shell, altitude=up, width=width, length=length)
    return scene(team, {"a": works}, areas=areas, tasks={"a": task("a", wanted=sorts)})


def shares(found):
    return {each.robot: any(isinstance(step, Serve) for step in flat(each.steps)) for each in found.robots}


def check(seed, sorts):
    try:
        whole = fields(seed, sorts)
        found = plan(whole)
    except InfeasibleError:
        return False
    assert all(shares(found).values())
    assert complaints(whole, found) == []
    return True


@pytest.mark.parametrize(("seed", "sorts"), [(0, 2), (1, 5)])
def test_sorts_of_robots_cover_a_random_area(seed, sorts):
    assert check(seed, sorts)


@pytest.mark.thorough
def test_three_sorts_of_robots_cover_a_random_area():
    assert check(5, 3)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [2, 3, *range(10, 210)])
def test_sorts_of_robots_cover_many_random_areas(seed):
    check(seed, 2 + seed % 2)
