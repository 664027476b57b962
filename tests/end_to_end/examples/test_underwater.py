"""The examples of underwater vehicles, checked, and dived by simulated vehicles with their control layer."""

from collections.abc import Sequence
from itertools import pairwise
from math import dist
from pathlib import Path

import pytest
from sample_vessels import random_start

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_core.cli.examples import DemoSettings, demo_settings_of, example_folder
from mmrs_core.cli.simulation import write_logs
from mmrs_core.contributions.execution import Sample
from mmrs_core.errors import UnreadableError
from mmrs_core.pipeline import simulate
from mmrs_core.scene import Position
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.together("examples")

TARGET, UP = (23.0, 8.0, -3.0), (25.0, 8.0)
"""Where the course's vehicle holds over the target, and comes up: metres east, north and up."""

HELD, ERROR, DEEPER, AFLOAT = 15.0, 1.5, 0.2, -0.3
"""Seconds; metres beside a place, by dead reckoning, and above or below it; height of a vehicle afloat."""

MEETINGS, TOGETHER = {"Castor": (0.5, 14.0, -0.2), "Pollux": (5.5, 14.0, -0.2)}, 10
"""Where two vehicles meet, metres east, north and up; for how many seconds at least."""


def dived(taken, contributions, name, folder, **options):
    example = taken(name)
    manner = demo_settings_of(example_folder(name))
    run = simulate(
        example.program,
        example.place,
        contributions,
        backend=manner.backend,
        options={**manner.options, **options},
    )
    write_logs(run, example.program, folder, example.place.types)
    return run, replay(example.program, read_logs([folder]))


def completes(taken, contributions, folder: Path, seed: int) -> None:
    run, judged = dived(taken, contributions, "pool-course", folder, **random_start(seed))
    assert run.ending.outcome is Outcome.SUCCESS, run.ending
    assert judged.accepted
    ways = [(each.east, each.north, each.up) for each in run.tracks["Thetis"]]
    crossed = [b for a, b in pairwise(ways) if a[0] < 7.0 <= b[0]]
    assert crossed
    assert all(6.5 < north < 9.5 and -2.7 < up < -1.2 for _, north, up in crossed[:1])
    assert longest_stay(run.tracks["Thetis"], TARGET, ERROR) >= HELD
    east, north, up = ways[-1]
    assert dist((east, north), UP) < ERROR
    assert up > AFLOAT


def longest_stay(track: Sequence[Sample], place: Position, error: float) -> float:
    """Return for how long a track stays over a place, at its height, seconds."""
    longest, since = 0.0, None
    for each in track:
        east, north, up = each.position
        if dist((east, north), place[:2]) > error or abs(up - place[2]) > DEEPER:
            since = None
            continue
        since = each.time if since is None else since
        longest = max(longest, each.time - since)
    return longest


def test_the_course_is_completed_from_a_random_start(taken, contributions, tmp_path):
    completes(taken, contributions, tmp_path, 1)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(2, 11))
def test_the_course_is_completed_from_many_starts(taken, contributions, tmp_path, seed):
    completes(taken, contributions, tmp_path, seed)


@pytest.mark.thorough
def test_two_vehicles_meet_when_both_are_done(taken, contributions, tmp_path):
    run, judged = dived(taken, contributions, "two-auv-survey", tmp_path)
    assert run.ending.outcome is Outcome.SUCCESS
    assert judged.accepted
    castor, pollux = (
        {round(each.time) for each in run.tracks[name] if dist(each.position, place) < ERROR}
        for name, place in MEETINGS.items()
    )
    assert len(castor & pollux) >= TOGETHER


def test_examples_say_how_they_are_shown(tmp_path):
    course = example_folder("auv")
    assert course == example_folder("pool-course")
    manner = demo_settings_of(course)
    assert (manner.backend, manner.targets) == ("can-sim", ("can-python",))
    assert Path(manner.options["surroundings"]).is_file()
    assert demo_settings_of(example_folder("pool")) == DemoSettings(targets=("mavlink-python", "qgc-plan"))
    (tmp_path / "demo.toml").write_text("backend = 3\n")
    with pytest.raises(UnreadableError, match=r"demo\.toml"):
        demo_settings_of(tmp_path)
