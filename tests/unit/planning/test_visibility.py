"""What is remembered of what lies between places."""

import numpy as np
from plain_scenes import box

from mmrs_core.planning import visibility
from mmrs_core.planning.obstacles import Obstacles
from mmrs_core.planning.visibility import Visibility

WALLS = [box(f"wall {k}", 40.0 * k, -100.0 + 30.0 * (k % 2), 40.0 * k + 10.0, 70.0) for k in range(1, 6)]


def places(count):
    """Return places left and right of all walls, in pairs."""
    up = np.linspace(-90.0, 60.0, count).tolist()
    return [((0.0, each), (280.0, -each)) for each in up]


def looks(known):
    """Return how often it was looked around for what is remembered."""
    return sum(memory.met[-1] for memory in known._memories.values())


def test_from_where_many_paths_begin_is_looked_once():
    obstacles, ((start, _), *others) = Obstacles(WALLS, 2.0), places(9)
    blocks = np.ones(len(WALLS), np.bool_)
    seen = Visibility(obstacles)
    known = [seen.shortest_path(start, goal, blocks) for _, goal in others]
    before = looks(seen)
    assert known == [seen.shortest_path(start, goal, blocks) for _, goal in others]
    assert looks(seen) == before > len(others)


def test_paths_stay_the_same_when_places_that_were_remembered_are_forgotten(monkeypatch):
    obstacles, blocks = Obstacles(WALLS, 2.0), np.ones(len(WALLS), np.bool_)
    kept = Visibility(obstacles)
    known = [kept.shortest_path(*pair, blocks) for pair in places(12)]
    monkeypatch.setattr(visibility, "_PLACES", 5)
    forgetful = Visibility(obstacles)
    assert [forgetful.shortest_path(*pair, blocks) for pair in places(12)] == known
    assert looks(forgetful) < looks(kept)
