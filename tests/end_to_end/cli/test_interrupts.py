"""Whenever a command is interrupted, it ends with 130 and says so in one line.

While it searches for a plan, it keeps the best one instead, and says that.
"""

import signal
import subprocess
import sys
import time

import pytest

from mmrs_core.resources import shipped

BEGUN = "import sys; from mmrs_core.cli import main; print('begun', flush=True); main()"
DELAYS = (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.6)
THOROUGH = tuple(step * 0.01 for step in range(2, 80))


def heed_interrupts():
    """Undo what a shell does to commands in the background: it has them ignore interrupts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def interrupted_after(delay, folder):
    """Return exit code, output and errors of a command that is interrupted so long after its entry."""
    mission = shipped("examples") / "carbon-dioxide"
    command = [sys.executable, "-c", BEGUN, "preview", str(mission), "-o", str(folder)]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=heed_interrupts
    )
    assert process.stdout.readline() == "begun\n"
    time.sleep(delay)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    return process.returncode, out, err


def expect_a_quiet_end(delay, folder):
    code, out, err = interrupted_after(delay, folder)
    if "the plan is finished with what was found" in err:
        assert (code, out.count("written: ")) == (0, 2)
        return
    assert (code, out) == (130, "")
    assert without_notes(err) == ["mmrs: interrupted"]


def without_notes(err):
    """Return lines of errors without notes about the mission, which are said before the search."""
    return [line for line in err.splitlines() if ": note: " not in line and not line.startswith("    ")]


@pytest.mark.parametrize("delay", DELAYS)
def test_an_interrupt_ends_quietly(delay, tmp_path):
    expect_a_quiet_end(delay, tmp_path)


@pytest.mark.thorough
@pytest.mark.parametrize("delay", THOROUGH)
def test_an_interrupt_at_any_time_ends_quietly(delay, tmp_path):
    expect_a_quiet_end(delay, tmp_path)


def test_an_interrupt_that_is_ignored_stays_ignored(tmp_path):
    script = f"import signal; signal.signal(signal.SIGINT, signal.SIG_IGN); {BEGUN}"
    command = [sys.executable, "-c", script, "show", str(shipped("examples") / "pool" / "mission.xmi")]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")
    assert out.startswith("Mission ")
