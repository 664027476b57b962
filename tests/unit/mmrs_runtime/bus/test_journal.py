"""What survives on a disk that has no room for a while."""

import json
import resource
from contextlib import contextmanager

import pytest

from mmrs_runtime.bus.journal import FileJournal


@contextmanager
def room_for(number):
    """Have no file of this process grow beyond so many bytes: what is written beyond is cut off."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (number, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "b.slots.ndjson"


@pytest.mark.parametrize("left", [0, 1, 7])
def test_a_line_that_was_cut_off_does_not_spoil_the_next(path, left):
    journal = FileJournal(path)
    journal.keep({"n": 1})
    with room_for(path.stat().st_size + left), pytest.raises(OSError, match=r"No space|too large"):
        journal.keep({"n": 2, "long": "x" * 100})
    journal.keep({"n": 3})
    assert [json.loads(line)["n"] for line in path.read_text().splitlines()] == [1, 3]
    assert [line["n"] for line in FileJournal(path).lines()] == [1, 3]


def test_a_line_that_was_cut_off_is_none_for_who_starts_again(path):
    journal = FileJournal(path)
    journal.keep({"n": 1})
    with room_for(path.stat().st_size + 5), pytest.raises(OSError, match=r"No space|too large"):
        journal.keep({"n": 2})
    assert [line["n"] for line in FileJournal(path).lines()] == [1]
