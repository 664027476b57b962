"""``mmrs control``: orders to robots that are running."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.settings import Json

if TYPE_CHECKING:
    from collections.abc import Iterator


def control(
    order: Annotated[
        str,
        typer.Argument(metavar="ORDER", help="hold, resume, return, land, stop, answer or status."),
    ],
    robots: Annotated[
        list[str] | None, typer.Argument(metavar="ROBOT...", help="None: all robots that are running.")
    ] = None,
    log: Annotated[Path, typer.Option("--log", metavar="DIR", help="Folder of their logs.")] = Path("logs"),
    question: Annotated[str, typer.Option("--question", help="Of answer: what is answered.")] = "",
    says: Annotated[str, typer.Option("--says", metavar="yes|no", help="Of answer: the answer.")] = "",
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=30.0, help="To wait for the robots.")
    ] = 10.0,
    json: Json = False,
) -> int:
    """Give an order to robots that are running.

    It tells which of them have obeyed. hold: halt and stay until the next order. resume: go on after a hold,
    or after a change of batteries. return: end the program and come home by the way it came. land: end the
    program and come down. stop: end the program as the robots were started to do. answer: answer a question
    that a choice asks.

    Example: mmrs control hold Drone1 --log logs
    """
    from mmrs_core.errors import LinkLostError
    from mmrs_runtime.orders.calling import Unreachable
    from mmrs_runtime.orders.ordering import words
    from mmrs_runtime.orders.orders import STATUS
    from mmrs_runtime.orders.standing import lines_of

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
        for line in lines_of(replies):
            say(line)
    return 0 if all(reply.get("confirmed", True) for reply in replies) else 1


def _replies(
    log: Path, order: str, robots: list[str], question: str, answer: bool, seconds: float
) -> Iterator[dict[str, Any]]:
    from mmrs_runtime.orders.ordering import give

    return give(log, order, robots, question=question, answer=answer, seconds=seconds)


def _check(order: str, question: str, says: str) -> None:
    from mmrs_runtime.orders.orders import ANSWER, ORDERS

    if order not in ORDERS:
        raise typer.BadParameter(f"{order}: is none of {', '.join(ORDERS)}")
    if order == ANSWER and (not question or says not in ("yes", "no")):
        raise typer.BadParameter("answer: needs --question QUESTION and --says yes or --says no")
    if order != ANSWER and (question or says):
        raise typer.BadParameter(f"{order}: --question and --says go with answer only")
