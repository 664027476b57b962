"""The gateway as programs without Zenoh see it: one line of JSON, one answer."""

from __future__ import annotations

import json
import os
import signal
import socket
import stat
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
from stalls import Stalls
from waiting_pair import waiting_pair

from mmrs_core import pipeline
from mmrs_core.flight.bus import CommandId
from mmrs_core.flight.bus.carriers.over_zenoh import Endpoints, ZenohCarrier
from mmrs_core.languages.reading import read_model
from mmrs_core.runtime.slots import node_of

RUN = "run-0"
LEASE = 1.5


@pytest.fixture(scope="module")
def behaviour(tmp_path_factory):
    """Return the file of a behaviour in which 'a' and 'b' wait for each other."""
    file = tmp_path_factory.mktemp("models") / "pair.xmi"
    file.write_text(waiting_pair("rover", taken_back=True))
    return file


class Client:
    """A socket, as a program in C would have it."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10.0)
        self._lines = self.socket.makefile("rb")

    def say(self, line: object) -> None:
        self.socket.sendall(json.dumps(line).encode() + b"\n")

    def hear(self, what: str) -> dict:
        """Return the next line that says that; news of other things is passed over."""
        while line := self._lines.readline():
            found = json.loads(line)
            if found["is"] == what:
                return found
            assert found["is"] in ("changed", "waiting"), found
        raise AssertionError(f"{what} was never said")

    def ask(self, line: object, what: str) -> dict:
        self.say(line)
        return self.hear(what)

    def close(self) -> None:
        self._lines.close()
        self.socket.close()


@pytest.fixture
def gateway(behaviour, ends, tmp_path):
    """Return the process of a gateway for 'a', and what its file says."""
    command = [sys.executable, "-m", "mmrs_core", "bus", "gateway", str(behaviour), "--robot", "a"]
    command += ["--log", str(tmp_path / "logs"), "--listen", f"tcp/127.0.0.1:{ends.ports['a']}"]
    file = tmp_path / "logs" / "gateway.json"
    with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
        until = time.monotonic() + 20
        while not file.exists():
            assert process.poll() is None and time.monotonic() < until  # noqa: PT018
            time.sleep(0.01)
        yield process, file
        with suppress(ProcessLookupError):
            process.kill()


@pytest.fixture
def client(gateway):
    """Return a client that has said hello."""
    told = json.loads(gateway[1].read_text())
    made = Client(told["port"])
    made.ask({"do": "hello", "token": told["token"]}, "welcome")
    yield made
    made.close()


@pytest.fixture
def peer(behaviour, contributions, ends, tmp_path):
    """Return the bus of robot 'b', by Zenoh in this process."""
    program = pipeline.program_of(read_model(behaviour, contributions.languages).roots[0], contributions)
    reached = Endpoints(connect=(f"tcp/127.0.0.1:{ends.ports['a']}",))
    carrier = ZenohCarrier("pair", RUN, ("a", "b"), reached, plan=program.fingerprint)
    node = node_of(program, ["b"], RUN, tmp_path / "b", carrier, None)
    yield node
    node.close()


def test_a_program_sets_slots_and_is_told_step_by_step(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    client.say({"do": "prepare", "number": 1, "slots": [["b", "go"]], "active": True})
    client.hear("asked")
    granted = client.hear("granted")
    assert not peer.state(("b", "go")).active
    client.ask({"do": "send", "number": 1, "lamport": granted["lamport"] + 3}, "sent")
    assert client.hear("acknowledged")["number"] == 1
    assert peer.state(("b", "go")).active
    assert peer.state(("b", "go")).lamport == granted["lamport"] + 3


def test_a_program_waits_for_its_slots_and_is_told_of_news(client, peer, until, notify):
    until(lambda: not peer.missing(["a"]))
    assert not client.ask({"do": "state"}, "state")["slots"]["ready"]["active"]
    delivery = peer.prepare(CommandId(RUN, "b", "", 1), (("a", "ready"),), True)
    until(lambda: delivery.lamport is not None)
    delivery.send(delivery.lamport)
    until(lambda: not delivery.waiting)
    found = client.ask({"do": "state"}, "state")["slots"]["ready"]
    assert found["active"]
    client.ask({"do": "pass", "slots": ["ready"], "lamport": found["lamport"]}, "held")
    client.ask({"do": "pass", "slots": ["ready"], "lamport": found["lamport"] + 1}, "passed")


def test_what_was_detected_goes_with_notifies_over_the_bus_and_through_the_gateway(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    finds = [["buoy", [1.0, 2.0, -3.0]]]
    client.say({"do": "prepare", "number": 1, "slots": [["b", "go"]], "active": True, "finds": finds})
    client.hear("asked")
    client.ask({"do": "send", "number": 1, "lamport": client.hear("granted")["lamport"]}, "sent")
    client.hear("acknowledged")
    assert peer.finds("b") == (("buoy", (1.0, 2.0, -3.0)),)

    delivery = peer.prepare(CommandId(RUN, "b", "", 1), (("a", "ready"),), True, (("wreck", None),))
    until(lambda: delivery.lamport is not None)
    delivery.send(delivery.lamport)
    until(lambda: not delivery.waiting)
    assert client.ask({"do": "state"}, "state")["finds"] == [["wreck", None]]


def test_a_program_that_goes_is_a_lost_peer(client, peer, until):
    stalls = Stalls()
    until(lambda: not peer.missing(["a"]))
    client.close()
    assert until(lambda: peer.lost(["a"])) < 0.5 + stalls.seconds


def test_a_program_that_hangs_is_a_lost_peer_until_it_speaks_again(gateway, peer, until):
    told = json.loads(gateway[1].read_text())
    client = Client(told["port"])
    client.ask({"do": "hello", "token": told["token"], "alive": 1}, "welcome")
    stalls = Stalls()
    until(lambda: not peer.missing(["a"]))
    seconds = until(lambda: peer.lost(["a"]))
    assert 0.5 - stalls.seconds < seconds < 2.0 + stalls.seconds
    client.ask({"do": "alive"}, "alive")
    until(lambda: not peer.missing(["a"]))
    client.close()


def test_a_program_that_goes_while_it_waits_to_begin_is_a_lost_peer(gateway, client, peer, until):
    stalls = Stalls()
    client.say({"do": "begin", "robots": ["a", "b"], "seconds": 60})
    until(lambda: not peer.missing(["a"]))
    client.close()
    assert until(lambda: peer.lost(["a"])) < 2.0 + stalls.seconds


def test_a_program_that_has_waited_to_begin_was_not_silent(gateway, peer, until):
    told = json.loads(gateway[1].read_text())
    client = Client(told["port"])
    client.ask({"do": "hello", "token": told["token"], "alive": 1}, "welcome")
    until(lambda: not peer.missing(["a"]))
    stalls = Stalls()
    client.ask({"do": "begin", "robots": ["a", "b"], "seconds": 2}, "wrong")
    assert until(lambda: peer.lost(["a"])) > 0.5 - stalls.seconds
    client.close()


@pytest.mark.parametrize("alive", [0, 3601, "1", None])
def test_a_time_to_speak_in_that_is_none_is_refused(gateway, alive):
    told = json.loads(gateway[1].read_text())
    client = Client(told["port"])
    assert "alive" in client.ask({"do": "hello", "token": told["token"], "alive": alive}, "wrong")["why"]
    client.close()


def test_a_gateway_that_is_killed_is_a_lost_peer(gateway, client, peer, until):
    stalls = Stalls()
    until(lambda: not peer.missing(["a"]))
    os.kill(gateway[0].pid, signal.SIGKILL)
    assert until(lambda: peer.lost(["a"])) < 0.5 + stalls.seconds


@pytest.mark.thorough
def test_a_gateway_that_is_frozen_is_a_lost_peer(gateway, client, peer, until):
    until(lambda: not peer.missing(["a"]))
    os.kill(gateway[0].pid, signal.SIGSTOP)
    assert until(lambda: peer.lost(["a"])) < 1.5 * LEASE


@pytest.mark.thorough
def test_a_gateway_without_a_program_keeps_no_robot(gateway, peer):
    time.sleep(1.0)
    assert peer.missing(["a"]) == ("a",)


@pytest.mark.thorough
def test_a_program_notices_that_its_peer_has_gone(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    time.sleep(0.2)
    peer.close()
    until(lambda: client.ask({"do": "lost", "robots": ["b"]}, "lost")["robots"] == ["b"])


def test_a_program_is_told_for_whom_its_notify_waits_and_gives_it_up(client):
    client.ask({"do": "prepare", "number": 1, "slots": [["b", "go"]], "active": True}, "asked")
    assert client.hear("waiting") == {"is": "waiting", "number": 1, "for": ["b"]}
    client.ask({"do": "withdraw", "number": 1}, "withdrawn")


def test_a_program_that_does_not_know_the_token_is_turned_away(gateway):
    client = Client(json.loads(gateway[1].read_text())["port"])
    assert client.ask({"do": "hello", "token": "0" * 32}, "wrong")["why"] == "does not know the token"
    client.close()


def test_only_its_user_can_read_the_token(gateway):
    assert stat.S_IMODE(gateway[1].stat().st_mode) == 0o600


NONSENSE = [
    ({"do": "fly"}, "'fly': nothing that can be done here"),
    ({"do": "prepare", "number": 1, "slots": [], "active": True}, "slots: none"),
    ({"do": "prepare", "number": 1, "slots": ["go"], "active": True}, "slots: no lists"),
    ({"do": "prepare", "number": 1, "slots": 5, "active": True}, "slots: no list of 1 to"),
    ({"do": "prepare", "number": 1, "slots": None, "active": True}, "slots: no list of 1 to"),
    ({"do": "prepare", "number": 1, "slots": {"b": "go"}, "active": True}, "slots: no list of 1 to"),
    ({"do": "prepare", "number": 1, "slots": [["Nobody", "go"]], "active": True}, "'a' never sets any of"),
    ({"do": "prepare", "number": -1, "slots": [["b", "go"]], "active": True}, "number: no whole"),
    ({"do": "send", "number": 9, "lamport": 3}, "number 9: no such notify"),
    ({"do": "pass", "slots": ["nothing"], "lamport": 3}, "'a' has no slot 'nothing'"),
    ([], "not an object"),
]


def test_what_makes_no_sense_is_answered_and_the_program_stays(client):
    for line, why in NONSENSE:
        assert why in client.ask(line, "wrong")["why"]
    client.ask({"do": "state"}, "state")


def test_what_is_answered_wrong_has_no_effect(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    for number, lamport in ((1, 1 << 52), (2, 1 << 30)):
        client.ask({"do": "prepare", "number": number, "slots": [["b", "go"]], "active": True}, "asked")
        granted = client.hear("granted")["lamport"]
        assert granted < 1 << 21
        client.ask({"do": "send", "number": number, "lamport": lamport}, "wrong")
        client.ask({"do": "pass", "slots": ["ready"], "lamport": lamport}, "wrong")
        client.ask({"do": "send", "number": number, "lamport": granted}, "sent")
        client.hear("acknowledged")


def test_a_number_is_never_used_again(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    client.ask({"do": "prepare", "number": 5, "slots": [["b", "go"]], "active": True}, "asked")
    granted = client.hear("granted")
    client.ask({"do": "send", "number": 5, "lamport": granted["lamport"]}, "sent")
    client.hear("acknowledged")
    for number in (5, 4):
        again = {"do": "prepare", "number": number, "slots": [["b", "go"]], "active": False}
        assert "not greater than 5" in client.ask(again, "wrong")["why"]


def test_a_line_that_is_too_long_has_one_answer_and_no_tail(client):
    client.socket.sendall(b"x" * 200_000 + b'{"do":"leave"}\n')
    assert "longer than any message" in client.hear("wrong")["why"]
    client.ask({"do": "state"}, "state")


def test_a_gateway_ends_when_it_is_interrupted(gateway, client):
    gateway[0].send_signal(signal.SIGINT)
    assert gateway[0].wait(10.0) == 0
    assert not gateway[1].exists()


def test_a_program_that_comes_again_without_saying_so_is_turned_away(gateway, client):
    client.ask({"do": "prepare", "number": 1, "slots": [["b", "go"]], "active": True}, "asked")
    client.close()
    told = json.loads(gateway[1].read_text())
    again = Client(told["port"])
    assert "earlier start" in again.ask({"do": "hello", "token": told["token"]}, "wrong")["why"]
    again.close()
    resumed = Client(told["port"])
    hello = {"do": "hello", "token": told["token"], "resumed": {"lamport": 7, "notifies": []}}
    assert resumed.ask(hello, "welcome")["slots"] == ["ready"]
    resumed.close()


def test_a_program_that_has_done_nothing_begins_anew(gateway, client):
    client.close()
    told = json.loads(gateway[1].read_text())
    again = Client(told["port"])
    assert again.ask({"do": "hello", "token": told["token"]}, "welcome")["slots"] == ["ready"]
    again.close()


def test_the_session_on_the_page_goes_as_it_says(gateway, peer, until):
    """Each line that the page says to send is sent, and each that it says comes is awaited."""
    told = json.loads(gateway[1].read_text())
    client = Client(told["port"])
    for line in SESSION:
        content = json.loads(line[2:].replace("TOKEN", told["token"]))
        if line.startswith(">"):
            client.say(content)
        else:
            assert client.hear(content["is"]) == content
        if content.get("is") == "welcome":
            set_ready(peer, until)
    client.close()
    assert peer.state(("b", "go")).active


PAGE = Path(__file__).parents[3] / "docs" / "how-to" / "bus.md"
SESSION = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith(("> {", "< {"))]


def set_ready(peer, until) -> None:
    """Set the slot 'ready' of 'a' at logical time 4."""
    until(lambda: not peer.missing(["a"]))
    peer.use(3)
    delivery = peer.prepare(CommandId(RUN, "b", "", 1), (("a", "ready"),), True)
    until(lambda: delivery.lamport is not None)
    delivery.send(4)
    until(lambda: not delivery.waiting)


def connected(gateway) -> Client:
    return Client(json.loads(gateway[1].read_text())["port"])


def test_those_who_say_nothing_keep_no_program_waiting(gateway):
    silent = [connected(gateway) for _ in range(200)]
    token = json.loads(gateway[1].read_text())["token"]
    last = connected(gateway)
    last.socket.settimeout(4.0)
    last.ask({"do": "hello", "token": token}, "welcome")
    for each in (*silent, last):
        each.close()


def test_a_hello_that_comes_in_drops_is_turned_away_in_time(gateway):
    dripping = connected(gateway)
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


def test_a_second_program_is_told_of_the_first(gateway, client):
    second = connected(gateway)
    told = second.ask({"do": "hello", "token": json.loads(gateway[1].read_text())["token"]}, "wrong")
    assert told["why"] == "another program speaks for 'a' already"
    client.ask({"do": "alive"}, "alive")
    second.close()


def test_a_program_that_reads_nothing_is_a_lost_peer(gateway, peer, until):
    deaf = connected(gateway)
    hello = {"do": "hello", "token": json.loads(gateway[1].read_text())["token"], "alive": 1}
    deaf.ask(hello, "welcome")
    until(lambda: not peer.missing(["a"]))
    with suppress(OSError):
        while not peer.lost(["a"]):
            deaf.socket.sendall(b'{"do": "state"}\n' * 1000)
    until(lambda: peer.lost(["a"]))
    deaf.close()


def test_a_hello_with_what_cannot_be_is_refused_in_words(gateway):
    token = json.loads(gateway[1].read_text())["token"]

    def answer(**hello: object) -> str:
        made = connected(gateway)
        why = made.ask({"do": "hello", "token": token, **hello}, "wrong")["why"]
        made.close()
        return why

    assert answer(token="\ud800") == "does not know the token"
    for lamport in (-5, 10**20, 1 << 51 | 1):
        resumed = {"lamport": 3, "notifies": [["b", "go", True, lamport]]}
        assert "lamport" in answer(resumed=resumed)


def test_a_notify_that_is_sent_before_it_was_granted_is_told_as_that(client):
    client.ask({"do": "prepare", "number": 1, "slots": [["b", "go"]], "active": True}, "asked")
    assert (
        client.ask({"do": "send", "number": 1, "lamport": 9}, "wrong")["why"]
        == "number 1: is not granted yet"
    )
