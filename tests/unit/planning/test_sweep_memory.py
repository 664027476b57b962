"""What weighing the directions of a border of many vertices needs."""

import tracemalloc
from math import cos, pi, sin

from shapely.geometry import Polygon

from mmrs_core.planning.swaths import sweep_angles


def test_directions_of_many_edges_are_weighed_in_little_memory():
    count = 4000
    rim = [(100 * cos(2.001 * pi * i / count), 90 * sin(2 * pi * i / count)) for i in range(count)]
    tracemalloc.start()
    try:
        sweep_angles([Polygon(rim)])
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 60_000_000
