"""Measures how long a track of a million positions takes to write in each format, and how much memory.

It is compared to a plain loop that writes its positions with `json.dumps`.

    python benchmarks/drawings.py
"""

from __future__ import annotations

import json
from collections.abc import Callable
from datetime import date
from multiprocessing import get_context
from resource import RUSAGE_SELF, getrusage
from time import process_time

import numpy as np

from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature, Role
from mmrs_core.plugins import load_plugins

COUNT = 1_000_000


def plain_loop(drawing: Drawing) -> bytes:
    """Return the positions of the first feature as JSON, a position on each line."""
    (feature, *_) = drawing.features
    rows = np.column_stack([feature.rings[0][:, ::-1], feature.heights[0]]).tolist()
    return "\n".join(json.dumps(row) for row in rows).encode()


def measured(name: str) -> tuple[float, float, float]:
    """Return seconds of CPU, and megabytes of memory and of the file, of writing a track."""
    writers: dict[str, Callable[[Drawing], bytes]] = {
        each.name: lambda drawing, each=each: each.write(drawing, "track")  # type: ignore[misc]
        for each in load_plugins().contributions.exporters.values()
    }
    steps = np.arange(COUNT)
    ring = np.column_stack([45.0 + 1e-7 * steps, 11.0 + 2e-7 * steps])
    line = MapFeature(
        Geometry.LINE,
        (ring,),
        (100.0 + 20.0 * np.sin(steps * 0.1),),
        HeightReference.SEA_LEVEL,
        1.77e9 + 0.1 * steps,
        name="track",
        role=Role.TRACK,
    )
    memory, begin = getrusage(RUSAGE_SELF).ru_maxrss, process_time()
    size = len(writers.get(name, plain_loop)(Drawing((line,))))
    used = getrusage(RUSAGE_SELF).ru_maxrss - memory
    return process_time() - begin, used / 1e3, size / 1e6


def main() -> None:
    """Print a line for each format."""
    print(f"a track of {COUNT} positions with heights and times, {date.today()}")
    usual = 0.0
    for name in ("json.dumps", "geojson", "kml", "kmz", "gpx"):
        with get_context("spawn").Pool(1) as pool:
            seconds, memory, size = pool.apply(measured, (name,))
        usual = usual or seconds
        print(
            f"{name:10}  {seconds:5.2f} s of CPU, {seconds / usual:4.2f} of json.dumps;"
            f" {memory:4.0f} MB more memory; file {size:4.0f} MB"
        )


if __name__ == "__main__":
    main()
