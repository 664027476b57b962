"""Robots as separate programs, which keep their slots by Zenoh."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import time
from contextlib import ExitStack
from dataclasses import replace

import pytest

from mmrs_core import flight
from mmrs_core.behaviour.program import Transition
from mmrs_core.behaviour.replay import Outcome
from mmrs_core.flight.bus import BusSlots
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import (
    MULTICOPTER,
    move,
    notify,
    program,
    robot_program,
    take_off,
    two_drones,
)

LAND = move("down", "Land", uri=MULTICOPTER)


@pytest.fixture
def endpoint():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def start_all(made, stack, endpoint, first, second, *arguments):
    """Start two controllers, the first of which listens for the other."""
    common = ("--dry-run", *arguments)
    listening = stack.enter_context(made.start(first, *common, "--bus-listen", endpoint))
    calling = stack.enter_context(made.start(second, *common, "--bus-connect", endpoint))
    return listening, calling


def await_line(process: subprocess.Popen[str], words: str) -> None:
    assert any(words in line for line in process.stderr), f"{words} was never said"


def end(process: subprocess.Popen[str]) -> tuple[int, str]:
    try:
        _, said = process.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        process.kill()
        _, said = process.communicate()
        pytest.fail(f"does not end; it said:\n{said}")
    return process.returncode, said


@pytest.mark.parametrize("order", [("robot_alpha.py", "robot_beta.py"), ("robot_beta.py", "robot_alpha.py")])
def test_separate_programs_synchronise_and_their_logs_replay(controllers, endpoint, order):
    made = controllers(two_drones())
    with ExitStack() as stack:
        for process in start_all(made, stack, endpoint, *order, "--speedup", "50"):
            code, said = end(process)
            assert code == 0, said
    result = made.replayed()
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_what_a_robot_was_told_is_on_its_disk(controllers, endpoint):
    made = controllers(two_drones())
    with ExitStack() as stack:
        for process in start_all(made, stack, endpoint, "robot_alpha.py", "robot_beta.py", "--speedup", "50"):
            assert end(process)[0] == 0
    (told,) = map(json.loads, (made.logs / "beta.slots.ndjson").read_text("ascii").splitlines())
    assert (told["sender"], told["slots"], told["active"]) == ("alpha", ["go"], True)


def waiting(*policies: Policy):
    """Return a robot that waits for ever, and one that stays long before it would tell it to go on."""
    giver = robot_program("alpha", [take_off("up", 5.0), move("stay", "HoldPosition", duration=600.0), LAND])
    moves = (*giver.moves[:2], replace(giver.moves[2], after=(notify(("beta", "go")),)), *giver.moves[3:])
    taker = robot_program(
        "beta",
        [take_off("up", 5.0), LAND],
        home=(50.0, 0.0, 0.0),
        slots=("go",),
        transitions={1: Transition(1, 2, waits=("go",))},
    )
    return program(replace(giver, moves=moves), replace(taker, policies=policies))


def test_a_robot_notices_that_a_peer_was_killed(controllers, endpoint):
    made = controllers(waiting(Policy("PEER_LOST", "LAND", 3.0)))
    with ExitStack() as stack:
        alpha, beta = start_all(made, stack, endpoint, "robot_alpha.py", "robot_beta.py", "--speedup", "5")
        await_line(beta, "waits for 'go'")
        await_line(alpha, "'stay'")
        time.sleep(1.5)
        alpha.send_signal(signal.SIGKILL)
        code, said = end(beta)
    assert code == 1
    assert "PEER_LOST" in said
    assert made.replayed(partial=True).faults == {"beta": "PEER_LOST"}


def test_a_notification_that_nobody_answers_is_a_lost_peer(controllers, endpoint):
    robot = replace(two_drones().robots[0], policies=(Policy("PEER_LOST", "LAND", 20.0),))
    made = controllers(replace(two_drones(), robots=(robot, two_drones().robots[1])))
    with ExitStack() as stack:
        common = ("--dry-run", "--bus-listen", endpoint, "--speedup", "50")
        code, said = end(stack.enter_context(made.start("robot_alpha.py", *common)))
    assert code == 1
    assert "no answer from 'beta'" in said


def test_notifications_of_another_run_are_not_heard(controllers, endpoint, tmp_path):
    made = controllers(waiting(Policy("WAIT_TOO_LONG", "LAND", 100.0)))
    other = ("--dry-run", "--speedup", "200", "--run", "other", "--log", str(tmp_path / "other"))
    with ExitStack() as stack:
        beta = stack.enter_context(
            made.start("robot_beta.py", "--dry-run", "--speedup", "20", "--bus-listen", endpoint)
        )
        alpha = stack.enter_context(made.start("robot_alpha.py", *other, "--bus-connect", endpoint))
        assert end(beta)[0] == 1
        alpha.send_signal(signal.SIGTERM)
        end(alpha)
    assert made.replayed(partial=True).faults == {"beta": "WAIT_TOO_LONG"}


def send(endpoint: str, key: str, content: dict[str, object]) -> bool:
    """Command the owner of slots as another program may; return whether it says that it did."""
    import zenoh

    config = zenoh.Config()
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    with zenoh.open(config) as session:
        replies = list(session.get(key, payload=json.dumps(content), timeout=5.0))
        return any(reply.ok is not None for reply in replies)


@pytest.fixture
def owner(endpoint, tmp_path):
    """Return slots of a robot that 'alpha' may set, the key of their owner, and its journal."""
    robot = flight.Robot(
        id="beta",
        log="beta.jsonl",
        vehicle="copter",
        home=flight.Local(0.0, 0.0, 0.0),
        start="start",
        steps=(),
        slots=("go",),
        senders=(("go", ("alpha",)),),
        resets=(("go", ("alpha",)),),
        mission="survey",
    )
    slots = BusSlots([robot], "run-0", tmp_path, [endpoint], [])
    yield slots, slots._key("beta", "slots"), tmp_path / "beta.slots.ndjson"
    slots.close()


COMMAND = {"sender": "alpha", "incarnation": "1", "number": 1, "lamport": 5, "slots": ["go"], "active": True}


def test_a_command_that_comes_twice_is_applied_once_and_answered_twice(owner, endpoint):
    slots, key, journal = owner
    assert send(endpoint, key, COMMAND)
    assert send(endpoint, key, COMMAND)
    assert len(journal.read_text("ascii").splitlines()) == 1
    assert slots.take("beta", ["go"], lambda lamport: None)


def test_a_late_command_that_comes_again_does_not_undo_a_newer_one(owner, endpoint):
    slots, key, _ = owner
    assert send(endpoint, key, COMMAND)
    assert send(endpoint, key, {**COMMAND, "number": 2, "active": False})
    assert send(endpoint, key, COMMAND)
    assert not slots.take("beta", ["go"], lambda lamport: None)


def test_logical_time_goes_beyond_what_was_heard(owner, endpoint):
    slots, key, _ = owner
    send(endpoint, key, COMMAND)
    assert slots.tick() > 5


@pytest.mark.parametrize(
    "forged",
    [
        {**COMMAND, "sender": "gamma"},
        {**COMMAND, "sender": "gamma", "active": False},
        {**COMMAND, "slots": ["land"]},
        {"sender": "alpha"},
        [],
    ],
)
def test_a_command_by_whom_it_is_not_for_changes_nothing(owner, endpoint, forged):
    slots, key, journal = owner
    assert not send(endpoint, key, forged)
    assert not journal.exists()
    assert not slots.take("beta", ["go"], lambda lamport: None)
