"""What `mmrs run` remembers of its robots, for who asks how they are."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from threading import Event

from mmrs_core.cli import onlookers
from mmrs_core.cli.observing import Observer
from mmrs_core.cli.onlookers import Gallery, Onlookers
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.testing.programs import feedback, move, photo, program, robot_program
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord

SEES = replace(move("looks", "HoldPosition"), before=(photo(), feedback("seen", ("what", "a goat"))))
FLOCK = program(robot_program("alpha", [SEES]))


@contextmanager
def onlooker(see):
    """Give the gallery of a plug-in that looks on, which is closed in the end."""

    class Plugin:
        @staticmethod
        @hookimpl
        def mmrs_step_executed(record):
            see(record)

    gallery = Gallery(Onlookers(load_plugins(only_core=True, extra={"kites": Plugin})))
    try:
        yield gallery
    finally:
        gallery.close()


def step(seq, detail=""):
    return StepRecord("run-0", "alpha", seq, seq, 1.0, "act", "looks", detail=detail)


def test_what_a_robot_has_reported_last_is_part_of_how_it_is(tmp_path):
    shown = []
    with LogWriter(tmp_path) as writer, onlooker(shown.append) as gallery:
        observer = Observer(gallery, writer, FLOCK)
        assert observer.status("alpha") == {}
        photo, seen = (step(seq, f"pre:{seq}") for seq in (0, 1))
        observer.observe(photo)
        assert observer.status("alpha") == {}
        observer.observe(seen)
        assert observer.status("alpha")["reported"] == {"name": "seen", "content": {"what": "a goat"}}
    assert shown == [photo, seen]


def test_an_onlooker_that_fails_is_told_once_and_sees_what_follows(capsys):
    shown = []

    def fail(record):
        shown.append(record.seq)
        raise OSError(28, "no space left on the onlooker's disk")

    with onlooker(fail) as gallery:
        for seq in range(3):
            gallery.show(step(seq))
    assert shown == [0, 1, 2]
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith("plug-in 'kites' of distribution 'given by the caller': mmrs_step_executed fails")
    assert "no space left on the onlooker's disk" in told


def test_an_onlooker_that_takes_long_keeps_nobody_waiting(monkeypatch, capsys):
    monkeypatch.setattr(onlookers, "FAREWELL_SECONDS", 0.1)
    begun, goes_on = Event(), Event()

    def dawdle(record):
        begun.set()
        goes_on.wait(20.0)

    with onlooker(dawdle) as gallery:
        for seq in range(3):
            gallery.show(step(seq))
        assert begun.wait(20.0)
    assert "they have not seen the last 2" in capsys.readouterr().err
    goes_on.set()
