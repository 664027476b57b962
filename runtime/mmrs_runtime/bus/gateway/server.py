"""The bus for programs that have no Zenoh: lines of JSON over loopback TCP.

One gateway serves one robot, and one program at a time; a client that connects and does not say hello
blocks no other. The gateway keeps that robot's slots as any other end
of the bus does, but only while the program is connected: when the program disconnects without having ended,
or the gateway dies, the other robots lose the robot.
"""

from __future__ import annotations

import json
import secrets
import socket
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, Any

from ...callers import Callers
from ...records.disk import write_secret
from ..messages import LARGEST, LONGEST, Unreadable, number_in, object_in, text_in
from ..node import Node
from ..owners import Recorded
from .session import Session

FILE = "gateway.json"
"""Name of the file with a gateway's address and token."""

HELLO_SECONDS = 5.0
"""How long a program has to say hello, and how long it waits for the one before it to be gone."""

SORE_SECONDS = 0.2
MOST_WAITING = 512
MOST_CALLERS = 16
"""Clients connected at once, one of them served; a new client beyond that replaces the first."""

LONGEST_SILENCE = 3600

Enter = Callable[[Recorded | None], Node]


class Gateway:
    """Listens on a port of this machine until it is closed.

    Attributes:
        port: that it listens at.
        token: that a program must say first.
    """

    def __init__(
        self,
        robot: str,
        run: str,
        enter: Enter,
        folder: Path,
        port: int = 0,
        *,
        hello_seconds: float = HELLO_SECONDS,
    ) -> None:
        """Listen, and announce the address in a file that only this user can read.

        Args:
            robot: for which a program speaks here.
            run: identifier of the run.
            enter: opens this end of the bus for the robot; given the log of a program that was
                started again, None for one that begins.
            folder: for the file.
            port: to listen on; 0 picks a free port.
            hello_seconds: that a program has to say hello.

        Raises:
            OSError: the port is taken, or the file cannot be written.
        """
        self._robot, self._run, self._enter = robot, run, enter
        self._socket = socket.create_server(("127.0.0.1", port), backlog=MOST_WAITING)
        self._hello_seconds = hello_seconds
        full = _written({"is": "wrong", "why": f"{MOST_CALLERS} programs wait already"})
        self._callers = Callers(self._socket, MOST_CALLERS, hello_seconds, full)
        self.port: int = self._socket.getsockname()[1]
        self.token = secrets.token_hex(16)
        self._file = folder / FILE
        self._session: Session | None = None
        self._closed, self._seat = threading.Event(), threading.Lock()
        write_secret(self._file, _written({"port": self.port, "token": self.token, "robot": robot}))

    def serve(self, say: Callable[[str], None]) -> None:
        """Serve one program after the other, until `close` is called.

        Args:
            say: reports events to the operator.
        """
        while not self._closed.is_set():
            try:
                connection = self._callers.take()
            except OSError as error:
                if not self._closed.wait(SORE_SECONDS):
                    say(f"{self._robot!r}: a program could not be let in: {error.strerror}")
                continue
            if connection is not None:
                threading.Thread(target=self._let_in, args=(connection, say), daemon=True).start()
        with self._seat:
            return  # the program that was served has gone

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

    def _let_in(self, connection: socket.socket, say: Callable[[str], None]) -> None:
        """Serve a program that says hello in time, once none is served any more."""
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        with connection, connection.makefile("rb") as lines:
            try:
                hello = self._hello(lines.readline(LONGEST + 1))
                with self._callers.served(connection):
                    self._seat_one(connection, lines, hello, say)
            except (OSError, ValueError) as error:
                self._turn_away(connection, error, say)
            finally:
                self._callers.leave(connection)

    def _seat_one(
        self,
        connection: socket.socket,
        lines: IO[bytes],
        hello: Mapping[str, Any],
        say: Callable[[str], None],
    ) -> None:
        """Serve a program once none is served any more.

        Raises:
            Unreadable: another still is, or the hello makes no sense.
        """
        alive, recorded = _alive_in(hello), _recorded_in(hello)
        if not self._seat.acquire(timeout=HELLO_SECONDS):
            raise Unreadable(f"another program speaks for {self._robot!r} already")
        try:
            self._serve(connection, lines, alive, recorded, say)
        finally:
            self._session = None
            self._seat.release()

    def _serve(
        self,
        connection: socket.socket,
        lines: IO[bytes],
        alive: int | None,
        recorded: Recorded | None,
        say: Callable[[str], None],
    ) -> None:
        try:
            node = self._enter(recorded)
        except (OSError, ValueError) as error:
            self._turn_away(connection, error, say)
            return
        say(f"{self._robot!r}: a program has come")
        session = self._session = Session(self._robot, self._run, node, connection, alive)
        if self._closed.is_set():
            session.hang_up()
        try:
            session.run(lines)
        finally:
            node.close()
        say(f"{self._robot!r}: the program has gone{session.why}")

    def _turn_away(self, connection: socket.socket, error: Exception, say: Callable[[str], None]) -> None:
        _send(connection, {"is": "wrong", "why": str(error)})
        say(f"{self._robot!r}: a program was turned away: {error}")

    def _hello(self, line: bytes) -> Mapping[str, Any]:
        """Return what a program says first.

        Raises:
            Unreadable: it does not say hello as it should.
        """
        if not line.endswith(b"\n") and len(line) <= LONGEST:
            raise Unreadable(f"says no hello within {self._hello_seconds:g} s")
        content = object_in(line)
        if text_in(content, "do") != "hello":
            raise Unreadable("says something else before hello")
        token = text_in(content, "token", "").encode("utf-8", "surrogatepass")
        if not secrets.compare_digest(token, self.token.encode()):
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
    notifies = dict(_notify_in(each) for each in resumed["notifies"])
    return Recorded(_time_in(resumed), notifies)


def _notify_in(each: object) -> tuple[tuple[str, str], tuple[bool, int]]:
    match each:
        case [str(robot), str(slot), bool(active), int(lamport)]:
            return (robot, slot), (active, _time_in({"lamport": lamport}))
        case _:
            raise Unreadable("resumed: notifies must be lists of robot, slot, value and logical time")


def _time_in(content: Mapping[str, Any]) -> int:
    """Return the logical time of something that a program has recorded.

    Raises:
        Unreadable: there is none.
    """
    lamport = number_in(content, "lamport")
    if lamport > LARGEST // 2:
        raise Unreadable(f"resumed: lamport {lamport}: more steps than can be counted")
    return lamport


def _send(connection: socket.socket, content: Mapping[str, object]) -> None:
    try:
        connection.sendall(_written(content))
    except OSError:
        return  # it has gone already, and is turned away all the same


def _written(content: Mapping[str, object]) -> bytes:
    return json.dumps(content).encode() + b"\n"
