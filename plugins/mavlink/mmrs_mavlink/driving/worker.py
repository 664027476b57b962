"""A thread in which a vehicle does one thing after another, so that its caller does not wait."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

from mmrs_runtime.faults import CRASHED, FAILURES, FaultError

IDLE_SECONDS = 0.1
"""Real seconds between two looks at a vehicle that has nothing to do."""


class Interrupted(Exception):  # noqa: N818  # no error: something else is to be done first
    """The present job must end at once."""


class Job:
    """What a vehicle is to do, in parts: one that was interrupted is begun again."""

    def __init__(self, *parts: Callable[[], None]) -> None:
        """Do these parts one after another; none is done at once."""
        self._parts = deque(parts)

    def first(self, part: Callable[[], None]) -> None:
        """Do this part before all others."""
        self._parts.appendleft(part)

    def append(self, part: Callable[[], None]) -> None:
        """Do this part, too, after all others."""
        self._parts.append(part)

    def then(self, *parts: Callable[[], None]) -> None:
        """Do these parts right after the present one."""
        for offset, part in enumerate(parts):
            self._parts.insert(1 + offset, part)

    def run(self) -> None:
        """Do what has not been done yet; returns when all of it has."""
        while self._parts:
            self._parts[0]()
            self._parts.popleft()


class Worker:
    """Carries out its last job.

    Attributes:
        fault: the present fault, until another job is begun.
        changed: called when it has done something, or failed to.
        faulty: called repeatedly while there is a fault.
        failed: called with exceptions of faulty or foreign code.
    """

    def __init__(
        self,
        name: str,
        watch: Callable[[], None],
        idle: Callable[[], None],
        halt: Callable[[], None],
        go_on: Callable[[], None],
    ) -> None:
        """Start the thread; it has nothing to do yet.

        Args:
            name: of the thread.
            watch: looked at in every wait of a job; raises a Fault.
            idle: looked at while there is no job; raises a Fault.
            halt: brings the vehicle to a halt and returns when it stands.
            go_on: has the vehicle be steered again after that.
        """
        self.fault: FaultError | None = None
        self.changed: Callable[[], None] = lambda: None
        self.faulty: Callable[[FaultError], None] = lambda fault: None
        self.failed: Callable[[BaseException], None] = lambda error: None
        self._watch, self._idle, self._halt, self._go_on = watch, idle, halt, go_on
        self._news = threading.Condition()
        self._job: Job | None = None
        self._newest = 0
        self._running = 0
        self._done = True
        self._holds = self._halting = self._halted = self._closing = False
        self._thread = threading.Thread(target=self._live, name=name, daemon=True)
        self._thread.start()

    def begin(self, job: Job, *, afresh: bool = False) -> None:
        """Drop the present job, if any, and do this one; `afresh`: forget faults and pauses, too."""
        with self._news:
            if afresh:
                self.fault, self._holds, self._halting, self._halted = None, False, False, False
            self._job, self._done = job, False
            self._newest += 1
            self._news.notify_all()

    def first(self, part: Callable[[], None]) -> None:
        """Do this part of the present job next, once what is being done is interrupted."""
        with self._news:
            if self._job is not None:
                self._job.first(part)

    @property
    def done(self) -> bool:
        """Return whether the job given last has been done."""
        return self._done

    @property
    def started(self) -> bool:
        """Return whether nothing else is being done any more than what was ordered last."""
        return self._newest == self._running

    @property
    def halted(self) -> bool:
        """Return whether the vehicle stands, and has not gone on yet."""
        return self._halted

    @property
    def goes_on(self) -> bool:
        """Return whether the vehicle was ordered to halt, and not yet to continue."""
        return self._halting and not self._holds

    def instead(self, fault: FaultError, job: Job) -> None:
        """Do a job about a fault that is still there, unless something else was begun since."""
        with self._news:
            if self.fault is fault and self._newest == self._running:
                self.begin(job, afresh=True)

    def forgive(self, fault: FaultError) -> None:
        """Forget a fault; what it has broken off counts as done."""
        with self._news:
            if self.fault is fault:
                self.fault, self._done = None, True
                self._newest += 1
                self._news.notify_all()

    def pause(self) -> None:
        """Halt in the middle of the job."""
        with self._news:
            if not self._holds:
                # It may have begun to go on since it stood, so that it has to come to a halt anew.
                self._holds, self._halted = True, False
                self._newest += 1
                self._news.notify_all()

    def resume(self) -> None:
        """Continue the job."""
        with self._news:
            self._holds = False
            self._newest += 1
            self._news.notify_all()

    def close(self) -> None:
        """End the thread; whatever is being done is left as it is."""
        with self._news:
            self._closing = True
            self._newest += 1
            self._news.notify_all()
        self._thread.join()

    def guard(self) -> None:
        """Raise what should end a wait of the job.

        Raises:
            Interrupted: something else is to be done.
            FaultError: something has gone wrong.
        """
        if threading.current_thread() is not self._thread:
            return
        if self._newest != self._running:
            raise Interrupted
        self._watch()

    def _live(self) -> None:
        while not self._closing:
            with self._news:
                if self._newest == self._running:
                    self._news.wait(IDLE_SECONDS)
                self._running = self._newest
                task = self._task()
            self._attempt(task)

    def _task(self) -> Callable[[], None]:
        if self._closing:
            return lambda: None
        if (fault := self.fault) is not None:
            return lambda: self.faulty(fault)
        if self._holds:
            return self._idle if self._halted else self._come_to_a_halt
        if self._halting:
            return self._carry_on
        return self._idle if self._done or self._job is None else self._work

    def _attempt(self, task: Callable[[], None]) -> None:
        try:
            task()
        except Interrupted:
            return
        except FaultError as fault:
            self._fail(fault)
        except FAILURES as error:  # the thread must live on: the robot may still have to be stopped
            self.failed(error)
            self._fail(FaultError(CRASHED, f"the program itself fails: {error!r}"))

    def _work(self) -> None:
        job = self._job
        assert job is not None
        job.run()
        with self._news:
            if self._job is job:
                self._done = True
        self.changed()

    def _come_to_a_halt(self) -> None:
        with self._news:
            if self._newest != self._running:
                return
            self._halting = True
        self._halt()
        with self._news:
            self._halted = self._halted or self._newest == self._running
        self.changed()

    def _carry_on(self) -> None:
        self._go_on()
        with self._news:
            if self._newest == self._running:
                self._halting = self._halted = False
                self._newest += 1
        self.changed()

    def _fail(self, fault: FaultError) -> None:
        with self._news:
            if self._newest == self._running:
                self.fault = fault
        self.changed()
