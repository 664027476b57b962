"""One program at a gateway: its requests, and the events it receives."""

from __future__ import annotations

import json
import socket
import struct
import threading
import time
from collections.abc import Callable, Mapping
from select import select
from typing import IO, Any

from ..meeting import Incomplete, begin_together
from ..messages import (
    LONGEST,
    MOST_SLOTS,
    REACH,
    CommandId,
    Unreadable,
    finds_in,
    flag_in,
    names_in,
    number_in,
    object_in,
    text_in,
)
from ..node import Node
from ..outgoing import BusDelivery
from ..threads import Net, tell_people

WAITING_SECONDS = 1.0
"""How often a program is sent the robots that its notify waits for."""

DEAF_SECONDS = 5.0
"""How long a program may leave its messages unread, once no more can be sent."""

WATCHING_SECONDS = 0.2
"""How often it is looked whether a program is still there that has said how often it speaks."""


def line_of(lines: IO[bytes]) -> bytes:
    """Return the next line; of one that is longer than any message only so much that this is seen.

    Raises:
        OSError: the connection broke.
    """
    line = part = lines.readline(LONGEST + 1)
    while len(part) > LONGEST and not part.endswith(b"\n"):
        part = lines.readline(LONGEST + 1)
    return line


class Session:
    """Serves one program until it disconnects.

    Attributes:
        why: it was disconnected, as the end of a sentence; empty: it disconnected first.
    """

    def __init__(
        self, robot: str, run: str, node: Node, connection: socket.socket, alive: float | None = None
    ) -> None:
        """Speak for a robot at an end of the bus.

        Args:
            robot: whose program it is.
            run: identifier of the run.
            node: the end of the bus.
            connection: to the program.
            alive: seconds of silence after which the program counts as frozen; None: it never does.
        """
        self.why = ""
        patience = min(DEAF_SECONDS, alive or DEAF_SECONDS)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack("ll", *_parts(patience)))
        self._robot, self._run, self._node, self._connection = robot, run, node, connection
        self._turn = threading.Lock()
        self._deliveries: dict[int, BusDelivery] = {}
        self._latest = -1
        self._reported: dict[int, str] = {}
        self._told_waiting = 0.0
        self._alive, self._received, self._frozen = alive, time.monotonic(), False
        self._look = threading.Event()
        self._changed = False
        self._over = threading.Event()
        self._slots, self._targets = node.slots_of(robot), node.targets_of(robot)
        node.on_change(self._take_note)

    def run(self, lines: IO[bytes]) -> None:
        """Answer every line, and send every change, until the program disconnects."""
        slots = list(self._slots)
        self._say({"is": "welcome", "robot": self._robot, "run": self._run, "slots": slots})
        teller = threading.Thread(target=self._tell_news, name="gateway news", daemon=True)
        teller.start()
        try:
            while line := line_of(lines):
                self._hear()
                with self._turn:
                    self._say(self._answer(line))
                    # Whoever waits for an answer is not silent.
                    self._hear()
                self._look.set()
        except OSError:
            self._over.set()  # the connection broke: the program has gone
        self._over.set()
        self._look.set()
        teller.join()

    def hang_up(self) -> None:
        """End the connection."""
        try:
            self._connection.shutdown(socket.SHUT_RDWR)
        except OSError:
            self._over.set()

    def _hear(self) -> None:
        self._received = time.monotonic()
        if self._frozen:
            self._frozen = False
            self._node.show(self._robot)

    def _watch(self) -> None:
        """Let the robot be out of reach while its program is silent for too long."""
        if self._alive is not None and time.monotonic() - self._received > self._alive:
            self._frozen = True
            self._node.hide(self._robot)

    def _answer(self, line: bytes) -> Mapping[str, object]:
        try:
            content = object_in(line)
            what = text_in(content, "do")
            if what not in self._ANSWERS:
                raise Unreadable(f"{what!r}: nothing that can be done here")
            return self._ANSWERS[what](self, content)
        except (ValueError, OSError) as error:
            return {"is": "wrong", "why": str(error)}
        except Exception as error:
            tell_people(f"{self._robot!r}: cannot answer its program: {error!r}")
            return {"is": "wrong", "why": f"the gateway itself fails: {error!r}"}

    def _prepare(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        number, active = number_in(content, "number"), flag_in(content, "active")
        if number <= self._latest:
            raise Unreadable(f"number {number}: not greater than {self._latest}, the one before")
        slots = _slots_in(content)
        for robot, _ in slots:
            if robot not in self._targets:
                raise Unreadable(f"slots: {self._robot!r} never sets any of {robot!r}")
        self._latest = number
        id = CommandId(self._run, self._robot, "", number)
        self._deliveries[number] = self._node.prepare(id, slots, active, finds_in(content, MOST_SLOTS))
        return {"is": "asked", "number": number}

    def _send(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        number = number_in(content, "number")
        delivery, lamport = self._delivery(number), number_in(content, "lamport")
        if delivery.lamport is None:
            raise Unreadable(f"number {number}: is not granted yet")
        delivery.send(lamport)
        return {"is": "sent", "number": number}

    def _abort(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        number = number_in(content, "number")
        self._delivery(number).abort()
        del self._deliveries[number]
        return {"is": "aborted", "number": number}

    def _delivery(self, number: int) -> BusDelivery:
        found = self._deliveries.get(number)
        if found is None:
            raise Unreadable(f"number {number}: no such notify is in progress")
        return found

    def _state(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        finds = self._node.finds(self._robot)
        reported = {"finds": [list(find) for find in finds]} if finds else {}
        return {"is": "state", "slots": json.loads(self._node.shown(self._robot)), **reported}

    def _pass(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        slots = [(self._robot, name) for name in names_in(content, "slots")]
        for _, name in slots:
            if name not in self._slots:
                raise Unreadable(f"{self._robot!r} has no slot {name!r}")
        # A slot that was kept for a sender that is lost may be ahead of all that has happened.
        ahead = max((self._node.state(slot).lamport for slot in slots), default=0)
        lamport, most = number_in(content, "lamport"), max(self._node.lamport, ahead) + REACH
        if lamport > most:
            raise Unreadable(f"lamport {lamport}: far beyond all that has happened, at most {most}")
        passed = self._node.passed(slots, lamport)
        return {"is": "passed" if passed else "held"}

    def _lost(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        return {"is": "lost", "robots": list(self._node.lost(names_in(content, "robots")))}

    def _begin(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        patience = number_in(content, "seconds", 60)
        robots = names_in(content, "robots")
        if self._robot not in robots:
            raise Unreadable(f"robots: {self._robot!r} is not among them")
        try:
            begun = begin_together(self._node, self._robot, robots, self._stay, patience=patience)
        except Incomplete as error:
            raise Unreadable(str(error)) from None
        return {"is": "begun", "offset": begun.offset, "uncertainty": begun.uncertainty, "late": begun.late}

    def _stay(self, missing: str) -> None:
        """Check that the waiting program is still connected: a robot without its program must not begin.

        Raises:
            OSError: it has disconnected.
        """
        received, _, _ = select([self._connection], [], [], 0.0)
        if received and not self._connection.recv(1, socket.MSG_PEEK):
            raise ConnectionAbortedError("the program has gone")

    def _live(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        return {"is": "alive"}

    def _leave(self, content: Mapping[str, Any]) -> Mapping[str, object]:
        self._node.leave(self._robot)
        return {"is": "left"}

    def _take_note(self) -> None:
        self._changed = True
        self._look.set()

    def _tell_news(self) -> None:
        net = Net()
        while not self._over.is_set():
            self._look.wait(WAITING_SECONDS if self._alive is None else WATCHING_SECONDS)
            self._look.clear()
            self._watch()
            with net.under(f"telling the program of {self._robot!r} what is new"), self._turn:
                if self._changed:
                    self._changed = False
                    self._say({"is": "changed"})
                for number, delivery in tuple(self._deliveries.items()):
                    self._tell_delivery(number, delivery)

    def _tell_delivery(self, number: int, delivery: BusDelivery) -> None:
        what, more = _progress(delivery)
        now = time.monotonic()
        again = what == "waiting" and now - self._told_waiting >= WAITING_SECONDS
        if self._reported.get(number) == what and not again:
            return
        if what == "waiting":
            self._told_waiting = now
        self._reported[number] = what
        self._say({"is": what, "number": number, **more})
        if what == "acknowledged":
            self._deliveries.pop(number, None)

    def _say(self, content: Mapping[str, object]) -> None:
        try:
            self._connection.sendall(json.dumps(content).encode() + b"\n")
        except BlockingIOError:
            self.why = ": it does not read its messages"
            self._over.set()
            self.hang_up()
        except OSError:
            self._over.set()  # the program has gone: reading ends, too

    _ANSWERS: Mapping[str, Callable[[Session, Mapping[str, Any]], Mapping[str, object]]] = {
        "prepare": _prepare,
        "send": _send,
        "abort": _abort,
        "state": _state,
        "pass": _pass,
        "lost": _lost,
        "begin": _begin,
        "alive": _live,
        "leave": _leave,
    }


def _parts(seconds: float) -> tuple[int, int]:
    """Return whole seconds, and microseconds of the rest."""
    return int(seconds), int(seconds % 1 * 1e6)


def _slots_in(content: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    found = content.get("slots")
    if not isinstance(found, list) or len(found) > MOST_SLOTS:
        raise Unreadable(f"slots: no list of 1 to {MOST_SLOTS}")
    if not found:
        raise Unreadable("slots: none")
    return tuple(_slot(each) for each in found)


def _slot(each: object) -> tuple[str, str]:
    if not isinstance(each, list) or len(each) != 2 or not all(isinstance(part, str) for part in each):
        raise Unreadable("slots: no lists of robot and slot")
    return each[0], each[1]


def _progress(delivery: BusDelivery) -> tuple[str, Mapping[str, object]]:
    """Return how far a notify is, in a word and with what belongs to it."""
    if delivery.refusals:
        return "refused", {"why": "; ".join(delivery.refusals.values())}
    if delivery.waiting:
        return "waiting", {"for": list(delivery.waiting)}
    if delivery.is_over:
        return "acknowledged", {}
    return "granted", {"lamport": delivery.lamport}
