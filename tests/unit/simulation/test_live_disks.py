"""Logs of runs in real time on disks that are slow, or that fail: nobody but who must waits for them."""

import os
import threading
from errno import EIO
from math import inf

import pytest
from live_runs import Script, do

from mmrs_core.behaviour.replay import replay
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import hold, notify, program, robot
from mmrs_runtime.engine import life
from mmrs_runtime.orders.orders import RETURN, STOP
from mmrs_runtime.records.log import LogWriter, read
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("parts of flights")

TEAM = program(
    robot("a", [do("h", after=(notify("b.go"),)), do("walk")], policies=(Policy("LOG_FAILED", "LAND"),)),
    robot("b", [hold("h", 0.0), do("last")], waits={"h": ["go"]}),
    robot("c", [do("walk"), do("rest")]),
)
"""One who notifies another, and a third who has nothing to do with either."""


class Disk:
    """What every `fsync` asks: it lets files be on the disk, keeps them waiting, or fails."""

    def __init__(self):
        self.lets, self.asked, self.fails = threading.Event(), threading.Event(), False

    def __call__(self, handle):
        self.asked.set()
        self.lets.wait(20.0)
        if self.fails:
            raise OSError(EIO, os.strerror(EIO))


@pytest.fixture
def disk(monkeypatch):
    """Have all disks be one that answers when the test says so."""
    made = Disk()
    monkeypatch.setattr(os, "fsync", made)
    yield made
    made.lets.set()


@pytest.fixture
def team(live, tmp_path):
    """Return a function that begins the team's run, with its logs in a folder."""
    writers = []

    def begin(**seconds):
        writers.append(LogWriter(tmp_path))
        run = live(TEAM, Script(**seconds), observe=writers[0].write, sync=writers[0].sync)
        run.logs = tmp_path
        return run

    yield begin
    for writer in writers:
        writer.close()


def test_a_notify_is_sent_once_it_is_on_the_disk_and_others_go_on_meanwhile(team, disk):
    run = team()
    run.wait_for_step("a ntf h post:0")
    assert disk.asked.wait(20.0)
    run.wait_for_step("c end rest")
    assert "b begin last" not in run.shown()
    disk.lets.set()
    assert run.end().outcome is Outcome.SUCCESS
    assert replay(TEAM, run.records).outcome is Outcome.SUCCESS


def test_orders_are_obeyed_while_a_disk_does_not_answer(team, disk):
    run = team(walk=inf)
    run.wait_for_step("a ntf h post:0")
    assert disk.asked.wait(20.0)
    assert run.order(RETURN, "a", "c").refused == {}
    assert "b begin last" not in run.shown()
    assert run.script.robots["a"].stops == ["RETURN"]
    disk.lets.set()
    run.order(STOP, "b")
    run.end()
    result = replay(TEAM, run.records, partial=True)
    assert result.complaints == ()
    assert [step.label for step in read(run.logs / "a.jsonl")][-2:] == ["ntf", "fault"]


@pytest.mark.parametrize("fails", [True, False])
def test_a_disk_that_fails_or_never_answers_ends_the_program_and_nobody_is_notified(
    team, disk, monkeypatch, fails
):
    monkeypatch.setattr(life, "DISK_SECONDS", 0.3)
    disk.fails = fails
    if fails:
        disk.lets.set()
    run = team()
    run.wait_for(lambda: run.script.robots["a"].stops == ["LAND"])
    disk.lets.set()
    run.order(STOP, "b")
    ending = run.end()
    assert ending.faults["a"].which == "LOG_FAILED"
    assert (os.strerror(EIO) if fails else "has not answered") in ending.faults["a"].reason
    assert "b begin last" not in run.shown()
    assert replay(TEAM, run.records, partial=True).complaints == ()
    assert any("the fault is not in the log" in words for words in run.said) is fails
