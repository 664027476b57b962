"""The first signal stops robots, the second even the waiting for them, at whatever moment they come."""

from __future__ import annotations

import signal
import threading

from mmrs_mavlink.main import _stop_on_signals

SIGNS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def test_a_second_signal_comes_while_the_first_is_heeded():
    before = {each: signal.getsignal(each) for each in SIGNS}
    stop, abandon = threading.Event(), threading.Event()
    try:
        _stop_on_signals(stop, abandon)
        with stop._cond:
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGTERM)
        assert abandon.wait(10.0)
        assert stop.is_set()
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def test_one_signal_abandons_nothing():
    before = {each: signal.getsignal(each) for each in SIGNS}
    stop, abandon = threading.Event(), threading.Event()
    try:
        _stop_on_signals(stop, abandon)
        signal.raise_signal(signal.SIGTERM)
        assert stop.wait(10.0)
        assert not abandon.wait(0.1)
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
