"""What is due is sent, to robots of this process and of others, and what they answer is taken."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from .admission import Admission
from .answering import Answering
from .carriers.courier import Courier
from .changes import Changes
from .outgoing.errands import Errand, Message, Notice
from .outgoing.outbox import Outbox
from .owners.owners import Owners
from .troubles import Net
from .words import Answer, Begin, Commit, Prepare, Request, Withdraw

Work = Sequence[tuple[Errand | Notice, Message]]
"""What is to be sent, each with what its answer is for."""


class Sending:
    """Empties the outbox."""

    def __init__(
        self,
        lock: threading.Condition,
        now: Callable[[], float],
        owners: Owners,
        outbox: Outbox,
        answering: Answering,
        courier: Courier,
        changes: Changes,
        net: Net,
        admission: Admission,
    ) -> None:
        """Send nothing yet.

        Args:
            lock: guards owners, outbox and answering.
            now: seconds of a clock that never goes back.
            owners: of this process.
            outbox: holds what is to be sent.
            answering: answers for the robots of this process.
            courier: to those of others.
            changes: told when an answer has come.
            net: tells people of those who are refused.
            admission: judges what robots of other processes answer.
        """
        self._lock, self._now = lock, now
        self._owners, self._outbox, self._answering = owners, outbox, answering
        self._courier, self._changes, self._net = courier, changes, net
        self._admission = admission

    def begin(self, now: float) -> Work:
        """Return what is due now, having sent what is for this process; to be called with the lock."""
        work = self._outbox.take_due(now)
        for errand, message in work:
            if message.owner in self._owners:
                answer = self._answering.answer(message.owner, message.request, here=True)
                if answer is not None:
                    errand.answered(message.owner, _round(message.request), answer, now)
        return work

    def finish(self, work: Work) -> None:
        """Send the rest; to be called without the lock: carriers may take other locks, or wait."""
        for errand, message in work:
            if message.owner not in self._owners:
                taken = self._taker(errand, message)
                self._courier.ask(message.sender, message.owner, message.request, taken)
            elif isinstance(message.request, Commit | Begin):
                self._courier.publish(message.owner)

    def _taker(self, errand: Errand | Notice, message: Message) -> Callable[[Answer], None]:
        def take(answer: Answer) -> None:
            with self._lock:
                if not self._admission.believes(message.owner, answer):
                    return  # as good as none
                errand.answered(message.owner, _round(message.request), answer, self._now())
                if answer.what == "refused" and isinstance(message.request, Begin):
                    self._net.tell(f"{message.owner!r} refuses {message.sender!r}: {answer.why}")
                gone = self._outbox.sweep()
            self._courier.vanish(gone)
            self._changes.tell()

        return take


def _round(request: Request) -> int:
    return request.round if isinstance(request, Prepare | Withdraw) else 0
