"""Orders on their way to a robot: each is answered, whatever happens at the same moment."""

from __future__ import annotations

import threading
from collections import deque

import pytest

from mmrs_runtime.orders.orders import Inbox, OrderKind

pytestmark = pytest.mark.real_time("parts of flights")


def test_an_order_that_is_given_while_the_inbox_is_being_closed_is_refused():
    inbox = Inbox("alpha")
    closing = threading.Thread(target=inbox.close, args=("its program has ended",))

    class Meanwhile(deque):
        """Lets the robot's thread run right before an order is put in."""

        def append(self, receipt):
            closing.start()
            closing.join(0.1)
            super().append(receipt)

    inbox._waiting = Meanwhile()
    receipt = inbox.give(OrderKind("hold"))
    closing.join()
    assert (receipt.confirmed, receipt.why) == (False, "its program has ended")


def test_an_order_after_the_end_is_refused_and_an_answer_too():
    inbox = Inbox("alpha")
    inbox.close("its program has ended")
    receipts = [inbox.give(OrderKind("hold")), inbox.give(OrderKind("answer", "is it safe", True))]
    assert [receipt.why for receipt in receipts] == ["its program has ended"] * 2
