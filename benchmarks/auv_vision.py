"""Measures what the eyes of an underwater vehicle see in random scenes of which the truth is known.

Gates, buoys and paths at 1 m to 10 m before and below a vehicle that heels and pitches, with up to three
other buoys of any colour, at four levels of noise: the part of what is wholly in sight that is found at its
place (within 0.3 m or a tenth of the distance), how far off it is said to be, how often detections of a
confidence are right, what haze does to that, where detection knows it and where it does not, and seconds of
processor time for a pair of pictures.

    python benchmarks/auv_vision.py > benchmarks/results/auv_vision.txt
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import defaultdict
from collections.abc import Sequence
from datetime import date
from itertools import pairwise
from pathlib import Path
from statistics import median

import cv2

from auv_vessel.body.surroundings import BUOY, GATE, PATH

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from vision_trials import FRONT_CAMERA, Told, distance_of, is_visible, scene, trials

BAND = 2.0
HAZES = ((0.5, 0.5), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0), (0.5, 1.0), (1.5, 1.0), (2.0, 1.0), (3.0, 1.0))
"""Times the haze of a clear pool: as it is, and as detection takes it to be."""

CONFIDENCES = (0.0, 0.25, 0.5, 0.75, 0.9, 0.95, 0.98, 1.0)


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=2024)
    given = parser.parse_args()
    cv2.setNumThreads(1)
    hits: dict[tuple[str, str], list[bool]] = defaultdict(list)
    found: list[Told] = []
    for one, told in trials(given.scenes, given.seed):
        found += told
        if is_visible(one):
            hit = any(each.name == one.thing.name and each.right for each in told)
            hits[one.thing.kind, _band(distance_of(one.thing, one.pose))].append(hit)
            hits[one.thing.kind, f"noise {one.noise:g}"].append(hit)
    print(f"eyes: {given.scenes} scenes from seed {given.seed}, OpenCV {cv2.__version__}, {date.today()}")
    _print_hits(hits)
    _print_errors(found)
    _print_confidence(found)
    _print_haze(given.scenes // 4, given.seed)
    _print_time()
    return 0


def _band(metres: float) -> str:
    low = int(metres / BAND) * BAND
    return f"{low:4.0f} m to {low + BAND:.0f} m"


def _print_hits(hits: dict[tuple[str, str], list[bool]]) -> None:
    print("\nfound of what is wholly in sight")
    for (kind, which), each in sorted(hits.items()):
        print(f"  {kind:5} {which:14} {sum(each):4} of {len(each):4}  {sum(each) / len(each):6.1%}")


def _print_errors(found: Sequence[Told]) -> None:
    print("\nerror of the place, metres: median, 95th percentile")
    for kind in (GATE, BUOY, PATH):
        bands: dict[str, list[float]] = defaultdict(list)
        for each in found:
            if each.kind == kind:
                bands[_band(each.distance)].append(each.error)
        for band, errors in sorted(bands.items()):
            ordered = sorted(errors)
            far = ordered[int(0.95 * (len(ordered) - 1))]
            print(f"  {kind:5} {band:14} {median(ordered):6.3f} {far:6.3f}  of {len(ordered)}")


def _print_confidence(found: Sequence[Told]) -> None:
    print("\nconfidence: as told, as it turned out")
    for low, high in pairwise(CONFIDENCES):
        part = [each for each in found if low <= each.confidence < high]
        if part:
            told, right = (
                sum(x) / len(part) for x in zip(*((e.confidence, e.right) for e in part), strict=True)
            )
            print(f"  {low:4.2f} to {high:4.2f}  {told:5.3f}  {right:5.3f}  of {len(part)}")


def _print_haze(scenes: int, seed: int) -> None:
    print(f"\nhaze, times that of a clear pool, {scenes} scenes: found of what is wholly in sight; wrong of")
    print("what is told with a confidence of 0.5 or more")
    for haze, believed in HAZES:
        hits, wrongs = [], []
        for one, told in trials(scenes, seed, haze, believed):
            wrongs += [not each.right for each in told if each.confidence >= 0.5]
            if is_visible(one):
                hits.append(any(each.name == one.thing.name and each.right for each in told))
        found, wrong = (sum(each) / max(1, len(each)) for each in (hits, wrongs))
        counts = f"{found:6.1%} of {len(hits)}  {wrong:5.1%} of {len(wrongs)}"
        print(f"  is {haze:3.1f}, taken for {believed:3.1f}  {counts}")


def _print_time() -> None:
    """Print what one pair of pictures takes to draw and to look at."""
    from random import Random

    from auv_vision.detecting import detect, sought_in
    from auv_vision.renderer import Renderer

    random = Random(1)
    scenes = [one for one in (scene(random) for _ in range(200)) if one.camera is FRONT_CAMERA][:60]
    drawn = looked = 0.0
    for one in scenes:
        renderer = Renderer(one.surroundings)
        renderer.pair(one.camera, one.pose)
        begin = time.process_time()
        pair = renderer.pair(one.camera, one.pose)
        middle = time.process_time()
        detect(*pair, one.camera, sought_in(one.surroundings))
        drawn, looked = drawn + middle - begin, looked + time.process_time() - middle
    per = 1000.0 / len(scenes)
    print("\nprocessor time for a pair of 320x240 pixels")
    print(f"  drawn in {drawn * per:.1f} ms, looked at in {looked * per:.1f} ms")


if __name__ == "__main__":
    sys.exit(main())
