"""Watches robots of this process at work: writes their logs, and remembers what each has reported last."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_core.behaviour.program import FEEDBACK, Action, Program
from mmrs_core.cli.onlookers import Gallery
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord


class Observer:
    """Is told every step that a robot makes."""

    def __init__(self, gallery: Gallery, writer: LogWriter, program: Program) -> None:
        """Have seen nothing of that behaviour yet; who is in the gallery is shown all of it, too."""
        self._gallery, self._writer = gallery, writer
        self._actions = _actions_of(program)
        self._reported: dict[str, Mapping[str, object]] = {}

    def observe(self, record: StepRecord) -> None:
        """Write a step down."""
        self._writer.write(record)
        action = self._actions.get((record.robot, record.move, record.detail))
        if record.label == "act" and action is not None and action.is_a(FEEDBACK):
            self._reported[record.robot] = {
                "name": action.name,
                "content": dict(action.parameters),
            }
        self._gallery.show(record)

    def status(self, robot: str) -> Mapping[str, object]:
        """Return what a robot has reported last; empty before it has."""
        reported = self._reported.get(robot)
        return {} if reported is None else {"reported": reported}


def _actions_of(program: Program) -> dict[tuple[str, str, str], Action]:
    """Return all actions by robot, move, and what logs say of where they stand there."""
    return {
        (robot.id, move.id, f"{when}:{index}"): action
        for robot in program.robots
        for move in robot.moves
        for when, actions in (("pre", move.before), ("post", move.after))
        for index, action in enumerate(actions)
    }
