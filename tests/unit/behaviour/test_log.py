"""Logs are read as files, and every line that is no step has its place."""

from queue import SimpleQueue

import pytest

from mmrs_core.behaviour.log import read_log, read_logs
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord, log_name, to_line

FIRST = StepRecord("run", "r", 0, 1, 0.0, "begin", "start")
SECOND = StepRecord("run", "r", 1, 2, 0.5, "ntf", "start", "post:0", "+q.s")
OTHER = StepRecord("run", "q", 0, 3, 0.5, "begin", "start")


def test_what_was_written_is_read_again(tmp_path):
    with LogWriter(tmp_path) as log:
        for record in (FIRST, SECOND):
            log.write(record)
    assert read_log(tmp_path / log_name("r")) == (FIRST, SECOND)


def test_each_robot_has_its_own_log_and_a_folder_is_read_merged(tmp_path):
    with LogWriter(tmp_path) as log:
        for record in (OTHER, FIRST, SECOND):
            log.write(record)
    assert len(list(tmp_path.iterdir())) == 2
    assert read_logs([tmp_path]) == (FIRST, SECOND, OTHER)


def test_what_is_written_is_on_the_disk_once_that_was_asked_for(tmp_path, monkeypatch):
    synced, kept = [], SimpleQueue()
    monkeypatch.setattr("os.fsync", synced.append)
    with LogWriter(tmp_path) as log:
        log.write(FIRST)
        log.write(SECOND)
        assert synced == []
        log.sync("r", kept.put)
        assert kept.get(timeout=20.0) is None
        assert len(synced) == 1
        assert read_log(tmp_path / log_name("r")) == (FIRST, SECOND)


def test_a_log_of_an_earlier_run_is_replaced(tmp_path):
    for record in (SECOND, FIRST):
        with LogWriter(tmp_path) as log:
            log.write(record)
    assert read_log(tmp_path / log_name("r")) == (FIRST,)


def test_every_bad_line_is_reported_with_its_number(tmp_path):
    path = tmp_path / "r.jsonl"
    path.write_text(f"{to_line(FIRST)}\nnonsense\n{to_line(SECOND)}\n[]\n\n")
    with pytest.raises(InvalidModelError) as caught:
        read_log(path)
    assert [fault.place.line for fault in caught.value.diagnostics] == [2, 4, 5]
    assert str(caught.value.diagnostics[0]).startswith(f"{path}:2: error: line is not JSON")


def test_a_line_that_was_cut_off_is_accepted_only_in_a_partial_log(tmp_path):
    path = tmp_path / "r.jsonl"
    path.write_text(to_line(FIRST) + "\n" + to_line(SECOND)[:20])
    assert read_log(path, partial=True) == (FIRST,)
    with pytest.raises(InvalidModelError):
        read_log(path)


@pytest.mark.parametrize("rest", ["Ä".encode()[:1], b"\xff\xfe\0", b'\xff{"a": 1}\n\0\0\n', b"\0" * 40])
def test_what_a_loss_of_power_leaves_behind_the_last_whole_line_is_passed_over(tmp_path, rest):
    path = tmp_path / log_name("r")
    path.write_bytes(to_line(FIRST).encode() + b"\n" + rest)
    assert read_log(path, partial=True) == (FIRST,)
    with pytest.raises((InvalidModelError, UnreadableError)):
        read_log(path)
    with LogWriter(tmp_path, resumed=True) as writer:
        writer.write(SECOND)
    assert read_log(path) == (FIRST, SECOND)


def test_rubbish_before_a_whole_line_is_no_end_of_a_log(tmp_path):
    path = tmp_path / "r.jsonl"
    path.write_bytes(b"\xff\xfe\n" + to_line(FIRST).encode() + b"\n")
    with pytest.raises(UnreadableError, match=r"r\.jsonl:1: cannot be read as a log"):
        read_log(path, partial=True)


@pytest.mark.parametrize("content", [b"\xff\xfe", None])
def test_a_file_that_is_no_text_or_not_there_is_unreadable(tmp_path, content):
    path = tmp_path / "r.jsonl"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(UnreadableError, match="cannot be read as a log"):
        read_log(path)


def test_a_folder_without_logs_is_unreadable(tmp_path):
    with pytest.raises(UnreadableError, match="no log in this folder"):
        read_logs([tmp_path])


@pytest.mark.parametrize("line", ["[" * 50_000, '{"time": NaN}', '{"x": "' + "y" * 200_000 + '"}'])
def test_hostile_lines_are_reported_like_any_other(tmp_path, line):
    path = tmp_path / "r.jsonl"
    path.write_text(line + "\n")
    with pytest.raises(InvalidModelError):
        read_log(path)
