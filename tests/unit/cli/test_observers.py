"""What `mmrs run` remembers of its robots, for who asks how they are."""

from contextlib import contextmanager
from dataclasses import replace
from threading import Event

from mmrs_multicopter.testing import robot_program

from mmrs_core.cli import observers
from mmrs_core.cli.flying import StepRecorder
from mmrs_core.cli.observers import Observers, ObserverThread
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.testing.programs import feedback, move, photo, program
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord

SEES = replace(move("looks", "HoldPosition"), before=(photo(), feedback("seen", ("what", "a goat"))))
FLOCK = program(robot_program("alpha", [SEES]))


@contextmanager
def observing(see):
    """Give the observers_of_run of a plug-in that looks on, which is closed in the end."""

    class Plugin:
        @staticmethod
        @hookimpl
        def mmrs_step_executed(record):
            see(record)

    observers_of_run = ObserverThread(Observers(load_plugins(only_core=True, extra={"kites": Plugin})))
    try:
        yield observers_of_run
    finally:
        observers_of_run.close()


def step(seq, detail=""):
    return StepRecord("run-0", "alpha", seq, seq, 1.0, "act", "looks", detail=detail)


def test_what_a_robot_has_reported_last_is_part_of_how_it_is(tmp_path):
    shown = []
    with LogWriter(tmp_path) as writer, observing(shown.append) as observers_of_run:
        observer = StepRecorder(observers_of_run, writer, FLOCK)
        assert observer.status("alpha") == {}
        photo, seen = (step(seq, f"pre:{seq}") for seq in (0, 1))
        observer.record(photo)
        assert observer.status("alpha") == {}
        observer.record(seen)
        assert observer.status("alpha")["reported"] == {"name": "seen", "content": {"what": "a goat"}}
    assert shown == [photo, seen]


def test_an_observer_that_fails_is_reported_once_and_sees_what_follows(capsys):
    shown = []

    def fail(record):
        shown.append(record.seq)
        raise OSError(28, "no space left on the observer's disk")

    with observing(fail) as observers_of_run:
        for seq in range(3):
            observers_of_run.see_step(step(seq))
    assert shown == [0, 1, 2]
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith("plug-in 'kites' of distribution 'given by the caller': mmrs_step_executed fails")
    assert "no space left on the observer's disk" in told


def test_a_slow_observer_delays_no_run(monkeypatch, capsys):
    monkeypatch.setattr(observers, "CLOSING_SECONDS", 0.1)
    begun, goes_on = Event(), Event()

    def dawdle(record):
        begun.set()
        goes_on.wait(20.0)

    with observing(dawdle) as observers_of_run:
        for seq in range(3):
            observers_of_run.see_step(step(seq))
        assert begun.wait(20.0)
    assert "the last 2 steps were not observed" in capsys.readouterr().err
    goes_on.set()
