"""Has a run hear the orders of ``mmrs control``."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from mmrs_runtime.engine.orders import Orders

if TYPE_CHECKING:
    from mmrs_runtime.orders.orders import Inbox, Receipt

Status = Callable[[str], Mapping[str, object]]


@contextmanager
def hear_orders(
    folder: Path, run: str, robots: Sequence[str], orders: Orders, status: Status
) -> Iterator[None]:
    """Listen for orders as long as the context lasts.

    Raises:
        typer.BadParameter: if another process runs one of these robots with its logs in that folder.
    """
    from mmrs_runtime.control import Control, Taken

    inboxes = {robot: _inbox(robot, orders) for robot in robots}
    try:
        control = Control(folder, run, inboxes, status)
    except Taken as error:
        raise typer.BadParameter(f"--log {folder}: {error}") from error
    try:
        yield
    finally:
        for inbox in inboxes.values():
            inbox.close("the run has ended")
        control.close()


def _inbox(robot: str, orders: Orders) -> Inbox:
    from mmrs_runtime.orders.orders import Inbox

    def arrived() -> None:
        while (receipt := inbox.take()) is not None:
            _pass_on(receipt)

    def _pass_on(receipt: Receipt) -> None:
        def answered(robot: str, why: str | None) -> None:
            if why is None:
                receipt.confirm()
            else:
                receipt.refuse(why)

        order = receipt.order
        orders.give(order.name, (robot,), question=order.question, answer=order.answer, told=answered)

    inbox = Inbox(robot, arrived=arrived)
    return inbox
