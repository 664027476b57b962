"""What the robots of one process answer to requests, whoever asks."""

from __future__ import annotations

from collections.abc import Callable

from .admission import Admission
from .outgoing.outbox import Outbox
from .owners.owners import Owners
from .reading import Unreadable, request_in
from .roster import Roster
from .troubles import Net
from .watching import Watching
from .words import Answer, Begin, Ended, Leave, Meet, Request


class Answering:
    """Answers requests. Not thread-safe: whoever has it guards it, `told` apart."""

    def __init__(
        self,
        owners: Owners,
        watching: Watching,
        outbox: Outbox,
        net: Net,
        now: Callable[[], float],
        admission: Admission,
    ) -> None:
        """Answer for these owners; farewells change who is there, and to whom anything is still sent."""
        self._owners, self._watching, self._outbox = owners, watching, outbox
        self._admission = admission
        self._net, self._now = net, now
        self._roster = Roster(now)

    def told(self, owner: str, sender: str, text: str) -> Request | Answer:
        """Return the request that a robot of another process makes in a text, or why it is refused."""
        try:
            found = request_in(text)
        except Unreadable as error:
            return Answer("refused", why=f"not a request: {error}")
        if found.id.sender != sender:
            return Answer("refused", why=f"{sender!r} cannot speak for {found.id.sender!r}")
        if (refusal := self._admission.refusal(found)) is not None:
            return refusal
        if owner not in self._owners or sender in self._owners:
            return Answer("refused", why=f"{owner!r} is not to be asked here")
        return found

    def answer(self, robot: str, request: Request, *, here: bool = False) -> Answer | None:
        """Return what a robot answers; None: nothing as long as it cannot keep it, and it is asked again.

        Args:
            robot: of this process.
            request: to it.
            here: the sender is of this process, too.
        """
        try:
            return self._answer(robot, request, here=here)
        except OSError:
            return None  # whoever watches the journal has told
        except Exception as error:
            self._net.tell(f"{robot!r} cannot answer {request}: {error!r}")
            return Answer("refused", why=f"{robot!r} cannot answer: {error!r}")

    def _answer(self, robot: str, request: Request, *, here: bool) -> Answer:
        if isinstance(request, Meet):
            return self._roster.answer(request, self._watching.is_gone)
        if isinstance(request, Leave):
            return self._see_off(robot, request)
        if isinstance(request, Ended):
            return self._learn(request)
        answer = self._owners.answer(robot, request, self._now(), here=here)
        if isinstance(request, Begin) and answer.what != "refused":
            self._watching.left.pop(request.id.sender, None)
        return answer

    def _see_off(self, robot: str, farewell: Leave) -> Answer:
        sender = farewell.id.sender
        # First the time: a notify that needs no answer any more must be later than all the robot did.
        self._owners.use(farewell.lamport)
        # It has ended, also where that cannot be kept: then it is told again as long as it is there.
        self._watching.left[sender] = farewell.lamport
        if sender not in self._owners:
            self._outbox.gone(sender)
        return self._owners.see_off(robot, sender, farewell.lamport)

    def _learn(self, tidings: Ended) -> Answer:
        for robot, lamport in tidings.robots:
            if robot not in self._owners and self._watching.hear_say(robot, lamport):
                self._owners.use(lamport)
                self._outbox.gone(robot)
        return Answer("done")
