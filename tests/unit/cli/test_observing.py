"""What `mmrs run` remembers of its robots, for who asks how they are."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core.behaviour.log import LogWriter
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.cli.journey import Workshop
from mmrs_core.cli.observing import Observer
from mmrs_core.cli.settings import Settings
from mmrs_core.testing.programs import feedback, move, photo, program, robot_program

SEES = replace(move("looks", "HoldPosition"), before=(photo(), feedback("seen", ("what", "a goat"))))
FLOCK = program(robot_program("alpha", [SEES]))


def test_what_a_robot_has_reported_last_is_part_of_how_it_is(tmp_path):
    with LogWriter(tmp_path) as writer:
        observer = Observer(Workshop(Settings()), writer, FLOCK)
        assert observer.status("alpha") == {}
        photo, seen = (
            StepRecord("run-0", "alpha", seq, seq, 1.0, "act", "looks", detail=f"pre:{seq}") for seq in (0, 1)
        )
        observer.observe(photo)
        assert observer.status("alpha") == {"move": "looks", "step": "act", "time": 1.0}
        observer.observe(seen)
        assert observer.status("alpha")["reported"] == {"name": "seen", "content": {"what": "a goat"}}
