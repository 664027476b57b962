"""Random expanded scenes: areas, tasks of several sorts in some order, robots with small batteries."""

import numpy as np
from plain_scenes import box, control, field_work, photo, road, robot, scene, task, visit, with_kinematics

from mmrs_core.errors import InfeasibleError
from mmrs_runtime.timing import LegTiming


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
            "timing": LegTiming(float(rng.choice([0.5, 3.0, np.inf]))),
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
