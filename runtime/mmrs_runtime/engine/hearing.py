"""Connects a run to orders from other processes; see `mmrs_runtime.control`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from ..control import Control
from ..orders.orders import Inbox, Receipt
from .orders import Orders

Status = Callable[[str], Mapping[str, object]]


@contextmanager
def hear_orders(
    folder: Path, run: str, robots: Sequence[str], orders: Orders, status: Status
) -> Iterator[None]:
    """Listen for orders as long as the context lasts.

    Raises:
        Taken: if another process runs one of these robots with its logs in that folder.
        OSError: if no port can be opened there.
    """
    inboxes = {robot: _inbox(robot, orders) for robot in robots}
    control = Control(folder, run, inboxes, status)
    try:
        yield
    finally:
        for inbox in inboxes.values():
            inbox.close("the run has ended")
        control.close()


def _inbox(robot: str, orders: Orders) -> Inbox:
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
