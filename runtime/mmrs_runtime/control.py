"""The control channel: orders to the robots of a process, over loopback TCP, in lines of JSON.

A process that runs robots writes ``control.json`` into the folder of its logs: port, token, process and
robots, readable by its user only. An order is one line::

    {"token": "…", "order": "hold", "robots": ["Drone1"]}

without `robots` it is for all of them; ``answer`` has `question` and `answer` beside. There is one line of
answer for each robot, as soon as it has obeyed or refused, with the seconds that it took, then
``{"done": true}``; or one ``{"error": "…"}``. A client that gives no order in time, or one without the token,
is disconnected. Run this module to give orders: ``python -m mmrs_runtime.control hold --log logs``.
"""

from __future__ import annotations

import hmac
import json
import os
import queue
import secrets
import socket
import threading
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from errno import EEXIST
from pathlib import Path
from typing import Any

from .callers import Callers
from .orders.channels import network, object_in
from .orders.ordering import PATTERN
from .orders.orders import ANSWER, ORDERS, STATUS, Orders

FILE = "control.json"
ANSWER_SECONDS = 30.0
"""Longest time that a robot has for an answer; a client may ask for less with `seconds`."""

LONGEST_LINE = 65_536
TOO_LONG = {"error": f"an order is one line of less than {LONGEST_LINE} bytes"}
GREETING_SECONDS = 5.0
"""Longest time from the connection, or from the last answer, to the end of an order's line."""

DEAF_SECONDS = 60.0
"""How long a client may leave its answers unread."""

LAST_SECONDS = 1.0
"""How long a process that ends waits for answers to go out to those who gave orders."""

SORE_SECONDS = 0.2
CONNECTIONS = 16
"""Clients served at once."""

Status = Callable[[str], Mapping[str, object]]


class Taken(Exception):  # noqa: N818  # what the robot is
    """Another process runs a robot with its logs in the same folder."""


