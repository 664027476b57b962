"""Plans of random scenes, carried out step by step by code that shares nothing with planning."""

import numpy as np
import pytest
from plain_scenes import (
    DRONE,
    box,
    control,
    field_work,
    photo,
    road,
    robot,
    scene,
    task,
    visit,
    with_kinematics,
)
from plan_replay import complaints

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan


def areas(rng):
    for k in range(int(rng.integers(0, 6))):
        east, north = rng.uniform(-150, 350, 2)
        wide, deep = rng.uniform(5, 60, 2)
        if east + wide > -40 and east < 120 and north < 40 and north + deep > -40:
            continue
        high = float(rng.choice([10.0, 25.0, np.inf]))
        yield box(
            f"area {k}", east, north, east + wide, north + deep, high=high, safety=float(rng.uniform(0, 5))
        )


def work(rng, whole):
    kind = rng.integers(0, 4)
    east, north = (float(value) for value in rng.uniform(-100, 300, 2))
    up = float(rng.choice([15.0, 30.0]))
    if kind == 0:
        return visit((east, north, up), hold=float(rng.uniform(0, 20)))
    if kind == 1:
        line = ((east, north, up), (east + 80.0, north, up), (east + 80.0, north + 60.0, up))
        return road(*line, cuts=(20.0, 60.0, 100.0), actions=(photo(5.0), photo(80.0), photo(130.0)))
    shell = ((east, north), (east + 120.0, north), (east + 100.0, north + 90.0), (east + 40.0, north + 110.0))
    return field_work(whole, shell, altitude=up, width=15.0, length=15.0 if kind == 2 else 0.0)


def order(rng, names):
    pairs = [(one, two) for i, one in enumerate(names) for two in names[i + 1 :] if rng.random() < 0.25]
    if len(names) < 4 or rng.random() < 0.5:
        return pairs, ()
    first, *middle, last = names
    condition = ("windy",) if rng.random() < 0.5 else ()
    forked = [(first, "fork"), ("fork", middle[0], *condition), *(("fork", name) for name in middle[1:2])]
    forked += [(name, "join") for name in middle[:2]] + [("join", last)]
    return forked, (control("fork", "Fork"), control("join", "Join"))


def random_scene(seed):
    rng = np.random.default_rng(seed)
    team = []
    for k in range(int(rng.integers(1, 5))):
        endurance = float(rng.choice([200.0, 400.0, 2000.0]))
        each = robot(f"r{k}", (25.0 * k, 0.0, 0.0), returns=bool(rng.random() < 0.9))
        figures = {
            "endurance": endurance,
            "recharge": [60.0, None][int(rng.random() < 0.15)],
            "acceleration": float(rng.choice([0.5, 3.0, np.inf])),
        }
        team.append(with_kinematics(each, **figures))
    empty = scene(team, {}, areas=tuple(areas(rng)))
    names = [f"task {k}" for k in range(int(rng.integers(1, 6)))]
    works, tasks = {}, {}
    for name in names:
        try:
            works[name] = work(rng, empty)
        except InfeasibleError:
            works[name] = visit((0.0, 60.0, 20.0))
        if rng.random() < 0.15:
            tasks[name] = task(name, earliest=float(rng.uniform(0, 300)), priority=int(rng.integers(0, 3)))
    after, controls = order(rng, names)
    return scene(
        team,
        works,
        after=after,
        controls=controls,
        tasks=tasks,
        areas=empty.areas,
        transit_altitude=[None, 40.0][int(rng.random() < 0.5)],
        minimum_separation=[None, 3.0][int(rng.random() < 0.2)],
    )


def check(seed):
    whole = random_scene(seed)
    try:
        found = plan(whole, seed=seed)
    except InfeasibleError:
        return False
    assert complaints(whole, found) == []
    return True


@pytest.mark.parametrize("seed", range(20, 32))
def test_a_random_plan_can_be_carried_out(seed):
    check(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(40, 440))
def test_many_random_plans_can_be_carried_out(seed):
    check(seed)


def test_most_random_scenes_have_a_plan_that_can_be_carried_out():
    assert sum(check(seed) for seed in range(10)) >= 6


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_more_robots_are_never_later(count):
    """The makespan of a shared field comes near to an even division of the work."""
    team = tuple(robot(f"r{k}", (15.0 * k, 0.0, 0.0), kinematics=DRONE) for k in range(count))
    shell = ((0.0, 50.0), (300.0, 50.0), (300.0, 300.0), (0.0, 300.0))
    works = {"a": field_work(scene(team, {}), shell, width=12.0)}
    alone = plan(scene(team[:1], works)).makespan
    assert plan(scene(team, works)).makespan <= alone / count + 80.0
