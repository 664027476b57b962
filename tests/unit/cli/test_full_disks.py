"""What cannot be written to the end is named: a full disk says of itself only that it is full."""

import errno
import os
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from mmrs_core.behaviour.log import read_log
from mmrs_core.cli import run
from mmrs_core.languages.writing import replace_file
from mmrs_runtime.control import Control
from mmrs_runtime.orders.orders import Orders
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord

FULL = "/dev/full"
HANDWRITTEN = Path(__file__).parents[3] / "examples" / "handwritten"
POOL = HANDWRITTEN.parent / "pool"
STEP = StepRecord("run-0", "alpha", 0, 1, 0.0, "begin", "start")


@pytest.fixture
def full(monkeypatch):
    """Have everything that is opened by number be a full disk."""
    if not os.path.exists(FULL):  # noqa: PTH110  # a device, no file of ours
        pytest.skip("this system has no full disk to write to")
    opened = os.fdopen

    def instead(number, *more, **options):
        os.dup2(os.open(FULL, os.O_WRONLY), number)
        return opened(number, *more, **options)

    monkeypatch.setattr(os, "fdopen", instead)


def test_a_file_that_is_replaced_is_named(full, tmp_path):
    with pytest.raises(OSError, match=r"model\.xmi") as raised:
        replace_file(tmp_path / "model.xmi", b"x")
    assert raised.value.errno == errno.ENOSPC
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def limit(monkeypatch):
    """Return a function that lets files grow up to so many bytes; None: as before.

    Compiled modules are not kept meanwhile: half of one would be taken for whole by whoever imports it next.
    """
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    resource = pytest.importorskip("resource")
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)

    def set_to(most):
        resource.setrlimit(resource.RLIMIT_FSIZE, usual if most is None else (most, usual[1]))

    yield set_to
    set_to(None)


@pytest.mark.parametrize("command", [["simulate"], ["preview"], ["generate", "--target", "mavlink-python"]])
def test_a_folder_that_is_new_goes_again_where_what_it_is_for_cannot_be_written(
    tmp_path, limit, capsys, command
):
    name, *options = command
    limit(10)
    code = run([name, str(HANDWRITTEN), *options, "-o", str(tmp_path / "new" / "folder")])
    limit(None)
    assert code == 3
    assert str(tmp_path / "new" / "folder") in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("command", "output"),
    [
        (["preview", str(HANDWRITTEN)], "preview.html"),
        (["can", "dbc", str(POOL), "--robot", "Naiad"], "naiad.dbc"),
        (["auv", "sheet", str(POOL)], "Naiad.json"),
    ],
)
def test_a_file_that_was_there_stays_whole_where_another_cannot_be_written(tmp_path, limit, command, output):
    old, into = tmp_path / output, tmp_path / output if "dbc" in command else tmp_path
    old.write_text("of yesterday")
    limit(100)
    assert run([*command, "-o", str(into)]) == 3
    limit(None)
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [(output, "of yesterday")]


def test_nothing_is_left_of_a_demonstration_whose_behaviour_cannot_be_written(tmp_path, limit):
    limit(10)
    assert run(["demo", "pool", "-o", str(tmp_path / "new")]) == 3
    limit(None)
    assert list(tmp_path.iterdir()) == []


def test_a_channel_that_cannot_be_announced_is_not_taken_for_one_that_will_be(tmp_path, limit):
    limit(10)
    with pytest.raises(OSError, match="large"):
        Control(tmp_path, "run-0", ["alpha"], Orders(), lambda robot: {})
    limit(None)
    assert list(tmp_path.iterdir()) == []


def test_logs_of_a_simulation_stay_where_those_of_another_cannot_be_written(tmp_path, limit):
    assert run(["simulate", str(HANDWRITTEN), "-o", str(tmp_path)]) == 0
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    limit(1000)
    assert run(["simulate", str(HANDWRITTEN), "-o", str(tmp_path)]) == 3
    limit(None)
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before


@pytest.mark.parametrize("resumed", [False, True])
def test_a_log_on_a_full_disk_has_its_fault_once_there_is_room_and_no_step_that_was_not_made(
    tmp_path, limit, resumed
):
    fault = STEP._replace(seq=1, label="fault", detail="LOG_FAILED")
    with LogWriter(tmp_path, resumed=resumed) as writer:
        writer.write(STEP)
        limit((tmp_path / "alpha.jsonl").stat().st_size + 10)
        for lost in (STEP._replace(seq=1, label="end"), fault):
            with pytest.raises(OSError, match=r"alpha\.jsonl"):
                writer.write(lost)
        limit(None)
    assert read_log(tmp_path / "alpha.jsonl") == (STEP, fault)


def test_a_log_is_named(tmp_path):
    (tmp_path / "alpha.jsonl").symlink_to(FULL)
    writer = LogWriter(tmp_path)
    with pytest.raises(OSError, match=r"alpha\.jsonl"):
        writer.write(STEP)
    with suppress(OSError):
        writer.close()
