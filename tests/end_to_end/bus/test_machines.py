"""Robots on machines of their own: each has an address and a clock, and the network between them fails."""

import json
import subprocess
import sys
import threading
import time

import bus_asking
import bus_walking
import machines
import pytest

from mmrs_core.behaviour.replay import replay
from mmrs_runtime.semantics import Outcome

pytestmark = [
    pytest.mark.real_time("buses"),
    pytest.mark.thorough,
    pytest.mark.skipif(bool(why := machines.why_not()), reason=why),
]


class Asking:
    """A robot on a machine that notifies others again and again, and what it has said."""

    def __init__(self, made, folder, number, robots, targets):
        here = folder / robots[number]
        here.mkdir()
        others = [f"tcp/{made.address(each)}:7447" for each in range(len(robots)) if each != number]
        words = (robots[number], targets, str(here), "tcp/0.0.0.0:7447", *others)
        command = made.command(number, sys.executable, bus_asking.__file__, *words)
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.here: list[str] = []
        self.took: list[float] = []
        self.answered_at = time.monotonic()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            said = json.loads(line)
            self.here = said.get("here", self.here)
            if "took" in said:
                self.answered_at = time.monotonic()
                self.took.append(said["took"])


@pytest.fixture
def three(tmp_path):
    """Return three machines, and robots there: the second and the third notify each other."""
    made = machines.Machines(3)
    robots = "abc"
    asking = [
        Asking(made, tmp_path, number, robots, targets) for number, targets in enumerate(("", "c", "b"))
    ]
    yield made, asking
    made.close()
    for each in asking:
        each.process.wait()
        each.process.stdout.close()


def test_a_machine_that_is_out_of_reach_keeps_the_others_from_nothing(three, until):
    made, asking = three
    until(lambda: all(len(each.here) == 2 for each in asking) and asking[1].took and asking[2].took)
    for each in asking:
        each.took.clear()
    made.split((0,), (1, 2))
    until(lambda: [each.here for each in asking] == [[], ["c"], ["b"]], seconds=5.0)
    time.sleep(2.0)
    assert max(asking[1].took + asking[2].took) < 1.5
    assert time.monotonic() - max(each.answered_at for each in asking[1:]) < 1.5
    made.heal()
    until(lambda: all(len(each.here) == 2 for each in asking))


class Walking:
    """Robots that step through a behaviour, each on a machine of its own."""

    def __init__(self, made, folder, behaviour, size):
        self.made, self.folder = made, folder
        self.program = bus_walking.BEHAVIOURS[behaviour](size)
        self.robots = [robot.id for robot in self.program.robots]
        self.words = (behaviour, str(size))
        self.runs: dict[int, subprocess.Popen[bytes]] = {}

    def start(self, number, *more):
        behaviour, size = self.words
        robot, others = self.robots[number], [each for each in range(len(self.robots)) if each != number]
        words = [behaviour, robot, str(self.folder / robot), "--size", size, "--seconds", "150"]
        words += ["--listen", "tcp/0.0.0.0:7447", *more]
        for other in others:
            words += ["--connect", f"tcp/{self.made.address(other)}:7447"]
        command = self.made.command(number, sys.executable, bus_walking.__file__, *words)
        self.runs[number] = subprocess.Popen(command)

    def number_of_steps(self, number):
        return len(bus_walking.logged(self.folder / self.robots[number], self.robots[number]))

    def all_have_ended(self):
        return [run.wait(160) for run in self.runs.values()] == [0] * len(self.runs)

    def replayed(self):
        logs = [bus_walking.logged(self.folder / robot, robot) for robot in self.robots]
        return replay(self.program, [record for log in logs for record in log])


@pytest.fixture
def walking(tmp_path):
    """Return what has robots walk through a behaviour, with machines for up to four."""
    made = machines.Machines(4, seed=7)
    begun: list[Walking] = []

    def walk(behaviour, size):
        begun.append(Walking(made, tmp_path, behaviour, size))
        for number in range(len(begun[0].robots)):
            begun[0].start(number, "--pause", "0.2")
        return begun[0]

    yield made, walk
    made.close()
    for each in begun:
        for run in each.runs.values():
            run.wait()


BAD_WAYS = {
    "lossy": machines.Way(delay=0.02, jitter=0.2, loss=0.2, doubled=0.1),
    "slow": machines.Way(delay=0.3, rate=4000.0),
}


@pytest.mark.parametrize("way", BAD_WAYS)
def test_what_is_applied_is_exact_over_a_bad_network(walking, way):
    made, walk = walking
    made.way(BAD_WAYS[way], 0, 1)
    fleet = walk("exchange", 4)
    assert fleet.all_have_ended()
    assert (fleet.replayed().outcome, fleet.replayed().complaints) == (Outcome.SUCCESS, ())


def test_machines_that_lose_power_and_begin_again_go_on_where_they_were(walking, until):
    made, walk = walking
    fleet = walk("exchange", 8)
    for number, steps in ((0, 6), (1, 10), (0, 16)):
        until(lambda number=number, steps=steps: fleet.number_of_steps(number) >= steps)
        made.kill(number)
        fleet.runs[number].wait()
        fleet.start(number, "--pause", "0.2", "--again")
    assert fleet.all_have_ended()
    assert (fleet.replayed().outcome, fleet.replayed().complaints) == (Outcome.SUCCESS, ())


def test_a_network_that_parts_and_an_address_that_changes_lose_and_double_nothing(walking, until):
    made, walk = walking
    fleet = walk("gathering", 4)
    made.split((0, 1), (2, 3))
    time.sleep(3.0)
    made.move(2, "10.77.0.77")
    made.link(3, "down")
    made.heal()
    time.sleep(1.0)
    made.link(3, "up")
    assert fleet.all_have_ended()
    assert (fleet.replayed().outcome, fleet.replayed().complaints) == (Outcome.SUCCESS, ())
