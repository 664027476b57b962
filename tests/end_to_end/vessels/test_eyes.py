"""The eyes of a vehicle as three processes: a bus tells them where they are, they tell what they see."""

import sys
import time
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from patience import wait_for
from sample_vessels import pool_sheet
from vision_processes import POOL, Head, eyes

from auv_vision.cameras import Pose, cameras_of
from auv_vision.renderer import Renderer

pytestmark = pytest.mark.real_time("vessels")

HERE = Pose(0.0, 0.0, 1.5, 2.0, -3.0, 5.0)
NAMES = frozenset(thing.name for thing in POOL.things)
HALF_A_CORE = 0.5


def sees_all(head: Head) -> bool:
    return wait_for(lambda: head.detections.seen() == NAMES, 40)


def sees_nothing(head: Head) -> bool:
    return wait_for(lambda: not head.detections.seen(), 10)


def test_three_processes_tell_where_things_are_within_half_a_core(tmp_path: Path) -> None:
    with eyes(tmp_path, HERE, python=sys.executable) as head:
        assert sees_all(head)
        for thing in POOL.things:
            assert head.detections.place(thing.name) == pytest.approx(
                (thing.north, thing.east, thing.depth), abs=0.3
            )
        began, before = time.monotonic(), head.cpu()
        time.sleep(6.0)
        share = (head.cpu() - before) / (time.monotonic() - began)
        assert head.detections.bad.total() == 0
        assert head.close() == [0, 0, 0]
        assert not list(Path("/dev/shm").glob(f"{head.memory}*"))
    assert share < HALF_A_CORE


def test_whichever_is_killed_the_others_go_on_and_it_can_begin_again(tmp_path: Path) -> None:
    with eyes(tmp_path, HERE) as head:
        assert sees_all(head)
        head.kill("frames")
        assert sees_nothing(head)
        head.restart("frames")
        assert sees_all(head)
        head.kill("front")
        assert wait_for(lambda: head.detections.seen() == {"path"}, 10)
        head.restart("front")
        assert sees_all(head)


def test_nothing_is_told_while_nobody_knows_where_the_vehicle_is(tmp_path: Path) -> None:
    with eyes(tmp_path, HERE) as head:
        assert sees_all(head)
        head.told.trusted = False
        assert sees_nothing(head)
        head.told.trusted = True
        assert sees_all(head)
        head.told.pose = replace(HERE, heading=185.0)
        assert wait_for(lambda: head.detections.seen() == {"path"}, 10)


def film(path: Path, pictures: int) -> Path:
    """Write a film of both eyes of the front camera, side by side, at twice the resolution."""
    front, _ = cameras_of(pool_sheet())
    renderer = Renderer(POOL, seed=3)
    out = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 5.0, (1280, 480))
    assert out.isOpened()
    for number in range(pictures):
        pair = np.hstack(renderer.pair(front, HERE, 0.2 * number))
        out.write(cv2.resize(pair // 2, (1280, 480), interpolation=cv2.INTER_CUBIC))
    out.release()
    return path


@pytest.mark.thorough
def test_a_dark_film_stands_for_cameras_and_ends_the_process_when_it_ends(tmp_path: Path) -> None:
    with eyes(tmp_path, HERE) as head:
        head.parts["frames"].terminate()
        head.parts["frames"].communicate(timeout=20)
        assert sees_nothing(head)
        head.parts["frames"] = head.start("frames", "--front", str(film(tmp_path / "pool.avi", 40)))
        assert wait_for(lambda: head.detections.seen() >= NAMES - {"path"}, 30)
        assert head.parts["frames"].wait(timeout=40) == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--front", "nowhere.avi"), "there is no such film or camera"),
        (("--bottom", "97"), "cannot open"),
        (("--surroundings", "nowhere.json"), "No such file"),
        (("--rate", "0"), "expected a rate above 0"),
        (("--to", "nobody"), "expected HOST:PORT"),
    ],
)
def test_what_is_wrong_with_its_words_is_said(words: tuple[str, str], said: str, tmp_path: Path) -> None:
    with eyes(tmp_path, HERE, parts=()) as head:
        process = head.start("frames", *words)
        _, error = process.communicate(timeout=40)
        assert process.returncode == 2
        assert said in error
