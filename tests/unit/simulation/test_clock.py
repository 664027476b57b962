import threading
import time
from math import inf

import pytest
from signals_elsewhere import signalled
from stalls import Stalls

from mmrs_runtime.engine.clocks import RealClock, SimulatedClock

pytestmark = pytest.mark.real_time("parts of flights")


def test_simulated_time_jumps_and_never_goes_back():
    clock = SimulatedClock()
    clock.sleep_until(1e6)
    clock.sleep_until(3.0)
    assert clock.now() == 1e6


def test_real_time_goes_on_from_where_a_run_was_broken_off():
    clock = RealClock(start=50.0)
    assert 50.0 <= clock.now() < 51.0


def test_a_sleep_lasts_until_its_time_has_come():
    clock = RealClock(speedup=100.0)
    clock.sleep_until(5.0)
    assert clock.now() >= 5.0


def test_a_sleeper_is_woken_at_once():
    clock = RealClock()
    threading.Timer(0.05, clock.wake).start()
    begun = time.monotonic()
    clock.sleep_until(inf)
    assert time.monotonic() - begun < 5.0


def test_a_signal_that_does_not_end_a_sleep_is_heeded_soon():
    clock, heeded = RealClock(), []
    stalls, begun = Stalls(), time.monotonic()

    def heed():
        heeded.append(time.monotonic())
        clock.wake()

    with signalled(heed, clock.wake):
        clock.sleep_until(inf)
    assert heeded[0] - begun < 3.0 + stalls.seconds


def test_a_wake_before_the_sleep_is_not_lost():
    clock = RealClock()
    clock.wake()
    clock.sleep_until(inf)


def test_many_wakes_end_one_sleep_only():
    clock = RealClock(speedup=100.0)
    for _ in range(5):
        clock.wake()
    clock.sleep_until(inf)
    clock.sleep_until(clock.now() + 5.0)
    assert clock.now() >= 5.0


def test_wall_clocks_do_not_matter(monkeypatch):
    clock = RealClock()
    before = clock.now()
    monkeypatch.setattr(time, "time", lambda: -1e9)
    assert before <= clock.now() < before + 5.0


@pytest.mark.parametrize("speedup", [0.0, -1.0, inf])
def test_time_neither_stands_still_nor_goes_back(speedup):
    with pytest.raises(ValueError, match="positive"):
        RealClock(speedup)
