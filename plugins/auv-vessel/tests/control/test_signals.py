"""A process is told to end, at whatever moment."""

import signal

import pytest

from auv_vessel.node import stopped_by_signals


@pytest.mark.parametrize("sign", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_stops_who_just_then_holds_the_lock_of_what_it_waits_for(sign: signal.Signals) -> None:
    before = {each: signal.getsignal(each) for each in (signal.SIGTERM, signal.SIGINT)}
    try:
        stop = stopped_by_signals()
        with stop._cond:
            signal.raise_signal(sign)
        assert stop.wait(10.0)
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
