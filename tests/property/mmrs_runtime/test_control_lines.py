"""Whatever a client of the control channel sends, it is answered in JSON, and the channel goes on."""

import json
import socket

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from mmrs_runtime.control import LONGEST_LINE, Control
from mmrs_runtime.orders.orders import ORDERS, Orders

ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(st.characters(), max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)
ROBOTS = st.lists(st.sampled_from(["alpha", "beta", "\ud800"]), max_size=3)
PARTS = {
    "order": st.sampled_from([*ORDERS]) | ANYTHING,
    "robots": ROBOTS | ANYTHING,
    "seconds": st.floats() | ANYTHING,
    "question": ANYTHING,
    "answer": ANYTHING,
}


@pytest.fixture(scope="module")
def channel(tmp_path_factory):
    """Return a function that sends a line to robots that refuse everything, and returns what is answered."""
    folder = tmp_path_factory.mktemp("logs")
    orders = Orders()
    orders.close("its program has ended")
    control = Control(folder, "run-0", ("alpha", "beta"), orders, lambda robot: {"mode": "guided"})
    facts = json.loads((folder / "control.json").read_text("ascii"))

    def send(line: bytes) -> list[dict[str, object]]:
        with (
            socket.create_connection(("127.0.0.1", facts["port"]), 10.0) as connection,
            connection.makefile("rb") as file,
        ):
            connection.sendall(line + b"\n")
            said = [json.loads(file.readline())]
            while not {"done", "error"} & {*said[-1]}:
                said.append(json.loads(file.readline()))
            return said

    yield send, facts["token"]
    control.close()


@given(st.fixed_dictionaries({}, optional=PARTS))
@example({"order": []})
@example({"order": {}})
@example({"order": "land", "robots": [[]]})
@example({"order": "answer", "question": "\ud800", "answer": True})
def test_every_order_is_obeyed_or_refused_in_words(channel, content):
    send, token = channel
    said = send(json.dumps({"token": token, **content}).encode())
    if "error" in said[-1]:
        assert len(said) == 1
        assert said[0]["error"]
    else:
        names = content.get("robots", ["alpha", "beta"])
        assert {reply["robot"] for reply in said[:-1]} == {*names}


@given(ANYTHING.map(lambda each: json.dumps(each).encode()) | st.binary(max_size=50))
@example(b"[" * (LONGEST_LINE - 10))
@example(b'{"token": "\\ud800"}')
@example(b'{"token": ["a"]}')
def test_any_line_without_the_token_is_refused_in_words(channel, line):
    send, _ = channel
    assert "error" in send(line)[0]


@pytest.mark.parametrize("robots", [[], 0, "", {}, False, None])
def test_an_order_to_no_robots_is_no_order_to_all(channel, robots):
    send, token = channel
    said = send(json.dumps({"token": token, "order": "land", "robots": robots}).encode())
    assert said == [{"error": "robots: must be a list of names"}]
