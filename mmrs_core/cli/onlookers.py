"""Plug-ins that look on: what they raise, or how long they take, ends nothing and holds nothing up."""

from __future__ import annotations

from collections.abc import Mapping
from queue import SimpleQueue
from threading import Thread
from typing import TYPE_CHECKING

from mmrs_core.cli.output import tell

if TYPE_CHECKING:
    from mmrs_core.plugins import Plugins
    from mmrs_runtime.records.steps import StepRecord

FAREWELL_SECONDS = 5.0
"""For how long a run that has ended waits for those who have not seen all of it."""


class Onlookers:
    """The observers among the plug-ins of a command."""

    def __init__(self, plugins: Plugins) -> None:
        """Show them nothing yet."""
        self._plugins = plugins
        self._told: set[str] = set()

    def see_stage(self, name: str, result: object) -> None:
        """Show them what a stage has made."""
        self._tell("mmrs_stage_finished", self._plugins.observe_stage(name, result))

    def see_step(self, record: StepRecord) -> None:
        """Show them a step."""
        self._tell("mmrs_step_executed", self._plugins.observe_step(record))

    def _tell(self, hook: str, failed: Mapping[str, BaseException]) -> None:
        for who, error in failed.items():
            words = f"{who}: {hook} fails"
            if words not in self._told:
                self._told.add(words)
                tell(f"{words}: {error!r}; everything else goes on, and this is told once")


class Gallery:
    """Where onlookers see the steps of a run in real time: in a thread of their own, one after another."""

    def __init__(self, onlookers: Onlookers) -> None:
        """Open it."""
        self._onlookers = onlookers
        self._steps: SimpleQueue[StepRecord | None] = SimpleQueue()
        self._thread = Thread(target=self._show, name="onlookers", daemon=True)
        self._thread.start()

    def show(self, record: StepRecord) -> None:
        """Show them a step as soon as they have seen those before; return at once."""
        self._steps.put(record)

    def close(self) -> None:
        """Have them see what they have not seen yet, unless they take too long; tell if they do."""
        self._steps.put(None)
        self._thread.join(FAREWELL_SECONDS)
        if self._thread.is_alive():
            tell(f"plug-ins that observe steps take too long: they have not seen the last {self._unseen}")

    @property
    def _unseen(self) -> int:
        return max(1, self._steps.qsize() - 1)

    def _show(self) -> None:
        while (record := self._steps.get()) is not None:
            self._onlookers.see_step(record)
