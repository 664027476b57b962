"""Faults of the whole process, each in a process of its own."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.real_time("parts of flights")

PREFACE = """
import json, sys, threading, time
from mmrs_runtime.clock import Clock
from mmrs_runtime.injection import Rehearsal, injections
def begin(text, speedup=1.0):
    clock = Clock(speedup)
    rehearsal = Rehearsal(injections([text], {"alpha": "udpin:127.0.0.1:1"}), clock, said.append)
    rehearsal.record("alpha", lambda fault, content: noted.append([fault, dict(content)]))
    rehearsal.start()
    return rehearsal
said, noted = [], []
"""


def result_of(script: str, folder: Path):
    """Run a script that prints one JSON value."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", PREFACE + script],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=folder,
        check=False,
        env={"PYTHONPATH": str(Path(__file__).parents[5])},
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_frozen_process_goes_on_after_its_time(tmp_path):
    longest, said = result_of(
        """
rehearsal = begin("freeze@0.3+0.8")
gaps, last, over = [], time.monotonic(), False
while not over:
    over = any("ends" in line for line in said)
    now = time.monotonic(); gaps.append(now - last); last = now; time.sleep(0.01)
rehearsal.close()
print(json.dumps([max(gaps), said]))
""",
        tmp_path,
    )
    assert 0.75 < longest < 5.0
    assert said[1:] == ["freeze@0.3+0.8: begins", "freeze@0.3+0.8: ends"]


def test_a_full_disk_refuses_every_write_until_it_ends(tmp_path):
    before, during, after = result_of(
        """
def writes():
    try:
        with open("log.txt", "a") as file:
            file.write("line\\n")
        return ""
    except OSError as error:
        return error.strerror
before = writes()
rehearsal = begin("disk-full@0+600")
while not any("begins" in line for line in said): time.sleep(0.01)
time.sleep(0.05)
during = writes()
rehearsal.close()
print(json.dumps([before, during, writes()]))
""",
        tmp_path,
    )
    assert (before, during, after) == ("", "File too large", "")


def test_a_clock_that_jumps_moves_wall_time_only(tmp_path):
    wall, steady, back = result_of(
        """
wall, steady = time.time(), time.monotonic()
rehearsal = begin("clock-jump@0-3600")
while abs(time.time() - wall) < 60: time.sleep(0.01)
found = [time.time() - wall, time.monotonic() - steady]
rehearsal.close()
print(json.dumps([*found, time.time() - wall]))
""",
        tmp_path,
    )
    assert -3600.0 <= wall < -3590.0
    assert 0.0 <= steady < 10.0
    assert 0.0 <= back < 10.0


def test_what_is_made_on_purpose_is_recorded_when_it_begins_and_ends(tmp_path):
    noted = result_of(
        """
rehearsal = begin("alpha:cut@10+10,seed=3", speedup=100.0)
while not any("ends" in line for line in said): time.sleep(0.01)
rehearsal.close()
print(json.dumps(noted))
""",
        tmp_path,
    )
    assert noted == [
        ["alpha:cut@10+10", {"state": "asked for", "seed": 3}],
        ["alpha:cut@10+10", {"state": "begins"}],
        ["alpha:cut@10+10", {"state": "ends"}],
    ]


def test_nothing_is_done_where_nothing_is_asked_for(tmp_path):
    begun = time.monotonic()
    said, threads = result_of(
        """
rehearsal = Rehearsal(injections([], {}), Clock(), said.append)
rehearsal.start()
threads = threading.active_count()
rehearsal.close()
print(json.dumps([said, threads]))
""",
        tmp_path,
    )
    assert (said, threads) == ([], 1)
    assert time.monotonic() - begun < 30.0
