"""What a vehicle is given when it is connected for a run in real time, and how vehicles are let go of."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..clock import SIGNAL_SECONDS
from ..records.blackbox import BlackBox, black_box_path
from ..records.steps import log_name

if TYPE_CHECKING:
    from ..records.steps import StepRecord
    from ..vehicle import Vehicle
    from .clocks import RunClock


@dataclass(frozen=True, slots=True)
class Live:
    """What vehicles of a run in real time may use in addition.

    Attributes:
        clock: of the run.
        wake: makes the engine look at this robot at once; to be called, from any thread, whenever
            the robot's answers may have changed.
        say: reports about this robot to the operator, from any thread.
        run: identifier of the run.
        folder: of the logs; None where none are kept.
        links: how robots are reached, as in ``--connect``, by robot of this process.
        shared: what vehicles of the same run share, by names of their own; empty at first.
        announce: reports what concerns no single robot, from any thread.
        records: the steps that this robot made before the run was broken off, in order.
    """

    clock: RunClock
    wake: Callable[[], None]
    say: Callable[[str], None]
    run: str
    folder: Path | None = None
    links: Mapping[str, str] = field(default_factory=dict)
    shared: dict[str, object] = field(default_factory=dict)
    announce: Callable[[str], None] = print
    records: tuple[StepRecord, ...] = ()

    @property
    def resumed(self) -> bool:
        """Return whether the run was broken off before, so that robots may be anywhere on their paths."""
        return bool(self.records)

    @property
    def passed(self) -> tuple[str, ...]:
        """Return the moves that this robot ended before, in order."""
        return tuple(record.move for record in self.records if record.label == "end")

    @property
    def begun(self) -> str:
        """Return the move that it had begun then; empty where it had ended its last one."""
        return self.records[-1].move if self.records and self.records[-1].label == "begin" else ""

    def box_path(self, robot: str) -> Path | None:
        """Return where the black box of a robot lies; None where no logs are kept."""
        return None if self.folder is None else black_box_path(self.folder / log_name(robot))

    def black_box(self, robot: str) -> BlackBox | None:
        """Return the black box of a robot, to be written; None where no logs are kept."""
        path = self.box_path(robot)
        return None if path is None else BlackBox(path, self.run, robot, self.clock.now, say=self.say)


def let_go(robots: Mapping[str, Vehicle]) -> None:
    """Close all robots at once: each may take seconds to settle what to do without a controller.

    Raises:
        Exception: one cannot be closed; its notes name why others cannot.
    """
    errors: list[Exception] = []

    def close(robot: Vehicle) -> None:
        try:
            robot.close()
        except Exception as error:
            errors.append(error)

    threads = [
        threading.Thread(target=close, args=(robot,), name=f"close {id}", daemon=True)
        for id, robot in robots.items()
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        while thread.is_alive():
            thread.join(SIGNAL_SECONDS)
    if errors:
        for other in errors[1:]:
            errors[0].add_note(f"also: {other!r}")
        raise errors[0]
