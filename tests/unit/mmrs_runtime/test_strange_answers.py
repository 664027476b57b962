"""Whoever gives an order is told where something else than a process of robots answers."""

import json
import socket
import threading
from contextlib import ExitStack, suppress

import pytest

from mmrs_runtime.orders.channels import Unreachable
from mmrs_runtime.orders.ordering import give, main

pytestmark = pytest.mark.real_time("parts of flights")


@pytest.fixture
def stranger(tmp_path):
    """Return a function that has something other than a process of robots listen where one is announced."""
    with ExitStack() as stack:
        server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        server.settimeout(10.0)
        facts = {"port": server.getsockname()[1], "token": "", "robots": ["gamma"]}
        (tmp_path / "control-1.json").write_text(json.dumps(facts), "ascii")

        def serve(answer):
            caller, _ = server.accept()
            with caller, suppress(OSError):
                caller.recv(4096)
                caller.sendall(answer)

        def answers(answer):
            thread = threading.Thread(target=serve, args=(answer,))
            thread.start()
            stack.callback(thread.join)

        yield answers


HELD = {"robot": "gamma", "order": "hold", "confirmed": True, "seconds": 1.0, "why": ""}


@pytest.mark.parametrize(
    "answer",
    [
        b"5",
        b"null",
        b"{}",
        b"[" * 100_000,
        b'{"error": 5}',
        b'{"done": true}',
        b"HTTP/1.1 400 Bad Request",
        b"\xff\xfe",
        b"x" * (1 << 21),
        *(
            json.dumps(HELD | wrong).encode()
            for wrong in (
                {"robot": ["gamma"]},
                {"robot": "alpha"},
                {"order": "land"},
                {"confirmed": 1},
                {"seconds": "x"},
                {"seconds": float("inf")},
                {"seconds": 10**400},
                {"why": 5},
            )
        ),
    ],
)
def test_what_no_process_of_robots_answers_is_told_as_that(tmp_path, stranger, answer):
    stranger(answer + b"\n")
    with pytest.raises(Unreachable, match="'gamma': what answers at its port is not its process"):
        list(give(tmp_path, "hold"))


@pytest.mark.parametrize(
    "wrong", [{"speed": "fast"}, {"energy": []}, {"time": float("inf")}, {"place": {"north": 1.0}}]
)
def test_figures_of_a_robot_that_are_none_are_told_as_that(tmp_path, stranger, wrong):
    stranger(json.dumps({"robot": "gamma", "phase": "works", "move": "m1", **wrong}).encode() + b"\n")
    with pytest.raises(Unreachable, match="'gamma': what answers at its port is not its process"):
        list(give(tmp_path, "status"))


def test_of_figures_that_a_robot_does_not_know_nothing_is_shown(tmp_path, stranger, capsys):
    unknown = {"speed": None, "energy": None, "place": {"north": None, "east": None, "height": 1.0}}
    stranger(json.dumps({"robot": "gamma", "phase": "works", **unknown}).encode() + b'\n{"done": true}\n')
    assert main(["status", "--log", str(tmp_path)]) == 0
    assert capsys.readouterr().out == "'gamma'  works  battery unknown\n"
