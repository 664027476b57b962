"""Films and cameras in the place of simulated pictures, and what is said of those that will not do."""

import threading
import time
from pathlib import Path

import cv2
import numpy as np
import pytest
from sample_vessels import pool_sheet
from signals_elsewhere import signalled
from stalls import Stalls

from auv_vessel.body.surroundings import BUOY, PATH, Surroundings, Thing, to_json
from auv_vessel.sheet import to_json as sheet_json
from auv_vision import processes
from auv_vision.__main__ import main, memory_of
from auv_vision.cameras import Pose, cameras_of
from auv_vision.detecting import sought_in, unseen
from auv_vision.processes import Notice
from auv_vision.sources import Adjusted, Captured, SourceError

FRONT, BOTTOM = cameras_of(pool_sheet())
HERE = Pose(0.0, 0.0, 1.0)


def film(path: Path, pictures: int = 3, size: tuple[int, int] = (640, 240), rate: float = 5.0) -> str:
    """Write a film in which each picture is by 6 brighter than the one before."""
    out = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), rate, size)
    for number in range(pictures):
        out.write(np.full((size[1], size[0], 3), 6 * number, np.uint8))
    out.release()
    return str(path)


def number_of(source: Captured, time: float) -> int | None:
    pair = source.take(time, HERE)
    return None if pair is None else round(float(pair[0].mean()) / 6.0)


def test_a_film_goes_on_as_time_does(tmp_path: Path) -> None:
    source = Captured(film(tmp_path / "fast.avi", pictures=40, rate=30.0))
    times = [50.0 + 0.2 * number for number in range(8)]
    assert [number_of(source, time) for time in times] == [0, 6, 12, 18, 24, 30, 36, None]
    source.close()


def test_no_picture_of_a_slow_film_is_left_out_when_time_goes_back(tmp_path: Path) -> None:
    source = Captured(film(tmp_path / "slow.avi", pictures=4))
    assert [number_of(source, time) for time in (1.7e9, 12.0, 12.2, 12.4, 12.6)] == [0, 1, 2, 3, None]
    source.close()


def test_a_film_without_pictures_is_none(tmp_path: Path) -> None:
    whole = Path(film(tmp_path / "whole.avi")).read_bytes()
    cut = tmp_path / "cut.avi"
    cut.write_bytes(whole[: whole.index(b"movi") + 40])
    with pytest.raises(SourceError, match=r"no picture in it|cannot open"):
        Captured(str(cut)).take(0.0, HERE)


@pytest.mark.parametrize(
    ("size", "said"),
    [((640, 480), "640x480 pixels are not two pictures side by side"), ((128, 48), "64 pixels wide")],
)
def test_films_of_one_eye_or_of_few_pixels_are_refused(
    tmp_path: Path, size: tuple[int, int], said: str
) -> None:
    with pytest.raises(SourceError, match=said):
        Captured(film(tmp_path / "film.avi", size=size))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("/dev/video99", "/dev/video99: there is no such film or camera"),
        ("99", "99: OpenCV cannot open it"),
        ("/dev/null", "/dev/null: OpenCV cannot open it"),
        ("/dev/null,99", "/dev/null: OpenCV cannot open it"),
        ("", "there is no such film or camera"),
        (".", "there is no such film or camera"),
    ],
)
def test_cameras_that_are_not_there_are_said_to_be_so(text: str, said: str) -> None:
    with pytest.raises(SourceError, match=said):
        Captured(text)


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (1280, 1024), (480, 360)])
def test_of_pictures_of_other_proportions_the_middle_is_taken(width: int, height: int) -> None:
    across = min(width, height * 4 // 3)
    picture = np.zeros((height, width, 3), np.uint8)
    cv2.circle(picture, (width // 2, height // 2), across // 4, (255, 255, 255), -1)
    left, _ = Adjusted(FRONT).pair(picture, picture)
    assert left.shape == (240, 320, 3)
    seen = left[..., 0] > 127
    assert np.count_nonzero(seen.any(axis=0)) == pytest.approx(160, abs=2)
    assert np.count_nonzero(seen.any(axis=1)) == pytest.approx(160, abs=2)


@pytest.fixture
def words(tmp_path: Path) -> list[str]:
    sheet, pool = tmp_path / "sheet.json", tmp_path / "pool.json"
    sheet.write_text(sheet_json(pool_sheet()))
    pool.write_text(to_json(Surroundings(bottom=4.0)))
    return ["frames", "--sheet", str(sheet), "--surroundings", str(pool), "--interface", "none"]


def test_the_end_of_a_film_is_said_and_the_other_camera_takes_nothing(
    tmp_path: Path, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words, "--bottom", film(tmp_path / "film.avi"), "--rate", "50"]) == 0
    assert capsys.readouterr().err == "frames: the film for bottom has ended\n"


def test_no_camera_at_all_is_refused(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*words, "--front", "none"]) == 2
    assert "no camera is used" in capsys.readouterr().err


def test_each_vehicle_on_a_computer_has_memory_of_its_own() -> None:
    names = {memory_of(robot) for robot in ("Castor", "Pollux", "a/b", "a-b", "a%2Fb", "Ää")}
    assert len(names) == 6
    assert not any("/" in name for name in names)


def test_what_a_camera_never_sees_is_said() -> None:
    things = (
        Thing(BUOY, "blue buoy", 1.0, 0.0, 1.0, colour="blue"),
        Thing(PATH, "grey path", 1.0, 0.0, 4.0, colour="grey"),
        Thing("torpedo", "board", 1.0, 0.0, 1.0),
        Thing(BUOY, "red buoy", 1.0, 0.0, 1.0, colour="red"),
    )
    sought = sought_in(Surroundings(things=things))
    apart = "is none of red, orange, yellow, green"
    board = "'board' is never detected: unknown shape of a 'torpedo'"
    assert unseen(FRONT, sought) == [f"'blue buoy' is never seen: blue {apart}", board]
    assert unseen(BOTTOM, sought) == [f"'grey path' is never seen: grey {apart}", board]


def test_what_is_amiss_for_long_is_said_once_and_so_is_its_end(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    notice = Notice("amiss", "mended")
    for is_amiss in (True, True, False):
        notice.note(is_amiss)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(processes, "PATIENCE", 0.0)
    for is_amiss in (True, True, True, False, False):
        notice.note(is_amiss)
    assert capsys.readouterr().err == "amiss\nmended\n"


def test_a_signal_ends_the_taking_of_pictures_that_are_far_apart() -> None:
    stop, stalls, begun = threading.Event(), Stalls(), time.monotonic()
    with signalled(stop.set, rescue=stop.set):
        processes.handle({}, {}, {}, lambda: HERE, time.time, stop, rate=0.01)
    assert time.monotonic() - begun < 3.0 + stalls.seconds
