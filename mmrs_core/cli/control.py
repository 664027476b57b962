"""``mmrs control``: orders to robots that are running."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from mmrs_core.cli.completion import one_of, running_robots
from mmrs_core.cli.output import say, say_json, say_lines
from mmrs_core.cli.settings import Json
from mmrs_core.errors import LinkLostError
from mmrs_runtime.orders.channels import Unreachable
from mmrs_runtime.orders.ordering import give, words
from mmrs_runtime.orders.orders import ANSWER, ORDERS, STATUS
from mmrs_runtime.orders.status_table import lines_of


def control(
    order: Annotated[
        str,
        typer.Argument(
            metavar="COMMAND",
            help="Command: hold, resume, return, land, stop, answer, battery-changed or status.",
            autocompletion=one_of(*ORDERS),
        ),
    ],
    robots: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="ROBOT...",
            help="Robots to command. Default: all running robots.",
            autocompletion=running_robots,
        ),
    ] = None,
    log: Annotated[Path, typer.Option("--log", metavar="DIR", help="Folder of the run's logs.")] = Path(
        "logs"
    ),
    question: Annotated[
        str,
        typer.Option(
            "--question", metavar="NAME", help="With answer: the question, NAME of the condition answer:NAME."
        ),
    ] = "",
    says: Annotated[
        str,
        typer.Option(
            "--says",
            metavar="yes|no",
            help="With answer: the reply to the question.",
            autocompletion=one_of("yes", "no"),
        ),
    ] = "",
    seconds: Annotated[
        float,
        typer.Option(
            "--seconds", metavar="SECONDS", min=0.1, max=30.0, help="Seconds to wait for confirmation."
        ),
    ] = 10.0,
    json: Json = False,
) -> int:
    """Send a command to running robots.

    Prints which robots have confirmed it. hold: stop moving and wait. resume: continue after a hold or a
    battery change. return: abort the program, retrace the path and return home. land: abort the program and
    land. stop: abort the program with the --on-stop response of 'mmrs run'. answer: answer the question of a
    Choice. battery-changed: confirm that a full battery is in, where the vehicle does not report it; after a
    low battery, then resume. status: print the state of each robot.

    Examples: mmrs control hold Drone1 --log logs;
    mmrs control answer --question clear --says yes
    """
    _check(order, question, says)
    replies = []
    try:
        for reply in _replies(log, order, robots or [], question, says == "yes", seconds):
            replies.append(reply)
            if not json and order != STATUS:
                say(words(reply))
    except (Unreachable, OSError) as error:
        raise LinkLostError(str(error)) from error
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
    if json:
        say_json({"order": order, "robots": replies})
    elif order == STATUS:
        say_lines(lines_of(replies))
    return 0 if all(reply.get("confirmed", True) for reply in replies) else 1


def _replies(
    log: Path, order: str, robots: list[str], question: str, answer: bool, seconds: float
) -> Iterator[dict[str, Any]]:
    return give(log, order, robots, question=question, answer=answer, seconds=seconds)


def _check(order: str, question: str, says: str) -> None:
    if order not in ORDERS:
        raise typer.BadParameter(f"{order}: unknown command; expected one of {', '.join(ORDERS)}")
    if order == ANSWER and (not question or says not in ("yes", "no")):
        raise typer.BadParameter("answer: needs --question QUESTION and --says yes or --says no")
    if order != ANSWER and (question or says):
        raise typer.BadParameter(f"{order}: --question and --says are for the command answer")
