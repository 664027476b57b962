"""Interrupts of a process that stop its robots."""

import signal
import threading
from collections import deque

import pytest

from mmrs_runtime.orders.orders import Orders, stopping

pytestmark = pytest.mark.real_time("parts of flights")


def test_the_first_interrupt_stops_all_robots_and_the_second_ends_the_waiting():
    orders, said = Orders(), []
    before = signal.getsignal(signal.SIGTERM)
    with stopping(orders, ("a", "b"), said.append):
        signal.raise_signal(signal.SIGTERM)
        (order,) = orders.taken()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert (order.kind, order.robots, order.interrupt) == ("stop", ("a", "b"), True)
    assert len(said) == 1
    assert signal.getsignal(signal.SIGTERM) is before


def test_outside_the_main_thread_signals_are_left_alone():
    errors = []

    def work():
        try:
            with stopping(Orders(), ("a",), print):
                pass
        except ValueError as error:
            errors.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert errors == []


def test_an_order_that_is_given_while_the_run_ends_is_refused():
    orders = Orders()
    closing = threading.Thread(target=orders.close, args=("the run has ended",))

    class Meanwhile(deque):
        """Lets the run end right before an order is put in."""

        def append(self, order):
            closing.start()
            closing.join()
            super().append(order)

    orders._waiting = Meanwhile()
    assert orders.give("hold", ["a"]).refused == {"a": "the run has ended"}
