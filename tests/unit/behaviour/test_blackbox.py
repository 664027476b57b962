"""What is left of a black box is read, and what is not is told."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.behaviour.box_files import BlackBox, black_boxes, is_part
from mmrs_core.errors import UnreadableError
from mmrs_runtime.records.blackbox import BlackBox as Writer
from mmrs_runtime.records.entries import LONGEST_LINE, entries_of


def line(time: float = 0.0, kind: str = "text", **content: object) -> str:
    return json.dumps({"run": "r", "robot": "Ann", "time": time, "wall": "", "kind": kind, **content}) + "\n"


def read(path):
    damages = []
    entries = list(entries_of(path, damages.append))
    return entries, [(damage.line, damage.what) for damage in damages]


@pytest.fixture
def box(tmp_path):
    return tmp_path / "Ann.blackbox.ndjson"


def test_an_entry_says_what_its_line_says(box):
    box.write_text(line(1.5, "decision", what="BATTERY_LOW", response="RETURN"))
    (entry,), damages = read(box)
    assert (entry.run, entry.robot, entry.time, entry.kind) == ("r", "Ann", 1.5, "decision")
    assert entry.content == {"what": "BATTERY_LOW", "response": "RETURN"}
    assert damages == []


def test_kinds_that_nobody_knows_are_entries_too(box):
    box.write_text(line(kind="smell", of="smoke"))
    assert [entry.kind for entry in read(box)[0]] == ["smell"]


def test_a_line_that_was_cut_off_is_told_and_the_rest_is_used(box):
    box.write_text(line(1) + line(2) + line(3)[:40])
    entries, damages = read(box)
    assert [entry.time for entry in entries] == [1, 2]
    assert damages == [(3, "cut off while it was written")]


def test_zero_bytes_in_the_middle_are_told_and_the_rest_is_used(box):
    box.write_bytes(line(1).encode() + b"\0" * 300 + b"\n" + line(2).encode())
    entries, damages = read(box)
    assert [entry.time for entry in entries] == [1, 2]
    assert damages == [(2, "zero bytes, as power loss leaves them")]


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("[1, 2]\n", "not an object"),
        ("{half\n", "not JSON"),
        ('{"run": "r", "kind": "fix", "time": 1}\n', "run, robot or kind is missing"),
        (line(-1.0), "its time is not a number from 0 on"),
        (line(1).replace("1", "NaN", 1), "its time is not a number from 0 on"),
        (line(1).replace('"time": 1', '"time": true'), "its time is not a number from 0 on"),
        (line(1).replace('"time": 1', f'"time": 1{"0" * 400}'), "its time is not a number from 0 on"),
        ("[" * 100_000 + "\n", "not JSON"),
    ],
)
def test_what_is_no_entry_is_told_with_its_line(box, text, what):
    box.write_text(line(1) + text)
    entries, damages = read(box)
    assert len(entries) == 1
    assert damages == [(2, what)]


def test_a_line_longer_than_any_entry_is_told_once(box):
    box.write_text(line(1) + "x" * (3 * LONGEST_LINE) + "\n" + line(2))
    entries, damages = read(box)
    assert [entry.time for entry in entries] == [1, 2]
    assert damages == [(2, "longer than any entry")]


def test_a_file_that_cannot_be_opened_is_named(tmp_path):
    with pytest.raises(UnreadableError, match=r"gone\.blackbox\.ndjson: cannot be read"):
        list(BlackBox("gone", (tmp_path / "gone.blackbox.ndjson",)).entries(pytest.fail))


def test_parts_are_read_oldest_first(tmp_path):
    for name, time in (("Ann.blackbox.0002", 2), ("Ann.blackbox", 3), ("Ann.blackbox.0001", 1)):
        (tmp_path / f"{name}.ndjson").write_text(line(time))
    (box,) = black_boxes([tmp_path])
    assert [entry.time for entry in box.entries(pytest.fail)] == [1, 2, 3]
    assert box.missing == ()


def test_ten_thousand_parts_are_in_the_order_of_their_numbers(tmp_path):
    for number in (9_999, 10_000):
        (tmp_path / f"Ann.blackbox.{number:04d}.ndjson").write_text(line(number))
    (box,) = black_boxes([tmp_path])
    assert [entry.time for entry in box.entries(pytest.fail)] == [9_999, 10_000]


def test_parts_that_are_missing_are_told(tmp_path):
    for number in (2, 5):
        (tmp_path / f"Ann.blackbox.{number:04d}.ndjson").write_text(line(number))
    (box,) = black_boxes([tmp_path])
    assert box.missing == (
        "Ann.blackbox: part 1 of 5 is missing",
        "Ann.blackbox: parts 3 to 4 of 5 are missing",
        "Ann.blackbox: its last part, Ann.blackbox.ndjson, is missing",
    )


@pytest.mark.parametrize("name", [".", "Ann.jsonl", "Ann.blackbox.ndjson", "Ann.blackbox.0001.ndjson"])
def test_a_folder_a_log_and_any_part_lead_to_the_whole_box(tmp_path, name):
    for part in ("Ann.blackbox", "Ann.blackbox.0001", "Bob.blackbox"):
        (tmp_path / f"{part}.ndjson").write_text(line())
    found = {box.stem: len(box.parts) for box in black_boxes([tmp_path / name])}
    assert found["Ann"] == 2
    assert len(found) == (2 if name == "." else 1)


def test_a_box_that_is_named_in_two_ways_is_one(tmp_path, monkeypatch):
    (tmp_path / "Ann.blackbox.ndjson").write_text(line())
    monkeypatch.chdir(tmp_path)
    assert len(black_boxes([tmp_path, Path("Ann.jsonl"), Path()])) == 1


def test_a_log_without_a_box_leads_to_none(tmp_path):
    (tmp_path / "Ann.jsonl").touch()
    assert black_boxes([tmp_path / "Ann.jsonl", tmp_path]) == ()


@pytest.mark.parametrize(
    ("name", "expected"),
    [("a.blackbox.ndjson", True), ("a.blackbox.12.ndjson", True), ("a.jsonl", False), ("x.ndjson", False)],
)
def test_parts_are_known_by_their_names(tmp_path, name, expected):
    assert is_part(tmp_path / name) is expected


def test_a_box_that_a_robot_rotated_is_read_whole(tmp_path):
    writer = Writer(tmp_path / "Ann.blackbox.ndjson", "r", "Ann", iter(range(200)).__next__, largest=2_000)
    for number in range(200):
        writer.write("text", severity="INFO", text=f"number {number}")
    writer.close()
    (box,) = black_boxes([tmp_path])
    assert len(box.parts) > 5
    assert [entry.content["text"] for entry in box.entries(pytest.fail)] == [
        f"number {n}" for n in range(200)
    ]


def test_what_a_robot_wrote_after_its_power_came_back_is_read(tmp_path):
    path = tmp_path / "Ann.blackbox.ndjson"
    path.write_text(line(1) + line(2)[:30])
    writer = Writer(path, "r", "Ann", lambda: 3.0)
    writer.write("text", severity="INFO", text="back")
    writer.close()
    entries, damages = read(path)
    assert [entry.time for entry in entries] == [1, 3]
    assert [number for number, _ in damages] == [2]


@given(st.lists(st.binary(max_size=80), max_size=8))
def test_no_damage_keeps_whole_lines_from_being_read(tmp_path_factory, rubbish):
    path = tmp_path_factory.mktemp("boxes") / "Ann.blackbox.ndjson"
    lines = [each.replace(b"\n", b"?") + b"\n" + line(i).encode() for i, each in enumerate(rubbish)]
    path.write_bytes(b"".join(lines))
    entries, _ = read(path)
    assert [entry.time for entry in entries if entry.robot == "Ann"] == list(range(len(rubbish)))
