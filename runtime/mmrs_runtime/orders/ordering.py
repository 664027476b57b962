"""Gives orders to the robots of running processes, which it finds by the folder of their logs."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..screen import bear_all_characters
from .channels import Unreachable, asked_at_once, network, object_in
from .orders import ANSWER, ORDERS, STATUS
from .status_table import lines_of

PATTERN = "control*.json"
USUAL_SECONDS = 10.0
LARGEST_PORT = 65_535
WORDS = {"yes": True, "no": False}


@dataclass(frozen=True, slots=True)
class Channel:
    """Where a process listens: its port, its token, and the robots that it runs.

    Attributes:
        elsewhere: the name of the machine where it was started, if that was in another network than this.
    """

    port: int
    token: str
    robots: tuple[str, ...]
    elsewhere: str = ""


def channels(folder: Path) -> tuple[Channel, ...]:
    """Return where the processes listen that keep their logs in a folder.

    Raises:
        Unreachable: there is none.
    """
    found = [channel for path in sorted(folder.glob(PATTERN)) for channel in _read(path)]
    if not found:
        raise Unreachable(
            f"{folder}: no running robots use this log folder; name the folder of the run with --log"
        )
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
    """Give an order, and yield each robot's answer as it arrives.

    A process that has died, or hangs, does not keep the order from others: its robots are reported as
    unreachable.

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
        Unreachable: one of the robots is nowhere, or no process can be reached at all.
        ValueError: no process understands the order.
    """
    found = channels(folder)
    missing = [robot for robot in robots if not any(robot in channel.robots for channel in found)]
    if missing:
        known = ", ".join(repr(robot) for channel in found for robot in channel.robots)
        raise Unreachable(f"{', '.join(map(repr, missing))}: not running; there are {known}")
    content = {"order": order, "question": question, "answer": answer, "seconds": seconds}
    replies = _replies(_chosen(found, robots), content, seconds)
    yield from replies if robots or order != ANSWER else _of_those_who_ask([*replies])


def _chosen(found: Sequence[Channel], robots: Sequence[str]) -> list[Channel]:
    """Return the processes that run some of these robots, or any where there are none, with these alone."""
    parts = (
        replace(channel, robots=tuple(each for each in channel.robots if not robots or each in robots))
        for channel in found
    )
    return [channel for channel in parts if channel.robots]


def _replies(
    asked: Sequence[Channel], content: Mapping[str, Any], seconds: float
) -> Iterator[dict[str, Any]]:
    requests = [
        (channel.port, {"token": channel.token, **content, "robots": list(channel.robots)})
        for channel in asked
    ]
    received: set[str] = set()
    failed: dict[int, Exception] = {}
    for number, said in asked_at_once(requests, seconds):
        if isinstance(said, Exception):
            failed[number] = _far(asked[number].elsewhere) if asked[number].elsewhere else said
        else:
            received.add(said["robot"])
            yield said
    lost = [(asked[number], failed[number]) for number in sorted(failed)]
    if not received:
        _raise_for(lost)
    # Who was started again has a process that answers beside the one that does not.
    silent = {robot: str(why) for channel, why in lost for robot in channel.robots if robot not in received}
    for robot, why in silent.items():
        yield _silent(robot, str(content["order"]), why)


def _far(machine: str) -> Unreachable:
    return Unreachable(
        f"was started on {machine!r}, in another network than this or before a restart, and takes orders only"
        " there: from here, it is unknown whether it runs"
    )


def _raise_for(lost: Sequence[tuple[Channel, Exception]]) -> None:
    for _, error in lost:
        if isinstance(error, ValueError):
            raise error
    if lost:
        raise Unreachable("; ".join(f"{', '.join(map(repr, each.robots))}: {why}" for each, why in lost))


def _silent(robot: str, order: str, why: str) -> dict[str, Any]:
    """Return what is said for a robot whose process says nothing."""
    if order == STATUS:
        return {"robot": robot, "phase": why}
    return {"robot": robot, "order": order, "confirmed": False, "seconds": 0.0, "why": why}


def _of_those_who_ask(replies: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return what came of an answer to all robots: it is for those that ask, if there are any."""
    return [reply for reply in replies if reply["confirmed"]] or replies


def main(arguments: Sequence[str] | None = None) -> int:
    """Give the order on the command line; return 0 if every robot has confirmed it."""
    bear_all_characters()
    given = _parser().parse_args(arguments)
    if (given.order == ANSWER) != bool(given.question):
        _parser().error(
            "answer: needs --question NAME and --says yes or no; no other command takes --question"
        )
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
        prog="python -m mmrs_runtime.control",
        description=f"Send a command to running robots. {orders}.",
        epilog="Exit codes: 0 every robot has confirmed, 1 one has not, 2 usage error, 5 no running robots.",
    )
    add = parser.add_argument
    add("order", choices=tuple(ORDERS), help="command")
    add("robots", nargs="*", metavar="ROBOT", help="robots to command. Default: all running robots")
    add(
        "--log",
        type=Path,
        default=Path("logs"),
        metavar="DIR",
        help="folder of the run's logs. Default: logs",
    )
    add("--question", metavar="NAME", help="with answer: the question")
    add("--says", choices=tuple(WORDS), default="no", help="with answer: the answer. Default: no")
    add(
        "--seconds",
        type=float,
        default=USUAL_SECONDS,
        metavar="SECONDS",
        help=f"seconds to wait for confirmation, at most 30. Default: {USUAL_SECONDS:g}",
    )
    return parser


def _read(path: Path) -> Iterator[Channel]:
    try:
        facts = object_in(path.read_bytes())
        here = network()
        elsewhere = "" if facts.get("network", here) == here else str(facts["machine"])
        port = int(facts["port"])
        if not 0 < port <= LARGEST_PORT:
            return
        yield Channel(port, str(facts["token"]), tuple(map(str, facts["robots"])), elsewhere)
    except (OSError, ValueError, KeyError, TypeError, OverflowError):
        # It is being written, or taken away, right now; what was meant to be there will be in a moment.
        return
