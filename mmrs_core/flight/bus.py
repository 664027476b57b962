"""Slots of robots in several processes, by Zenoh (``pip install eclipse-zenoh``).

A slot belongs to its robot. A notification is a command to the owner: sent again with the same
number until the owner has answered, applied once, and on the owner's disk before the answer. Keys
hold digests, so that no name can reach beyond its own mission and run.
"""

from __future__ import annotations

import json
import os
import threading
import uuid
from collections.abc import Iterable, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

import zenoh

from .program import Robot
from .slots import Guard, LocalSlots, Record

ANSWER_SECONDS = 0.5
LEASE_MILLISECONDS = 1500


class BusSlots(LocalSlots):
    """The slots of this process's robots, and commands to the owners of all others."""

    def __init__(
        self,
        robots: Sequence[Robot],
        run: str,
        folder: Path,
        listen: Sequence[str] = (),
        connect: Sequence[str] = (),
    ) -> None:
        """Join the bus.

        Args:
            robots: those of this process.
            run: identifier of the run; notifications of other runs are not heard.
            folder: for what must survive this process.
            listen: endpoints to listen at.
            connect: endpoints of others; with none of either, others are found by multicast.
        """
        super().__init__()
        self._robots = {robot.id: robot for robot in robots}
        self._incarnation = uuid.uuid4().hex
        self._sent = 0
        self._seen: set[tuple[str, str, int]] = set()
        self._lost: set[str] = set()
        self._prefix = f"mmrs/{_digest(robots[0].mission)}/{_digest(run)}"
        folder.mkdir(parents=True, exist_ok=True)
        self._journals = {robot.id: folder / f"{Path(robot.log).stem}.slots.ndjson" for robot in robots}
        self._closing = threading.Lock()
        self._session: Any = zenoh.open(_configuration(listen, connect))
        self._tokens: dict[str, Any] = {}
        self._declared: list[Any] = [
            self._session.declare_queryable(self._key(robot, "slots"), self._answer) for robot in self._robots
        ]
        watched = {sender for robot in robots for _, senders in robot.senders for sender in senders}
        self._declared += [self._watch(robot) for robot in sorted(watched - set(self._robots))]
        for robot in self._robots:
            self._tokens[robot] = self._session.liveliness().declare_token(self._key(robot, "here"))

    def notify(
        self, sender: str, slots: Iterable[tuple[str, str]], active: bool, record: Record, guard: Guard
    ) -> None:
        """Record the notification, set own slots, and command the owners of the others."""
        given = tuple(slots)
        with self._changed:
            lamport = self.tick()
            self._sent += 1
            number = self._sent
            record(lamport)
            self._set([slot for slot in given if slot[0] in self._robots], active)
        waiting = sorted({robot for robot, _ in given} - set(self._robots))
        while waiting:
            waiting = [
                owner
                for owner in waiting
                if not self._command(
                    owner,
                    {
                        "sender": sender,
                        "incarnation": self._incarnation,
                        "number": number,
                        "lamport": lamport,
                        "slots": [slot for robot, slot in given if robot == owner],
                        "active": active,
                    },
                )
            ]
            if waiting:
                guard(tuple(waiting))

    def lost(self, robots: Iterable[str]) -> str | None:
        """Return one of these robots that has left or cannot be reached, if there is one."""
        given = tuple(robots)
        with self._changed:
            return super().lost(given) or next((robot for robot in given if robot in self._lost), None)

    def leave(self, robot: str) -> None:
        """Tell everybody that a robot will set no more slots."""
        super().leave(robot)
        with self._closing:
            token = self._tokens.pop(robot, None)
        if token is not None:
            token.undeclare()

    def close(self) -> None:
        """Leave the bus."""
        for robot in list(self._tokens):
            self.leave(robot)
        for each in self._declared:
            each.undeclare()
        self._session.close()

    def _command(self, owner: str, content: dict[str, object]) -> bool:
        replies = self._session.get(
            self._key(owner, "slots"), payload=json.dumps(content), timeout=ANSWER_SECONDS
        )
        return any(reply.ok is not None for reply in replies)

    def _answer(self, query: Any) -> None:
        owner = next((r for r in self._robots if self._key(r, "slots") == str(query.key_expr)), None)
        if owner is None or query.payload is None:
            return
        try:
            content = json.loads(query.payload.to_string())
            self._apply(owner, content)
        except (ValueError, KeyError, TypeError) as error:
            query.reply_err(f"not a notification: {error!r}")
            return
        query.reply(self._key(owner, "slots"), "applied")

    def _apply(self, owner: str, content: dict[str, Any]) -> None:
        known = (str(content["sender"]), str(content["incarnation"]), int(content["number"]))
        slots = [(owner, str(slot)) for slot in content["slots"]]
        robot = self._robots[owner]
        allowed = dict(robot.senders if content["active"] else robot.resets)
        for _, slot in slots:
            if known[0] not in allowed.get(slot, ()):
                raise ValueError(f"{known[0]!a} never sets slot {slot!a}")
        with self._changed:
            if known in self._seen:
                return
            self._keep(owner, content)
            self._seen.add(known)
            self._lamport = max(self._lamport, int(content["lamport"]))
            self._set(slots, bool(content["active"]))

    def _keep(self, owner: str, content: dict[str, Any]) -> None:
        with self._journals[owner].open("a", encoding="ascii", newline="\n") as file:
            file.write(json.dumps(content, ensure_ascii=True) + "\n")
            file.flush()
            os.fsync(file.fileno())

    def _watch(self, robot: str) -> Any:
        def seen(sample: Any) -> None:
            with self._changed:
                if sample.kind == zenoh.SampleKind.DELETE:
                    self._lost.add(robot)
                else:
                    self._lost.discard(robot)
                self._changed.notify_all()

        return self._session.liveliness().declare_subscriber(self._key(robot, "here"), seen, history=True)

    def _key(self, robot: str, what: str) -> str:
        return f"{self._prefix}/{_digest(robot)}/{what}"


def _digest(text: str) -> str:
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:24]


def _configuration(listen: Sequence[str], connect: Sequence[str]) -> Any:
    config = zenoh.Config()
    config.insert_json5("transport/link/tx/lease", str(LEASE_MILLISECONDS))
    if listen or connect:
        config.insert_json5("scouting/multicast/enabled", "false")
    if listen:
        config.insert_json5("listen/endpoints", json.dumps(list(listen)))
    if connect:
        config.insert_json5("connect/endpoints", json.dumps(list(connect)))
    return config
