"""What is left of a damaged log is read for people."""

from pathlib import Path

import pytest

from mmrs_core.behaviour.log import logs_in, recover_log
from mmrs_core.errors import UnreadableError
from mmrs_runtime.records.steps import StepRecord, to_line

STEPS = [StepRecord("r", "Ann", i, i, float(i), "begin", f"m{i}") for i in range(3)]


def test_a_whole_log_is_read_whole(tmp_path):
    (tmp_path / "Ann.jsonl").write_text("".join(to_line(step) + "\n" for step in STEPS))
    assert recover_log(tmp_path / "Ann.jsonl") == (tuple(STEPS), ())


def test_a_last_line_that_was_cut_off_is_told(tmp_path):
    lines = [to_line(step) for step in STEPS]
    (tmp_path / "Ann.jsonl").write_text(f"{lines[0]}\n{lines[1]}\n{lines[2][:20]}")
    records, damages = recover_log(tmp_path / "Ann.jsonl")
    assert records == tuple(STEPS[:2])
    assert [str(damage) for damage in damages] == ["Ann.jsonl:3: cut off while it was written"]


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (b"\0\0\0\0", "zero bytes, as power loss leaves them"),
        (b"nonsense}", "line is not JSON"),
        (b"[]", "list: not"),
    ],
)
def test_lines_that_are_no_steps_are_told_and_the_rest_is_used(tmp_path, text, what):
    first, last = (to_line(STEPS[i]).encode() for i in (0, 2))
    (tmp_path / "Ann.jsonl").write_bytes(first + b"\n" + text + b"\n" + last + b"\n")
    records, damages = recover_log(tmp_path / "Ann.jsonl")
    assert records == (STEPS[0], STEPS[2])
    assert [damage.line for damage in damages] == [2]
    assert damages[0].what.startswith(what)


def test_logs_are_found_beside_other_files(tmp_path):
    for name in ("Ann.jsonl", "Bob.jsonl", "Ann.blackbox.ndjson"):
        (tmp_path / name).touch()
    found = logs_in([tmp_path, tmp_path / "Ann.jsonl", tmp_path / "Ann.blackbox.ndjson"])
    assert [path.name for path in found] == ["Ann.jsonl", "Bob.jsonl"]


def test_a_log_that_is_named_in_two_ways_is_one(tmp_path, monkeypatch):
    (tmp_path / "Ann.jsonl").touch()
    monkeypatch.chdir(tmp_path)
    assert len(logs_in([tmp_path, Path("Ann.jsonl"), Path()])) == 1


def test_a_log_that_is_not_there_is_named(tmp_path):
    with pytest.raises(UnreadableError, match=r"gone\.jsonl: cannot be read as a log"):
        recover_log(tmp_path / "gone.jsonl")
