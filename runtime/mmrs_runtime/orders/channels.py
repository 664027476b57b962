"""Calls of the processes that run robots: all at once, so that none that hangs keeps the others waiting."""

from __future__ import annotations

import json
import queue
import socket
import threading
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..clock import SIGNAL_SECONDS
from .orders import STATUS, is_answer
from .status_table import is_standing

CALL_SECONDS = 5.0
LONGEST_REPLY = 1 << 20
STRANGE = "what answers at its port is not its process, or does not answer as that should"
_BOOT = Path("/proc/sys/kernel/random/boot_id")

Request = tuple[int, Mapping[str, Any]]
"""A port of this machine, and the order that is given there, with its `robots`."""


def network() -> str:
    """Return what tells the network of this process from that of another machine, or container.

    It changes when the machine is started again; where the system does not say, it is the machine's name.
    """
    try:
        return f"{_BOOT.read_text('ascii').strip()} {Path('/proc/self/ns/net').readlink()}"
    except OSError:
        return socket.gethostname()


class Unreachable(Exception):  # noqa: N818  # reads as what it says of the robots
    """No process to give the order to, or it does not answer."""


def object_in(line: str | bytes) -> dict[str, Any]:
    """Return the object of JSON in a line.

    Raises:
        ValueError: there is none, or it has a name twice.
    """
    twice: list[str] = []

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        twice.extend(name for name, count in Counter(name for name, _ in pairs).items() if count > 1)
        return dict(pairs)

    try:
        given = json.loads(line, object_pairs_hook=once)
    except (ValueError, RecursionError) as error:
        raise ValueError("an order is one line of JSON") from error
    if twice:
        raise ValueError(f"{twice[0]!a} is there more than once")
    if not isinstance(given, dict):
        raise ValueError("an order is an object of JSON")
    return given


def asked_at_once(
    requests: Sequence[Request], seconds: float
) -> Iterator[tuple[int, dict[str, Any] | Exception]]:
    """Yield whatever is answered as soon as it is, with the number of the request.

    The last of a request that fails is `Unreachable`, or a `ValueError` where it is not understood.

    Args:
        requests: each to a process.
        seconds: that a process may take for an answer.
    """
    said: queue.SimpleQueue[tuple[int, dict[str, Any] | Exception | None]] = queue.SimpleQueue()

    def ask(number: int, request: Request) -> None:
        try:
            for reply in _replies(*request, seconds):
                said.put((number, reply))
        except (Unreachable, ValueError) as error:
            said.put((number, error))
        finally:
            said.put((number, None))

    for number, request in enumerate(requests):
        threading.Thread(target=ask, args=(number, request), name="call", daemon=True).start()
    left = len(requests)
    while left:
        try:
            number, reply = said.get(timeout=SIGNAL_SECONDS)
        except queue.Empty:
            continue
        if reply is None:
            left -= 1
        else:
            yield number, reply


def _replies(port: int, content: Mapping[str, Any], seconds: float) -> Iterator[dict[str, Any]]:
    missing = set(content["robots"])
    try:
        with socket.create_connection(("127.0.0.1", port), CALL_SECONDS) as connection:
            connection.settimeout(seconds + CALL_SECONDS)
            connection.sendall(json.dumps(content).encode("ascii") + b"\n")
            with connection.makefile("rb") as file:
                while line := file.readline(LONGEST_REPLY):
                    reply = _reply_in(line, missing, content)
                    if reply is None:
                        return
                    missing.discard(reply["robot"])
                    yield reply
    except TimeoutError as error:
        raise Unreachable("its process does not answer") from error
    except ConnectionRefusedError as error:
        raise Unreachable("its process no longer runs") from error
    except OSError as error:
        raise Unreachable(f"its process cannot be reached: {error.strerror or error}") from error
    raise Unreachable("its process has ended before its answer")


def _reply_in(line: bytes, missing: Collection[str], content: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return what one of the missing robots says in a line; None: that was all.

    Raises:
        Unreachable: no process that runs robots says that.
        ValueError: the order is not understood; says why.
    """
    try:
        reply = object_in(line)
    except ValueError as error:
        raise Unreachable(STRANGE) from error
    if isinstance(reply.get("error"), str):
        raise ValueError(reply["error"])
    if reply.get("done") is True and not missing:
        return None
    robot = reply.get("robot")
    meant = is_standing(reply) if content["order"] == STATUS else is_answer(reply, content["order"])
    if not meant or not isinstance(robot, str) or robot not in missing:
        raise Unreachable(STRANGE)
    return reply
