"""Robots on machines of their own: each has an address and a clock, and the network between them fails."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time

import bus_asking
import machines
import pytest

pytestmark = [pytest.mark.thorough, pytest.mark.skipif(bool(why := machines.why_not()), reason=why)]


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
