"""Long flights are reported in time, and in memory that their length does not fill."""

import json
import resource
import subprocess
import sys
import time

import numpy as np
import pytest

from mmrs_core.cli import run

HOUR = 3600.0
RATE = 5.0
NOISE = 0.3


def stretch(project, seconds):
    """Make of a simulated run one that takes so long, with noisy fixes five times a second; say how many."""
    generator, fixes = np.random.default_rng(11), 0
    for box in (project / "logs").glob("*.blackbox.ndjson"):
        lines = [json.loads(line) for line in box.read_text("utf-8").splitlines()]
        samples = [line for line in lines if line["kind"] == "fix"]
        log = box.with_name(box.name.replace(".blackbox.ndjson", ".jsonl"))
        steps = [json.loads(line) for line in log.read_text("utf-8").splitlines()]
        factor = seconds / max(samples[-1]["time"], steps[-1]["time"])
        for step in steps:
            step["time"] = round(step["time"] * factor, 3)
        log.write_text("".join(json.dumps(step) + "\n" for step in steps), "utf-8")
        at = np.array([sample["time"] * factor for sample in samples])
        places = np.array(
            [[sample["place"][name] for name in ("north", "east", "height")] for sample in samples]
        )
        times = np.arange(0.0, seconds, 1 / RATE)
        noisy = np.stack([np.interp(times, at, places[:, axis]) for axis in range(3)], axis=1)
        noisy += generator.normal(0.0, NOISE, noisy.shape)
        head = {**lines[0], "link": "udpin:0.0.0.0:14550", "vehicle": "copter"}
        rest = '"speed":5.0,"heading":90.0,"energy":0.8,"mode":"AUTO","armed":true}\n'
        with box.open("w", encoding="utf-8") as file:
            file.write(json.dumps(head) + "\n")
            for when, (north, east, height) in zip(times.tolist(), noisy.tolist(), strict=True):
                place = f'"place":{{"north":{north:.3f},"east":{east:.3f},"height":{height:.3f}}}'
                common = f'"run":"run-0","robot":"{head["robot"]}","time":{when:.3f},"wall":"","kind":"fix"'
                file.write(f"{{{common},{place},{rest}")
        fixes += len(times)
    return fixes


def test_an_hour_of_three_robots_is_reported_in_five_seconds_of_cpu(project):
    assert stretch(project, 1.5 * HOUR) == 3 * HOUR * RATE  # two robots, as many fixes as three in an hour
    begun = time.process_time()
    assert run(["report", str(project), str(project / "logs"), "-o", str(project / "r.html")]) == 0
    assert time.process_time() - begun < 5.0
    assert (project / "r.html").stat().st_size < 5_000_000


@pytest.mark.thorough
def test_a_day_is_reported_in_less_than_a_gigabyte(project):
    stretch(project, 24 * HOUR)
    limit = 1 << 30
    code = "import sys; from mmrs_core.cli import main; main()"
    command = [sys.executable, "-c", code, "report", str(project), str(project / "logs")]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=600,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit)),
    )
    assert done.returncode == 0, done.stderr
