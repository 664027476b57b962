"""Robots as separate programs, which keep their slots by Zenoh."""

import json
import signal
import subprocess
import time
from contextlib import ExitStack
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, robot_program, take_off, two_drones
from ports import free_endpoint
from warm_python import FREEZE, THAW

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Transition
from mmrs_core.behaviour.replay import replay
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import move, notify, program
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("controllers")


@pytest.fixture
def endpoint():
    return free_endpoint()


def start_all(made, stack, endpoint, first, second, *arguments):
    """Start two controllers, the first of which listens for the other; they end with the stack."""
    common = ("--dry-run", *arguments)
    listening = stack.enter_context(made.start(first, *common, "--bus-listen", endpoint))
    stack.callback(listening.kill)
    calling = stack.enter_context(made.start(second, *common, "--bus-connect", endpoint))
    stack.callback(calling.kill)
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


@pytest.mark.thorough
def test_what_a_robot_was_told_is_on_its_disk(controllers, endpoint):
    made = controllers(two_drones())
    with ExitStack() as stack:
        for process in start_all(made, stack, endpoint, "robot_alpha.py", "robot_beta.py", "--speedup", "50"):
            assert end(process)[0] == 0
    lines = map(json.loads, (made.logs / "beta.slots.ndjson").read_text("ascii").splitlines())
    (told,) = (line for line in lines if line.get("do") == "commit")
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


@pytest.mark.thorough
def test_a_robot_notices_that_a_peer_is_frozen_and_does_not_wait_for_it_at_the_end(controllers, endpoint):
    made = controllers(waiting(Policy("PEER_LOST", "LAND", 3.0)))
    with ExitStack() as stack:
        alpha, beta = start_all(made, stack, endpoint, "robot_alpha.py", "robot_beta.py", "--speedup", "5")
        await_line(beta, "waits for 'go'")
        await_line(alpha, "'stay'")
        time.sleep(1.0)
        alpha.send_signal(FREEZE)
        begun = time.monotonic()
        code, said = end(beta)
        taken = time.monotonic() - begun
        alpha.send_signal(THAW)
        alpha.kill()
        alpha.communicate()
    assert (code, "PEER_LOST" in said) == (1, True)
    assert taken < 8.0


def test_a_notification_that_nobody_answers_is_a_lost_peer(controllers, endpoint):
    robot = replace(two_drones().robots[0], policies=(Policy("PEER_LOST", "LAND", 20.0),))
    made = controllers(replace(two_drones(), robots=(robot, two_drones().robots[1])))
    with ExitStack() as stack:
        common = ("--dry-run", "--bus-listen", endpoint, "--speedup", "50")
        code, said = end(stack.enter_context(made.start("robot_alpha.py", *common)))
    assert code == 1
    assert "no answer from beta; beta never came while this robot was there, or had ended before" in said


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


@pytest.mark.parametrize(
    "killed", ["robot_beta.py", pytest.param("robot_alpha.py", marks=pytest.mark.thorough)]
)
def test_a_program_that_was_killed_is_resumed_on_the_bus(controllers, endpoint, killed):
    patient = (Policy("PEER_LOST", "LAND", 1e5),)
    robots = tuple(replace(robot, policies=patient) for robot in waiting().robots)
    made = controllers(replace(waiting(), robots=robots))
    common = ("--dry-run", "--speedup", "150")
    ways = {"robot_alpha.py": ("--bus-listen", endpoint), "robot_beta.py": ("--bus-connect", endpoint)}
    with ExitStack() as stack:
        running = {
            name: stack.enter_context(made.start(name, *common, *way, "--log", str(made.logs / name)))
            for name, way in ways.items()
        }
        await_line(running["robot_beta.py"], "waits for 'go'")
        await_line(running["robot_alpha.py"], "'stay'")
        dead = running[killed]
        dead.kill()
        dead.communicate()
        again = (*common, *ways[killed], "--log", str(made.logs / killed), "--resume")
        running[killed] = stack.enter_context(made.start(killed, *again))
        for process in running.values():
            code, said = end(process)
            assert code == 0, said
    result = replay(made.program, read_logs([made.logs / name for name in ways]))
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


@pytest.mark.parametrize(
    ("response", "codes"), [("LAND", (0, 1)), pytest.param("CONTINUE", (1, 1), marks=pytest.mark.thorough)]
)
def test_a_robot_that_cannot_keep_its_slots_does_as_its_policy_says(controllers, endpoint, response, codes):
    made = controllers(waiting(Policy("LOG_FAILED", response)))
    with ExitStack() as stack:
        names = ("robot_alpha.py", "robot_beta.py")
        alpha, beta = start_all(made, stack, endpoint, *names, "--speedup", "150")
        await_line(beta, "waits for 'go'")
        journal = made.logs / "beta.slots.ndjson"
        journal.unlink()
        journal.mkdir()
        (_, said_alpha), (code, said) = (end(alpha), end(beta))
        assert (alpha.returncode, code) == codes, said_alpha + said
    words = {"LAND": "LOG_FAILED: its slots cannot be kept", "CONTINUE": "no answer from beta"}
    assert words[response] in said_alpha + said
    fault = {"LAND": {"beta": "LOG_FAILED"}, "CONTINUE": {"alpha": "PEER_LOST", "beta": "PEER_LOST"}}
    assert made.replayed(partial=True).faults == fault[response]
    borne = [line["response"] for line in made.box("beta", "decision") if line["what"] == "LOG_FAILED"]
    assert borne == [response]


def test_a_configuration_that_is_none_is_told_with_its_name(controllers, tmp_path):
    file = tmp_path / "bus.json5"
    file.write_text("no configuration")
    code, said = controllers(two_drones()).run("robot_alpha.py", "--dry-run", "--bus-config", str(file))
    assert code == 2
    assert f"{file}: cannot be read as a configuration of Zenoh" in said
