"""The bus for programs that have no Zenoh: lines of JSON over loopback TCP.

One gateway serves one robot, and one program at a time. It keeps that robot's slots as any other end
of the bus does, but only while the program is connected: when the program goes without having ended,
or the gateway dies, the robot is lost to the others.
"""

from __future__ import annotations

import json
import os
import secrets
import socket
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..node import Node
from ..owners.members import Recorded
from ..reading import Unreadable, number_in, object_in, text_in
from ..words import LARGEST
from .session import Session, line_of

FILE = "gateway.json"
"""Name of the file that says where a gateway listens, and with which token it is spoken to."""

HELLO_SECONDS = 5.0
LONGEST_SILENCE = 3600

Enter = Callable[[Recorded | None], Node]


class Gateway:
    """Listens on a port of this machine until it is closed.

    Attributes:
        port: that it listens at.
        token: that a program must say first.
    """

    def __init__(self, robot: str, run: str, enter: Enter, folder: Path, port: int = 0) -> None:
        """Listen, and say where in a file that only this user can read.

        Args:
            robot: for which a program speaks here.
            run: identifier of the run.
            enter: opens this end of the bus for the robot; given what the log of a program that was
                started again says, None for one that begins.
            folder: for the file.
            port: to listen at; 0: any that is free.

        Raises:
            OSError: the port is taken, or the file cannot be written.
        """
        self._robot, self._run, self._enter = robot, run, enter
        self._socket = socket.create_server(("127.0.0.1", port))
        self.port: int = self._socket.getsockname()[1]
        self.token = secrets.token_hex(16)
        self._file = folder / FILE
        self._session: Session | None = None
        self._closed = threading.Event()
        _write_secret(self._file, {"port": self.port, "token": self.token, "robot": robot})

    def serve(self, say: Callable[[str], None]) -> None:
        """Serve one program after the other, until `close` is called.

        Args:
            say: tells people what goes on.
        """
        while not self._closed.is_set():
            try:
                connection, _ = self._socket.accept()
            except OSError:
                break  # closed: there is nobody to be told
            with connection:
                self._serve(connection, say)

    def close(self) -> None:
        """Stop serving; the robot is lost to the others unless its program has ended."""
        self._closed.set()
        # Closing alone would not wake a thread that waits for a connection.
        try:
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            self._closed.set()
        self._socket.close()
        if self._session is not None:
            self._session.hang_up()
        self._file.unlink(missing_ok=True)

    def _serve(self, connection: socket.socket, say: Callable[[str], None]) -> None:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connection.settimeout(HELLO_SECONDS)
        with connection.makefile("rb") as lines:
            try:
                hello = self._hello(line_of(lines))
                alive = _alive_in(hello)
                node = self._enter(_recorded_in(hello))
            except (OSError, ValueError) as error:
                _send(connection, {"is": "wrong", "why": str(error)})
                say(f"{self._robot!r}: a program was turned away: {error}")
                return
            connection.settimeout(None)
            say(f"{self._robot!r}: a program has come")
            self._session = Session(self._robot, self._run, node, connection, alive)
            try:
                self._session.run(lines)
            finally:
                node.close()
                self._session = None
            say(f"{self._robot!r}: the program has gone")

    def _hello(self, line: bytes) -> Mapping[str, Any]:
        """Return what a program says first.

        Raises:
            Unreadable: it does not say hello as it should.
        """
        content = object_in(line)
        if text_in(content, "do") != "hello":
            raise Unreadable("says something else before hello")
        if not secrets.compare_digest(text_in(content, "token", "").encode(), self.token.encode()):
            raise Unreadable("does not know the token")
        return content


def _alive_in(content: Mapping[str, Any]) -> int | None:
    """Return after how many seconds of silence a program counts as frozen; None: never."""
    if "alive" not in content:
        return None
    if not 1 <= (alive := number_in(content, "alive")) <= LONGEST_SILENCE:
        raise Unreadable(f"alive: no whole number of seconds from 1 to {LONGEST_SILENCE}")
    return alive


def _recorded_in(content: Mapping[str, Any]) -> Recorded | None:
    resumed = content.get("resumed")
    if resumed is None:
        return None
    if not isinstance(resumed, dict) or not isinstance(resumed.get("notifies"), list):
        raise Unreadable("resumed: no object with lamport and notifies")
    notifies = {}
    for each in resumed["notifies"]:
        match each:
            case [str(robot), str(slot), bool(active), int(lamport)]:
                notifies[robot, slot] = (active, lamport)
            case _:
                raise Unreadable("resumed: notifies are no lists of robot, slot, value and logical time")
    lamport = number_in(resumed, "lamport")
    if lamport > LARGEST // 2:
        raise Unreadable(f"resumed: lamport {lamport}: more steps than can be counted")
    return Recorded(lamport, notifies)


def _send(connection: socket.socket, content: Mapping[str, object]) -> None:
    try:
        connection.sendall(json.dumps(content).encode() + b"\n")
    except OSError:
        return  # it has gone already, and is turned away all the same


def _write_secret(path: Path, content: Mapping[str, object]) -> None:
    part = path.with_suffix(".part")
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(handle, "w", encoding="ascii") as file:
        file.write(json.dumps(content) + "\n")
    part.replace(path)
