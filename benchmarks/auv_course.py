"""Dives `examples/pool-course` from random starts, in random currents and noise, in simulated time.

Each dive is judged as in the tests: every robot comes to its end, the logs replay, the gate was passed below
its bar and between its posts, the vehicle truly held over the target for as long as asked for, and is at the
surface beside it in the end.

    python benchmarks/auv_course.py > benchmarks/results/auv_course.txt
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from datetime import date
from itertools import pairwise
from math import dist
from pathlib import Path

from sample_vessels import random_start

from mmrs_core import pipeline
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import replay
from mmrs_core.cli.examples import demo_settings_of
from mmrs_core.cli.simulation import write_logs
from mmrs_core.contributions.execution import Sample
from mmrs_core.plugins import load_plugins
from mmrs_core.resources import shipped
from mmrs_runtime.semantics import Outcome

GATE_EAST, POSTS, BAR = 7.0, (6.5, 9.5), (-2.7, -1.2)
"""Metres east and north, and heights, of the gate."""

TARGET, UP, ERROR = (23.0, 8.0), (25.0, 8.0), 1.5
"""Where it holds and comes up, metres east and north; how far it may be from there. By dead reckoning
its place is known to 0.5 m along each axis in the end."""

HELD_AT, HELD, AFLOAT = -3.0, 15, -0.3
"""Metres up; seconds, as many as samples of a track; height of a vehicle afloat, at least."""


def main() -> None:
    """Print a line for each dive."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=1, metavar="SEED")
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--objects", choices=("seen", "cameras"), default="seen")
    given = parser.parse_args()
    print(f"the course from {given.count} random starts from seed {given.first}, objects {given.objects}, "
          f"{date.today()}\n")  # fmt: skip
    print(f"{'seed':>4} {'north, east of home':>20} {'heading':>8} {'current':>8} {'seconds':>8}  result")
    done = 0
    for seed in range(given.first, given.first + given.count):
        done += dive(seed, given.objects)
    print(f"\n{done} of {given.count} completed")


def dive(seed: int, objects: str) -> bool:
    """Dive once; print and return whether all was well."""
    folder = shipped("examples") / "pool-course"
    contributions = load_plugins().contributions
    manner, start = demo_settings_of(folder), random_start(seed)
    models, _ = pipeline.valid_models(folder, contributions)
    scene = pipeline.expand(pipeline.ground(models), contributions)
    behaviour, _ = pipeline.transform(scene, pipeline.plan(scene), contributions)
    program, place = pipeline.program_of(behaviour, contributions), pipeline.place_of_scene(scene)
    options = {**manner.options, **start, "objects": objects}
    run = pipeline.simulate(program, place, contributions, backend=manner.backend, options=options)
    with tempfile.TemporaryDirectory() as logs:
        write_logs(run, program, Path(logs), place.types)
        accepted = accepted_by(program, Path(logs))
    faults = (
        [] if run.ending.outcome is Outcome.SUCCESS else [*map(str, run.ending.faults.values()), "not ended"]
    )
    faults += faults_of([sample for track in run.tracks.values() for sample in track])
    faults += [] if accepted else ["logs do not replay"]
    north, east = (float(each) for each in start["start"].split(","))
    speed = sum(float(each) ** 2 for each in start["current"].split(",")) ** 0.5
    print(f"{seed:4} {north:9.2f}, {east:9.2f} {float(start['heading']):8.0f} {speed:8.3f} "
          f"{run.ending.time:8.1f}  {'; '.join(faults) or 'completed, accepted'}", flush=True)  # fmt: skip
    return not faults


def accepted_by(program: Program, logs: Path) -> bool:
    """Return whether logs are what a behaviour says."""
    return replay(program, read_logs([logs])).accepted


def faults_of(track: Sequence[Sample]) -> list[str]:
    """Return what was wrong with the way of the vehicle."""
    crossed = [b for a, b in pairwise(track) if a.east < GATE_EAST <= b.east]
    through = [each for each in crossed[:1] if POSTS[0] < each.north < POSTS[1] and BAR[0] < each.up < BAR[1]]
    found = [] if through else ["the gate was not passed"]
    beside = [dist((each.east, each.north), TARGET) for each in track if abs(each.up - HELD_AT) < 0.2]
    over = [each for each in beside if each < ERROR]
    found += [] if len(over) >= HELD else [f"held over the target for {len(over)} s"]
    end = track[-1]
    up = end.up > AFLOAT and dist((end.east, end.north), UP) < ERROR
    return found + ([] if up else ["not at the surface where it is to come up"])


if __name__ == "__main__":
    main()
