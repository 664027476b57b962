import json
import resource
from contextlib import contextmanager
from math import nan

import pytest

from mmrs_mavlink.program import Geographic
from mmrs_runtime.records.blackbox import BlackBox, black_box_path, last_time, plan_of


@pytest.fixture
def path(tmp_path):
    return black_box_path(tmp_path / "logs/alpha.jsonl")


@pytest.fixture
def opened(path):
    """Return a function that opens the box; it is closed when the test is over."""
    boxes = []

    def open_box(**options):
        boxes.append(BlackBox(path, "run-0", "alpha", lambda: 1.5, **options))
        return boxes[-1]

    yield open_box
    for box in boxes:
        box.close()


def lines(path):
    return [json.loads(line) for line in path.read_text("ascii").splitlines()]


def test_every_line_says_whose_it_is_and_when_it_was_written(path, opened):
    opened().write("fix", place=Geographic(42.0, 13.0, 5.0), energy=None)
    (line,) = lines(path)
    assert path.name == "alpha.blackbox.ndjson"
    assert (line["run"], line["robot"], line["time"], line["kind"]) == ("run-0", "alpha", 1.5, "fix")
    assert line["place"] == {"latitude": 42.0, "longitude": 13.0, "height": 5.0}
    assert line["wall"].endswith("Z")


def test_what_is_no_number_is_null(path, opened):
    opened().write("measured", name="CO2", content={"result": nan})
    assert lines(path)[0]["content"] == {"result": None}


def test_a_full_file_is_put_aside_under_the_next_number(path, opened):
    box = opened(largest=400)
    for number in range(8):
        box.write("text", severity="INFO", text=f"line {number}")
    parts = sorted(path.parent.glob("alpha.blackbox.*.ndjson"))
    assert [part.name for part in parts][:2] == ["alpha.blackbox.0001.ndjson", "alpha.blackbox.0002.ndjson"]
    assert [line["text"] for part in (*parts, path) for line in lines(part)] == [
        f"line {n}" for n in range(8)
    ]
    assert all(part.stat().st_size <= 400 for part in (*parts, path))


def test_what_was_cut_off_stays_a_line_of_its_own(path, opened):
    path.parent.mkdir()
    path.write_bytes(b'{"run": "run-0", "ro')
    opened().write("text", severity="INFO", text="again")
    assert json.loads(path.read_text("ascii").splitlines()[1])["text"] == "again"


def test_a_box_that_cannot_be_written_is_said_once_and_stops_nothing(path, opened):
    path.parent.write_text("not a folder", "ascii")
    said = []
    box = opened(say=said.append)
    box.write("text", text="one")
    box.write("text", text="two")
    (line,) = said
    assert "alpha.blackbox.ndjson: the black box cannot be written" in line


@pytest.fixture
def full_disk():
    """Return a function that gives a context in which no file of this process grows."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)

    @contextmanager
    def full():
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)

    return full


def test_what_was_decided_while_the_disk_was_full_is_written_once_it_is_not(path, opened, full_disk):
    box = opened(say=lambda line: None)
    box.write("text", text="before")
    with full_disk():
        box.write("decision", what="LOG_FAILED")
        box.write("fix", energy=0.5)
    box.write("fix", energy=0.4)
    assert [(each["kind"], each.get("energy")) for each in lines(path)] == [
        ("text", None),
        ("decision", None),
        ("fix", 0.4),
    ]


def test_what_was_decided_while_the_disk_was_full_is_written_when_the_box_is_closed(path, opened, full_disk):
    box = opened(say=lambda line: None)
    with full_disk():
        box.write("decision", what="LOG_FAILED")
    box.close()
    assert [each["kind"] for each in lines(path)] == ["decision"]


@pytest.mark.parametrize("more", ["", '{"time": 99', "rubbish\n", '{"time": "late"}\n', '{"time": NaN}\n'])
def test_the_end_of_a_box_is_the_time_of_its_last_whole_line(path, opened, more):
    opened().write("text", text="one")
    with path.open("a") as file:
        file.write(more)
    assert last_time(path) == 1.5


def test_a_box_that_is_not_there_has_no_end(path):
    assert last_time(path) == 0.0


def test_the_plan_that_a_box_began_with_is_that_of_its_oldest_part(path, opened):
    box = opened(largest=100)
    box.write("start", plan="first")
    for _ in range(3):
        box.write("text", text="full")
    box.write("start", plan="second")
    assert plan_of(path) == "first"


def test_a_box_without_a_plan_is_of_any(path, opened):
    opened().write("start", link=None)
    assert plan_of(path) == plan_of(path.with_name("absent")) == ""
