"""Messages of the bus: what is written is read, and nothing else."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_runtime.bus.messages import (
    LARGEST,
    LONGEST,
    MOST_FINDS,
    Abort,
    Answer,
    Begin,
    CommandId,
    Commit,
    Ended,
    Leave,
    Meet,
    Prepare,
    Unreadable,
    answer_in,
    request_in,
    written,
)

NUMBERS = st.integers(0, LARGEST)
NAMES = st.text(max_size=30)
IDS = st.builds(CommandId, NAMES, NAMES, NAMES, NUMBERS)
SLOTS = st.lists(NAMES, min_size=1, max_size=4, unique=True).map(tuple)
PLACES = st.tuples(*[st.floats(-1e6, 1e6)] * 3)
FINDS = st.lists(st.tuples(NAMES, st.none() | PLACES), max_size=3).map(tuple)
REQUESTS = st.one_of(
    st.builds(Prepare, IDS, NUMBERS, SLOTS, st.booleans(), NUMBERS),
    st.builds(Commit, IDS, SLOTS, st.booleans(), NUMBERS, FINDS),
    st.builds(Abort, IDS, NUMBERS),
    st.builds(Begin, IDS, st.lists(st.tuples(NAMES, st.booleans(), NUMBERS), max_size=3).map(tuple)),
    st.builds(Leave, IDS, NUMBERS),
    st.builds(Ended, IDS, st.lists(st.tuples(NAMES, NUMBERS), max_size=3).map(tuple)),
    st.builds(Meet, IDS, NUMBERS),
)


@given(REQUESTS)
def test_every_request_that_is_written_is_read(request):
    assert request_in(written(request)) == request


@given(st.builds(Answer, NAMES, NUMBERS, NAMES, st.floats(0, 1e9), st.floats(0, 1e9)))
def test_every_answer_that_is_written_is_read(answer):
    assert answer_in(written(answer)) == answer


GOOD = json.loads(written(Commit(CommandId("run", "a", "1", 1), ("go",), True, 5)))


@pytest.mark.parametrize(
    "change",
    [
        {"do": "land"},
        {"do": 3},
        {"sender": None},
        {"sender": "x" * 1001},
        {"sequence": -1},
        {"sequence": True},
        {"sequence": 1.5},
        {"sequence": LARGEST + 1},
        {"slots": []},
        {"slots": "go"},
        {"slots": [1]},
        {"slots": ["go"] * 1001},
        {"active": 1},
        {"lamport": "5"},
        {"lamport": -5},
    ],
    ids=str,
)
def test_what_is_no_request_is_refused(change):
    with pytest.raises(Unreadable):
        request_in(json.dumps(GOOD | change))


@pytest.mark.parametrize("text", ["", "[]", "null", "{", "[" * 50_000, '{"do": "commit"}', "\ud800"])
def test_what_is_no_message_is_refused(text):
    with pytest.raises(Unreadable):
        request_in(text)


def test_what_is_too_long_is_refused_unread():
    with pytest.raises(Unreadable, match="longer than any message"):
        request_in(" " * (LONGEST + 1))


@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
        lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    )
)
def test_nothing_but_a_refusal_comes_of_any_json(value):
    try:
        request_in(json.dumps(value))
    except Unreadable:
        return
    raise AssertionError("was read")


@pytest.mark.parametrize(
    "finds",
    [
        3,
        [["float"]],
        [[7, None]],
        [["float", [1.0, 2.0]]],
        [["float", [1.0, 2.0, "deep"]]],
        [["float", [1.0, 2.0, True]]],
        [["float", "there"]],
        [["float", None]] * (MOST_FINDS + 1),
    ],
)
def test_what_was_detected_is_read_only_if_it_is_that(finds):
    text = written(Commit(CommandId("run", "a", "1", 1), ("go",), True, 3))
    with pytest.raises(Unreadable, match="finds"):
        request_in(json.dumps({**json.loads(text), "finds": finds}))


def test_what_was_detected_may_be_left_out():
    sent = Commit(CommandId("run", "a", "1", 1), ("go",), True, 3)
    content = json.loads(written(sent))
    del content["finds"]
    assert request_in(json.dumps(content)) == sent
