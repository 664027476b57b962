"""Who is there: a robot that is killed, frozen or has ended is noticed, and how soon."""

import os
import subprocess
from pathlib import Path

import bus_walking
import pytest
from bus_walking import RUN, exchange
from stalls import Stalls
from warm_python import FREEZE, THAW, python

from mmrs_runtime.bus import Unwelcome
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints
from mmrs_runtime.bus.program_bus import shared_bus

pytestmark = pytest.mark.real_time("buses")

SCRIPT = Path(bus_walking.__file__)
LEASE = 1.5

SETTLED = 2.5
"""Seconds for others to be heard in, also where everything stands still for one of them."""


@pytest.fixture
def watcher(ends, tmp_path):
    """Return the bus of robot 'b', and the endpoint at which it listens."""
    made = exchange()
    endpoint = f"tcp/127.0.0.1:{ends.ports['b']}"
    carrier = ZenohCarrier("m", RUN, ("a", "b"), Endpoints((endpoint,)))
    bus = shared_bus(made.shared, ["b"], RUN, tmp_path / "b", carrier)
    yield bus, endpoint
    bus.close()


@pytest.fixture
def walker(watcher, tmp_path):
    """Return the process of robot 'a', which waits for 'b' for ever."""
    command = [python(), str(SCRIPT), "exchange", "a", str(tmp_path / "a"), "--connect", watcher[1]]
    process = subprocess.Popen(command)
    yield process
    process.kill()
    process.wait()


@pytest.fixture
def seen(watcher, walker, until):
    bus, _ = watcher
    until(lambda: not bus.node.missing(["a"]))
    return bus, walker


def test_a_robot_that_has_never_come_is_missing_and_not_lost(watcher):
    bus, _ = watcher
    assert bus.node.missing(["a"]) == ("a",)
    assert bus.lost(["a"]) == ()


def test_a_killed_robot_is_noticed_at_once(seen, until):
    stalls = Stalls()
    bus, walker = seen
    walker.kill()
    assert until(lambda: bus.lost(["a"])) < 0.5 + stalls.seconds


def test_whoever_waits_is_woken_when_a_robot_is_killed(seen, until):
    bus, walker = seen
    told = []
    bus.on_change(lambda: told.append(bus.lost(["a"])))
    walker.kill()
    until(lambda: ("a",) in told, 2.0)


def test_a_frozen_robot_is_noticed_within_the_lease_and_again_when_it_wakes(seen, until):
    bus, walker = seen
    os.kill(walker.pid, FREEZE)
    assert until(lambda: bus.lost(["a"])) < 1.5 * LEASE
    os.kill(walker.pid, THAW)
    until(lambda: not bus.lost(["a"]))


def test_a_robot_that_has_ended_needs_no_answer(ends, until, notify):
    a, b = ends.open("a"), ends.open("b")
    until(lambda: not a.missing(["b"]) and not b.missing(["a"]))
    b.leave("b")
    b.close()
    until(lambda: a.lost(["b"]))
    assert notify(a, "a", "b")


def test_a_robot_that_is_killed_has_not_ended_and_its_answer_is_awaited(ends, until, notify):
    a, b = ends.open("a"), ends.open("b")
    until(lambda: not a.missing(["b"]) and not b.missing(["a"]))
    b.close()
    until(lambda: a.lost(["b"]))
    assert not notify(a, "a", "b", seconds=1.0)


def test_a_robot_that_another_process_runs_is_refused(ends, until, notify):
    a, b = ends.open("a"), ends.open("b")
    until(lambda: not a.missing(["b"]) and not b.missing(["a"]))
    with pytest.raises(Unwelcome, match=r"'a': another process runs it|'a' was started before in this run"):
        ends.open("a", listens=False, settle=SETTLED)
    assert not b.lost(["a"])
    assert notify(b, "b", "a")


@pytest.mark.thorough
def test_people_are_told_of_a_robot_that_two_processes_run_although_nobody_looked(ends, until):
    told = []
    ends.tell = told.append
    for robot in ("a", "b"):
        ends.open(robot)
    ends.open("a", listens=False)
    twice = "'a': another process runs it on this bus, too: end one of them"
    until(lambda: told.count(twice) == 2, 8.0)
    assert all(line == twice or line.startswith("'b' refuses 'a'") for line in told)


def test_robots_of_another_plan_of_the_mission_are_refused(ends, until):
    told = []
    ends.tell = told.append
    a = ends.open("a", plan="first")
    with pytest.raises(Unwelcome, match="'a': it is on this bus by another plan of the mission"):
        ends.open("b", plan="second", settle=1.0)
    assert a.missing(["b"]) == ("b",)
    try:
        ends.open("c", plan="second")
    except Unwelcome:
        return  # the answer came before 'c' had begun, as it may on a quick machine
    until(lambda: "'a': it is on this bus by another plan of the mission: end one of them" in told, 8.0)


def test_a_robot_that_is_started_afresh_within_a_run_is_refused(ends, until, notify):
    a, b = ends.open("a"), ends.open("b")
    until(lambda: not a.missing(["b"]) and not b.missing(["a"]))
    assert notify(b, "b", "a")
    b.close()
    until(lambda: a.lost(["b"]))
    with pytest.raises(Unwelcome, match="'a': 'b' was started before in this run: resume it from its log"):
        ends.open("b", settle=SETTLED)


def test_nothing_of_another_run_is_heard(ends, notify):
    a, other = ends.open("a"), ends.open("b", run="another")
    assert not notify(a, "a", "b", seconds=1.0)
    assert a.missing(["b"]) == ("b",)
    assert not other.state(("b", "go")).active
