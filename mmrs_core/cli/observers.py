"""Plug-ins that observe a command: their errors and delays never affect it."""

from __future__ import annotations

from collections.abc import Mapping
from queue import SimpleQueue
from threading import Thread
from typing import TYPE_CHECKING

from mmrs_core.cli.output import tell

if TYPE_CHECKING:
    from mmrs_core.plugins import Plugins
    from mmrs_runtime.records.steps import StepRecord

CLOSING_SECONDS = 5.0
"""How long a finished run waits for observers to process its last steps."""


class Observers:
    """The observing plug-ins of a command."""

    def __init__(self, plugins: Plugins) -> None:
        self._plugins = plugins
        self._reported: set[str] = set()

    def see_stage(self, name: str, result: object) -> None:
        """Notify the plug-ins of the result of a stage."""
        self._report("mmrs_stage_finished", self._plugins.observe_stage(name, result))

    def see_step(self, record: StepRecord) -> None:
        """Notify the plug-ins of a step."""
        self._report("mmrs_step_executed", self._plugins.observe_step(record))

    def _report(self, hook: str, failed: Mapping[str, BaseException]) -> None:
        for plugin, error in failed.items():
            line = f"{plugin}: {hook} fails"
            if line not in self._reported:
                self._reported.add(line)
                tell(f"{line}: {error!r}; the run continues, and further failures are not reported")


class ObserverThread:
    """Passes the steps of a run in real time to observers, in order, on a thread of its own."""

    def __init__(self, observers: Observers) -> None:
        self._observers = observers
        self._steps: SimpleQueue[StepRecord | None] = SimpleQueue()
        self._thread = Thread(target=self._run, name="observers", daemon=True)
        self._thread.start()

    def see_step(self, record: StepRecord) -> None:
        """Queue a step; return at once."""
        self._steps.put(record)

    def close(self) -> None:
        """Wait for the observers to process the queue, at most `CLOSING_SECONDS`; report if they do not."""
        self._steps.put(None)
        self._thread.join(CLOSING_SECONDS)
        if self._thread.is_alive():
            tell(f"plug-ins that observe steps are too slow: the last {self._unseen} steps were not observed")

    @property
    def _unseen(self) -> int:
        return max(1, self._steps.qsize() - 1)

    def _run(self) -> None:
        while (record := self._steps.get()) is not None:
            self._observers.see_step(record)
