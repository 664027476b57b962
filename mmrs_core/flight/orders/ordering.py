"""Gives orders to the robots of running processes, which it finds by the folder of their logs."""

from __future__ import annotations

import argparse
import json
import socket
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..screen import bear_all_characters
from .orders import ANSWER, ORDERS, STATUS
from .standing import lines_of

PATTERN = "control*.json"
CALL_SECONDS = 5.0
USUAL_SECONDS = 10.0
WORDS = {"yes": True, "no": False}


class Unreachable(Exception):  # noqa: N818  # reads as what it says of the robots
    """There is no process to give the order to, or it does not listen."""


@dataclass(frozen=True, slots=True)
class Channel:
    """Where a process listens: its port, its token, and the robots that it runs."""

    port: int
    token: str
    robots: tuple[str, ...]


def channels(folder: Path) -> tuple[Channel, ...]:
    """Return where the processes listen that keep their logs in a folder.

    Raises:
        Unreachable: there is none.
    """
    found = [channel for path in sorted(folder.glob(PATTERN)) for channel in _read(path)]
    if not found:
        raise Unreachable(f"{folder}: no robots are running with their logs there")
    return tuple(found)


def give(
    folder: Path,
    order: str,
    robots: Sequence[str] = (),
    *,
    question: str = "",
    answer: bool = False,
    seconds: float = USUAL_SECONDS,
) -> Iterator[dict[str, Any]]:
    """Give an order, and yield what each robot says as soon as it says it.

    Args:
        folder: of the robots' logs.
        order: one of `ORDERS`.
        robots: to be ordered; none: all; of an answer, all that ask the question.
        question: that is answered.
        answer: to the question.
        seconds: to wait for the robots.

    Yields:
        `robot`, `order`, `confirmed`, `seconds`, `why`; for ``status`` the robot's state.

    Raises:
        Unreachable: a process does not listen, or one of the robots is nowhere.
        ValueError: a process does not understand the order.
    """
    found = channels(folder)
    missing = [robot for robot in robots if not any(robot in channel.robots for channel in found)]
    if missing:
        known = ", ".join(repr(robot) for channel in found for robot in channel.robots)
        raise Unreachable(f"{', '.join(map(repr, missing))}: not running; there are {known}")
    content = {"order": order, "question": question, "answer": answer, "seconds": seconds}
    with ExitStack() as stack:
        calls = [
            stack.enter_context(_call(channel, {**content, "robots": wanted}, seconds))
            for channel in found
            if (wanted := [robot for robot in channel.robots if not robots or robot in robots])
        ]
        replies = (reply for call in calls for reply in _replies(call))
        yield from replies if robots or order != ANSWER else _of_those_who_ask([*replies])


def _of_those_who_ask(replies: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return what came of an answer to all robots: it is for those that ask, if there are any."""
    return [reply for reply in replies if reply["confirmed"]] or replies


def main(arguments: Sequence[str] | None = None) -> int:
    """Give the order on the command line; return 0 if every robot has confirmed it."""
    bear_all_characters()
    given = _parser().parse_args(arguments)
    if (given.order == ANSWER) != bool(given.question):
        _parser().error("answer needs --question QUESTION --says yes|no, and nothing else has it")
    try:
        replies = give(
            given.log,
            given.order,
            given.robots,
            question=given.question or "",
            answer=WORDS[given.says],
            seconds=given.seconds,
        )
        if given.order == STATUS:
            print(*lines_of([*replies]), sep="\n")
            return 0
        return _tell(replies)
    except (Unreachable, ValueError, OSError) as error:
        print(f"{error}", file=sys.stderr)
        return 5


def words(reply: dict[str, Any]) -> str:
    """Return what a robot says to an order that it may obey, as people read it."""
    robot = repr(reply["robot"])
    why = f" ({reply['why']})" if reply["why"] else ""
    if reply["confirmed"]:
        return f"{robot}: {reply['order']} confirmed after {reply['seconds']:.3f} s{why}"
    return f"{robot}: {reply['order']} not confirmed{why}"


def _tell(replies: Iterator[dict[str, Any]]) -> int:
    confirmed = True
    for reply in replies:
        print(words(reply))
        confirmed = confirmed and reply["confirmed"]
    return 0 if confirmed else 1


def _parser() -> argparse.ArgumentParser:
    orders = "; ".join(f"{name}: {meaning}" for name, meaning in ORDERS.items())
    parser = argparse.ArgumentParser(
        prog="python -m mmrs_flight.control",
        description=f"Gives orders to robots that are running. {orders}.",
        epilog="Exit codes: 0 every robot has confirmed, 1 one has not, 2 usage, 5 no robots to be found.",
    )
    add = parser.add_argument
    add("order", choices=tuple(ORDERS))
    add("robots", nargs="*", metavar="ROBOT", help="none: all robots that are running")
    add("--log", type=Path, default=Path("logs"), help="folder of the robots' logs")
    add("--question", help="that is answered")
    add("--says", choices=tuple(WORDS), default="no", help="the answer to the question")
    add("--seconds", type=float, default=USUAL_SECONDS, help="to wait for the robots, 30 at most")
    return parser


def _read(path: Path) -> Iterator[Channel]:
    try:
        facts = json.loads(path.read_text("ascii"))
        yield Channel(int(facts["port"]), str(facts["token"]), tuple(map(str, facts["robots"])))
    except (OSError, ValueError, KeyError, TypeError):
        # It is being written, or taken away, right now; what was meant to be there will be in a moment.
        return


def _call(channel: Channel, content: dict[str, Any], seconds: float) -> socket.socket:
    try:
        connection = socket.create_connection(("127.0.0.1", channel.port), CALL_SECONDS)
    except OSError as error:
        shown = ", ".join(map(repr, channel.robots))
        raise Unreachable(f"{shown}: no longer running: {error.strerror or error}") from error
    connection.settimeout(seconds + CALL_SECONDS)
    connection.sendall(json.dumps({"token": channel.token, **content}).encode("ascii") + b"\n")
    return connection


def _replies(connection: socket.socket) -> Iterator[dict[str, Any]]:
    with connection.makefile("rb") as file:
        for line in file:
            reply = json.loads(line)
            if "error" in reply:
                raise ValueError(reply["error"])
            if reply.get("done") is True:
                return
            yield reply
    raise Unreachable("the robots' process has ended before its answer")