class Control:
    """Listens for orders in threads of its own, and gives them to the robots of a run."""

    def __init__(
        self,
        folder: Path,
        run: str,
        robots: Sequence[str],
        orders: Orders,
        status: Status,
        *,
        greeting_seconds: float = GREETING_SECONDS,
    ) -> None:
        """Start listening.

        Args:
            folder: of the logs; where the channel is announced.
            run: identifier of the run.
            robots: all of this process.
            orders: of the run.
            status: the status of a robot, as JSON has it; called from any thread.
            greeting_seconds: that a client has for the line of an order.

        Raises:
            Taken: another process runs one of these robots with its logs in that folder.
            OSError: the channel cannot be opened or announced.
        """
        self._robots, self._orders = tuple(robots), orders
        self._status = status
        self._token = secrets.token_urlsafe(24)
        self._late = {"error": f"an order is one whole line within {greeting_seconds:g} s"}
        self._server = socket.create_server(("127.0.0.1", 0))
        full = _written({"error": f"{CONNECTIONS} orders are being obeyed: give this one again"})
        self._callers = Callers(self._server, CONNECTIONS, greeting_seconds, full)
        facts = {
            "port": self._server.getsockname()[1],
            "token": self._token,
            "pid": os.getpid(),
            "run": run,
            "machine": socket.gethostname(),
            "network": network(),
            "robots": list(self._robots),
        }
        try:
            self._path = _announce(folder, json.dumps(facts) + "\n")
            _refuse_rivals(self._path, self._robots)
        except (OSError, Taken):
            self._server.close()
            raise
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._listen, name="control channel", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop listening, send the answers that are known, and remove the announcement."""
        self._closing.set()
        with suppress(OSError):
            # A call wakes the thread that waits for calls.
            socket.create_connection(self._server.getsockname(), 1.0).close()
        self._thread.join()
        self._server.close()
        self._callers.finish(LAST_SECONDS)
        self._path.unlink(missing_ok=True)

    def _listen(self) -> None:
        while not self._closing.is_set():
            try:
                caller = self._callers.take()
            except OSError:
                # The system has no more connections just now; the clients wait, and it may have some soon.
                self._closing.wait(SORE_SECONDS)
                continue
            if caller is not None:
                threading.Thread(target=self._serve, args=(caller,), name="orders", daemon=True).start()

    def _serve(self, caller: socket.socket) -> None:
        try:
            with caller, caller.makefile("rwb") as file:
                caller.settimeout(DEAF_SECONDS)
                while (line := file.readline(LONGEST_LINE)).endswith(b"\n"):
                    try:
                        given = self._proven(line)
                    except ValueError as error:
                        file.write(_written({"error": str(error)}))
                        return
                    with self._callers.served(caller):
                        for reply in self._replies(given):
                            file.write(_written(reply))
                            file.flush()
                file.write(_written(TOO_LONG if len(line) == LONGEST_LINE else self._late))
                file.flush()
                caller.shutdown(socket.SHUT_WR)
                while file.read(LONGEST_LINE):
                    pass  # whoever still sends would lose the answer if the connection were closed now
        except OSError:
            # Whoever gave the order does not want to hear its end; the robots obey all the same.
            return
        finally:
            self._callers.leave(caller)

    def _replies(self, given: Mapping[str, Any]) -> Iterator[Mapping[str, object]]:
        try:
            robots, order, seconds = self._understood(given)
        except ValueError as error:
            yield {"error": str(error)}
            return
        if order == STATUS:
            yield from ({"robot": robot, **self._status(robot)} for robot in robots)
        else:
            question, answer = (given["question"], given["answer"]) if order == ANSWER else ("", False)
            yield from self._obeyed(order, robots, seconds, question, answer)
        yield {"done": True}

    def _obeyed(
        self, order: str, robots: list[str], seconds: float, question: str, answer: bool
    ) -> Iterator[Mapping[str, object]]:
        answers: queue.SimpleQueue[tuple[str, str | None, float]] = queue.SimpleQueue()
        begun = time.monotonic()

        def answered(robot: str, why: str | None) -> None:
            answers.put((robot, why, time.monotonic() - begun))

        for robot in robots:
            self._orders.give(order, (robot,), question=question, answer=answer, answered=answered)
        missing = set(robots)
        while missing:
            try:
                robot, why, took = answers.get(timeout=max(0.0, begun + seconds - time.monotonic()))
            except queue.Empty:
                break
            missing.discard(robot)
            yield _line(robot, order, why is None, took, why or "")
        for robot in sorted(missing):
            yield _line(robot, order, False, seconds, "no answer yet; it will still be obeyed")

    def _proven(self, line: bytes) -> Mapping[str, Any]:
        """Return an order of one who knows the token.

        Raises:
            ValueError: it is none.
        """
        given = object_in(line)
        token = given.get("token")
        known = self._token.encode()
        if not isinstance(token, str) or not hmac.compare_digest(
            token.encode("utf-8", "surrogatepass"), known
        ):
            raise ValueError("token: is not that of this process")
        return given

    def _understood(self, given: Mapping[str, Any]) -> tuple[list[str], str, float]:
        robots = given.get("robots", list(self._robots))
        if not isinstance(robots, list) or not robots or not all(isinstance(robot, str) for robot in robots):
            raise ValueError("robots: must be a list of names")
        unknown = [robot for robot in robots if robot not in self._robots]
        if unknown:
            known = ", ".join(map(ascii, self._robots))
            raise ValueError(f"{', '.join(map(ascii, unknown))}: no robot of this process, which has {known}")
        return list(dict.fromkeys(robots)), _order(given), _seconds(given.get("seconds", ANSWER_SECONDS))


def _written(reply: Mapping[str, object]) -> bytes:
    return json.dumps(reply).encode("ascii") + b"\n"


def _line(robot: str, order: str, confirmed: bool, seconds: float, why: str) -> Mapping[str, object]:
    return {"robot": robot, "order": order, "confirmed": confirmed, "seconds": round(seconds, 4), "why": why}


def _order(given: Mapping[str, Any]) -> str:
    name = given.get("order")
    if not isinstance(name, str) or name not in ORDERS:
        shown = f"{name!r} is" if isinstance(name, str) else "is"
        raise ValueError(f"order: {shown} none of {', '.join(ORDERS)}")
    question, answer = given.get("question"), given.get("answer")
    if name == ANSWER and not (isinstance(question, str) and question and isinstance(answer, bool)):
        raise ValueError("answer: needs a question, and an answer that is true or false")
    return name


def _seconds(given: object) -> float:
    if isinstance(given, bool) or not isinstance(given, int | float) or not 0 < given <= ANSWER_SECONDS:
        raise ValueError(f"seconds: must be a number above 0 up to {ANSWER_SECONDS:.0f}")
    return float(given)


def _announce(folder: Path, text: str) -> Path:
    """Write the announcement where no process that is still there has put its own."""
    folder.mkdir(parents=True, exist_ok=True)
    usual = folder / FILE
    for path in folder.glob(PATTERN):
        if _was_left(path):
            path.unlink(missing_ok=True)
    for path in (usual, folder / f"{usual.stem}-{os.getpid()}{usual.suffix}"):
        try:
            number = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        except FileExistsError:
            continue
        try:
            with os.fdopen(number, "w", encoding="ascii") as file:
                file.write(text)
        except BaseException:
            path.unlink(missing_ok=True)  # half of it would be taken for one that is being written
            raise
        return path
    raise FileExistsError(EEXIST, "already there, of a process that still runs", str(usual))


def _refuse_rivals(own: Path, robots: Collection[str]) -> None:
    """Take an announcement away again where another process runs one of its robots.

    Raises:
        Taken: one does.
    """
    for path in sorted({*own.parent.glob(PATTERN)} - {own}):
        try:
            facts = object_in(path.read_bytes())
        except (OSError, ValueError):
            continue  # it is being written, by somebody who looks at ours then, or taken away
        others = facts.get("robots")
        if shared := [robot for robot in robots if isinstance(others, list) and robot in others]:
            own.unlink()
            names = f"{', '.join(map(ascii, shared))} {'is' if len(shared) == 1 else 'are'}"
            raise Taken(f"{names} run by process {facts.get('pid')} already ({path.name}): end that first")


def _was_left(path: Path) -> bool:
    """Return whether an announcement is that of a process that no longer runs.

    Its port may belong to another program by now, where its process does not run, or runs in another
    container.
    """
    try:
        facts = object_in(path.read_bytes())
        port, process = int(facts["port"]), facts.get("pid")
        with socket.create_connection(("127.0.0.1", port), 1.0) as connected:
            return isinstance(process, int) and not _runs(process) and not _answers(connected, facts)
    except (ValueError, KeyError, TypeError, OverflowError):
        return False  # it may be being written right now
    except OSError:
        return True


def _runs(process: int) -> bool:
    if os.name != "posix":
        return True  # there, to ask would be to kill
    try:
        os.kill(process, 0)
    except PermissionError:
        return True
    except OSError:
        return False
    return True


def _answers(connected: socket.socket, facts: Mapping[str, object]) -> bool:
    """Return whether the listener there takes orders."""
    ask = {"token": facts.get("token"), "order": STATUS}
    try:
        with connected.makefile("rwb") as file:
            file.write(json.dumps(ask).encode() + b"\n")
            file.flush()
            object_in(file.readline(LONGEST_LINE))
    except (OSError, ValueError):
        return False
    return True


if __name__ == "__main__":
    from .orders.ordering import main

    raise SystemExit(main())
