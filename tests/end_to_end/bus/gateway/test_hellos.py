"""Who may speak to a gateway, and in which order."""

import json
import socket
import stat
import threading
import time
from contextlib import ExitStack, suppress

import pytest

from mmrs_runtime.bus.gateway.server import MOST_CALLERS, Gateway

pytestmark = pytest.mark.real_time("buses")


def test_only_its_user_can_read_the_token(gateway):
    assert stat.S_IMODE(gateway.file.stat().st_mode) == 0o600


def test_a_program_that_does_not_know_the_token_is_turned_away(gateway):
    with gateway.connect() as client:
        answer = client.ask(gateway.hello(token="0" * 32), "wrong")
        assert answer["why"] == "does not know the token"


@pytest.mark.parametrize("alive", [0, 3601, "1", None])
def test_a_time_to_speak_in_that_is_none_is_refused(gateway, alive):
    with gateway.connect() as client:
        assert "alive" in client.ask(gateway.hello(alive=alive), "wrong")["why"]


def test_a_hello_with_what_cannot_be_is_refused_in_words(gateway):
    def answer(**more: object) -> str:
        with gateway.connect() as client:
            return client.ask(gateway.hello(**more), "wrong")["why"]

    assert answer(token="\ud800") == "does not know the token"
    for lamport in (-5, 10**20, 1 << 51 | 1):
        resumed = {"lamport": 3, "notifies": [["b", "go", True, lamport]]}
        assert "lamport" in answer(resumed=resumed)


def test_a_program_that_comes_again_without_saying_so_is_turned_away(gateway, client):
    client.ask({"do": "prepare", "number": 1, "slots": [["b", "go"]], "active": True}, "asked")
    client.close()
    with gateway.connect() as again:
        assert "earlier start" in again.ask(gateway.hello(), "wrong")["why"]
    with gateway.connect() as resumed:
        hello = gateway.hello(resumed={"lamport": 7, "notifies": []})
        assert resumed.ask(hello, "welcome")["slots"] == ["ready"]


def test_a_program_that_has_done_nothing_begins_anew(gateway, client):
    client.close()
    with gateway.connect() as again:
        assert again.ask(gateway.hello(), "welcome")["slots"] == ["ready"]


def test_a_second_program_is_told_of_the_first(gateway, client):
    with gateway.connect() as second:
        told = second.ask(gateway.hello(), "wrong")
    assert told["why"] == "another program speaks for 'a' already"
    client.ask({"do": "alive"}, "alive")


def test_those_who_say_nothing_keep_no_program_waiting(gateway):
    silent = [gateway.connect() for _ in range(200)]
    with gateway.connect() as last:
        last.socket.settimeout(4.0)
        last.ask(gateway.hello(), "welcome")
    for each in silent:
        each.close()


@pytest.fixture
def patient(tmp_path):
    """Return a gateway of this process that waits a minute for a hello."""
    made = Gateway("a", "run-0", lambda recorded: pytest.fail("none comes"), tmp_path, hello_seconds=60.0)
    serving = threading.Thread(target=made.serve, args=(print,))
    serving.start()
    yield made
    made.close()
    serving.join()


def test_of_those_who_say_nothing_only_few_are_kept(patient):
    with ExitStack() as stack:
        address = ("127.0.0.1", patient.port)
        silent = [
            stack.enter_context(socket.create_connection(address, 10.0)) for _ in range(3 * MOST_CALLERS)
        ]
        for each in silent[:-MOST_CALLERS]:
            assert json.loads(stack.enter_context(each.makefile("rb")).readline())["is"] == "wrong"


def test_a_hello_that_comes_in_drops_is_turned_away_in_time(gateway):
    dripping = gateway.connect()
    begun = time.monotonic()
    with suppress(TimeoutError):
        dripping.socket.settimeout(0.5)
        while time.monotonic() - begun < 15.0:
            dripping.socket.sendall(b" ")
            try:
                said = dripping.socket.recv(1000)
                break
            except TimeoutError:
                said = b""
    assert json.loads(said) == {"is": "wrong", "why": "says no hello within 5 s"}
    dripping.close()
