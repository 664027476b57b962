"""A drone finds, an underwater vehicle goes and looks, in real time, as people start them."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from mmrs_auv.commands.modelled import sheets_in
from mmrs_auv.rehearsal import VehicleProcesses
from ports import free_endpoint, free_port

from auv_vessel.body.surroundings import from_json
from mmrs_core.cli.examples import example_folder

pytestmark = [pytest.mark.real_time("vessels"), pytest.mark.thorough]

MMRS = (sys.executable, "-m", "mmrs_core")
SPEED, LONGEST = 2.0, 600.0
"""Times real time; seconds. Under load, the vehicle.s time goes as slowly as its processes."""

FLOAT = (23.5, 27.5)


@contextmanager
def running(folder: Path, name: str, *words: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run a program until the end of the block; what it says stands in a file."""
    with (folder / f"{name}.txt").open("wb") as said:
        process = subprocess.Popen(
            [sys.executable, "-m", *words], stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT
        )
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(20.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def ended(process: subprocess.Popen[bytes]) -> int | None:
    """Return with which code a program ends; None if it does not, so that what all have said is shown."""
    try:
        return process.wait(LONGEST)
    except subprocess.TimeoutExpired:
        return None


@pytest.fixture
def bay(tmp_path: Path) -> Path:
    """Return a copy of the example with its behaviour."""
    project = Path(shutil.copytree(example_folder("lost-float"), tmp_path / "bay"))
    subprocess.run((*MMRS, "plan", str(project)), check=True, capture_output=True)
    return project


@pytest.fixture
def reached(bay: Path, tmp_path: Path) -> Iterator[dict[str, list[str]]]:
    """Return what mmrs run needs to reach a simulated drone, and a simulated vehicle with eyes."""
    around, port, told = bay / "surroundings.json", free_port(), free_port()
    with ExitStack() as stack:
        words = ("mmrs_core", "sitl", str(bay), "--surroundings", str(around), "--port", str(port))
        stack.enter_context(running(tmp_path, "sitl", *words, "--speedup", str(SPEED)))
        (sheet,) = sheets_in(bay).values()
        sees = from_json(around.read_text(encoding="utf-8"))
        berth = stack.enter_context(
            VehicleProcesses(sheet, tmp_path / "berth", surroundings=sees, speedup=SPEED)
        )
        given = ("--sheet", str(tmp_path / "berth/sheet.json"), "--surroundings", str(around))
        given += ("--memory", f"mixed-{os.getpid()}")
        for part, more in (
            ("frames", ("--channel", berth.channel)),
            ("front", ("--to", f"127.0.0.1:{told}")),
        ):
            stack.enter_context(running(tmp_path, part, "auv_vision", part, *given, *more))
        yield {
            "Gull": ["--connect", f"Gull=udpin:127.0.0.1:{port}@1"],
            "Otter": ["--backend", "Otter=can", "--connect", f"Otter={berth.channel}",
                      "--backend-option", f"Otter:detections={told}"],
        }  # fmt: skip


@pytest.mark.parametrize("runs", [[["Gull", "Otter"]], [["Gull"], ["Otter"]]], ids=["one run", "over Zenoh"])
def test_what_the_drone_has_seen_is_found_by_the_vehicle(bay, reached, tmp_path, runs):
    endpoint = free_endpoint()
    with ExitStack() as stack:
        begun = []
        for number, robots in enumerate(runs):
            words = ["mmrs_core", "run", str(bay), "--log", str(tmp_path / "logs"), "--speedup", str(SPEED)]
            words += [word for robot in robots for word in reached[robot]]
            if len(runs) > 1:
                words += ["--robot", robots[0], "--bus-connect" if number else "--bus-listen", endpoint]
            begun.append(stack.enter_context(running(tmp_path, f"run {number}", *words)))
        codes = [ended(process) for process in begun]
    said = "\n".join(f"{path.name}:\n{path.read_text()}" for path in sorted(tmp_path.glob("*.txt")))
    assert codes == [0] * len(runs), said
    judged = subprocess.run(
        (*MMRS, "replay", str(bay / "behaviour.xmi"), str(tmp_path / "logs")), capture_output=True, text=True
    )
    assert judged.stdout.startswith("accepted: success"), judged
    lines = map(json.loads, (tmp_path / "logs/Otter.blackbox.ndjson").read_text().splitlines())
    (told,) = [line for line in lines if line["kind"] == "told"]
    assert (told["object"], told["east"], told["north"]) == (
        "lost float",
        pytest.approx(FLOAT[0], abs=0.5),
        pytest.approx(FLOAT[1], abs=0.5),
    )
