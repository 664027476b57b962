"""Sources of orders: other processes, by `mmrs_runtime.control`, and interrupts of this one."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from ..control import Control
from ..orders.orders import Inbox, Receipt
from .orders import STOP, Orders

Status = Callable[[str], Mapping[str, object]]


@contextmanager
def receive_orders(
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
        orders.give(order.name, (robot,), question=order.question, answer=order.answer, answered=answered)

    inbox = Inbox(robot, arrived=arrived)
    return inbox


@contextmanager
def stopping(orders: Orders, robots: tuple[str, ...], say: Callable[[str], None]) -> Iterator[None]:
    """Stop the robots on the first interrupt; the second one ends the wait for them.

    A terminal that closes gives no order: robots continue. Outside the main thread, which alone receives
    signals, nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    seen: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        seen.append(number)
        if len(seen) > 1:
            raise KeyboardInterrupt
        orders.give(STOP, robots, interrupt=True)
        say("stopping; interrupt again to end without waiting for robots, and those that pilots have")

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    if hasattr(signal, "SIGHUP"):
        before[signal.SIGHUP] = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
