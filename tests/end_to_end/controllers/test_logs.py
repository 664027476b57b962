"""Logs that cannot be written, and what a dry run may say that it has measured."""

import resource
import subprocess
import sys
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, quad, robot_program, take_off

from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.programs import feedback, photo, program

pytestmark = pytest.mark.real_time("controllers")

UP_AND_DOWN = program(robot_program("alpha", [take_off("up", 5.0), LAND]))


@pytest.mark.parametrize("arguments", [(), ("--bus",)])
def test_a_log_that_cannot_be_opened_is_no_lost_link(controllers, tmp_path, arguments):
    (tmp_path / "file").write_text("not a folder", "utf-8")
    made = controllers(UP_AND_DOWN)
    code, said = made.run("fleet.py", "--dry-run", "--log", str(tmp_path / "file"), *arguments)
    assert code == 2
    assert str(tmp_path / "file") in said
    assert "Traceback" not in said


def test_a_log_that_cannot_be_written_any_more_ends_the_program(controllers):
    made = controllers(UP_AND_DOWN)

    def fill_disk() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (400, 400))

    # Bytecode (-B) would be cut off, too, for all processes that come after.
    found = subprocess.run(
        [sys.executable, "-B", str(made.folder / "fleet.py"), "--dry-run"],
        cwd=made.folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        preexec_fn=fill_disk,
    )
    assert found.returncode == 1
    assert "LOG_FAILED: logs/alpha.jsonl: File too large" in found.stderr
    assert "Traceback" not in found.stderr


def test_a_dry_run_measures_nothing_and_says_in_every_record_that_it_was_one(controllers):
    sensor = Device("gas", {"sample": DeviceAction("sample", 1.0)}, {"mavlink.value": "CO2"})
    works = replace(LAND, before=(photo("gas", "sample"), feedback("seen")))
    made = controllers(
        program(robot_program("alpha", [take_off("up", 5.0), works])),
        types=[replace(quad(), devices={"gas": sensor})],
    )
    code, said = made.run("fleet.py", "--dry-run")
    assert code == 0, said
    assert {line["dry_run"] for line in made.box("alpha")} == {True}
    measured, reported = made.box("alpha", "measured", "reported")
    assert measured["content"] == {"device": "gas", "result": None}
    assert reported["name"] == "seen"
