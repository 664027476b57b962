"""Steps as lines of logs, and the files that these are written to."""

import json

import jsonschema
import pytest

from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import SCHEMA, StepRecord, faults_of, log_name, merge, step_in, to_line

FIRST = StepRecord("run", "r", 0, 1, 0.0, "begin", "start")
SECOND = StepRecord("run", "r", 1, 2, 0.5, "ntf", "start", "post:0", "+q.s")
OTHER = StepRecord("run", "q", 0, 3, 0.5, "begin", "start")


def good() -> dict[str, object]:
    return json.loads(to_line(SECOND))


def test_steps_are_merged_by_logical_time_then_robot():
    same = StepRecord("run", "a", 0, 1, 9.0, "begin", "start")
    assert merge([SECOND, FIRST, same]) == (same, FIRST, SECOND)


@pytest.mark.parametrize(
    "robot", ["../../etc/passwd", ".", "..", "a/b", "a\\b", "", "x" * 5000, "Röhre 7", "a\nb", "con.jsonl"]
)
def test_the_name_of_a_log_stays_in_its_folder_whatever_the_robots_name(robot, tmp_path):
    name = log_name(robot)
    path = tmp_path / name
    path.write_text("")
    assert path.resolve().parent == tmp_path.resolve()
    assert name.endswith(".jsonl")
    assert name.count(".") == 1


def test_different_robots_have_different_logs():
    names = ["a b", "a_b", "a%20b", "a", "A", "x" * 5000, "x" * 5001, "a.b", ""]
    assert len({log_name(name) for name in names}) == len(names)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("run", ""),
        ("run", 7),
        ("robot", None),
        ("seq", -1),
        ("seq", 1.5),
        ("seq", True),
        ("lamport", "3"),
        ("time", -0.1),
        ("time", "0"),
        ("time", False),
        ("label", "jump"),
        ("move", ""),
        ("detail", 1),
        ("slot", []),
        ("extra", 1),
    ],
)
def test_reader_and_schema_refuse_the_same_lines(field, value):
    schema = json.loads(SCHEMA.read_text())
    line = {**good(), field: value}
    assert faults_of(line)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(line, schema)


@pytest.mark.parametrize("field", list(good()))
def test_reader_and_schema_miss_the_same_fields(field):
    line = good()
    del line[field]
    assert faults_of(line) == (f"{field}: missing",)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(line, json.loads(SCHEMA.read_text()))


@pytest.mark.parametrize("record", [FIRST, SECOND, OTHER])
def test_what_is_written_keeps_the_schema(record):
    jsonschema.validate(json.loads(to_line(record)), json.loads(SCHEMA.read_text()))


def test_a_step_is_read_as_it_was_written():
    step = StepRecord("rün", "r", 1, 2, 0.123456, "ntf", "start", "post:0", "+q.s")
    assert step_in(to_line(step)) == step


def test_logs_are_written_to_the_byte_as_ever(tmp_path):
    with LogWriter(tmp_path) as log:
        log.write(StepRecord("run", "Ä", 0, 1, 0.123456, "begin", "über"))
    assert (tmp_path / log_name("Ä")).read_bytes() == (
        '{"run":"run","robot":"Ä","seq":0,"lamport":1,"time":0.123456,"label":"begin","move":"über",'
        '"detail":"","slot":""}\n'
    ).encode()
