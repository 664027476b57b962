"""In random plans, every sortie leads in and out through a corridor."""

from dataclasses import replace

import numpy as np
import pytest
from plan_replay import complaints
from random_scenes import random_scene

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Corridor


def corridors(seed):
    """Yield one to three corridors about the homes of random scenes, some with heights or one way only."""
    rng = np.random.default_rng(seed)
    for k in range(int(rng.integers(1, 4))):
        east, north = rng.uniform(-150.0, 250.0, 2)
        line = [(east, north)]
        for _ in range(int(rng.integers(1, 4))):
            line.append(tuple((np.array(line[-1]) + rng.uniform(-60.0, 60.0, 2)).tolist()))
        low = float(rng.choice([-np.inf, 0.0, 18.0]))
        yield Corridor(
            f"corridor {k}",
            tuple((float(x), float(y)) for x, y in line),
            width=float(rng.uniform(2.0, 12.0)),
            low=low,
            high=float(rng.choice([low + 12.0, np.inf])),
            use=("BOTH", "BOTH", "ENTRY", "EXIT")[int(rng.integers(0, 4))],
        )


def check(seed):
    whole = replace(random_scene(seed), corridors=tuple(corridors(seed)))
    try:
        found = plan(whole, seed=seed)
    except InfeasibleError:
        return False
    assert complaints(whole, found) == []
    return True


@pytest.mark.parametrize("seed", [3, 5, 8, 21])
def test_sorties_of_a_random_plan_lead_through_corridors(seed):
    assert check(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [2, 13, *range(30, 230)])
def test_sorties_of_many_random_plans_lead_through_corridors(seed):
    check(seed)
