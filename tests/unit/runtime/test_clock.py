"""Clocks."""

from __future__ import annotations

import pytest

from mmrs_core.runtime.clock import RealClock, SimulatedClock


def test_simulated_time_jumps_and_never_goes_back():
    clock = SimulatedClock()
    clock.sleep_until(1e6)
    clock.sleep_until(3.0)
    assert clock.now() == 1e6


def test_real_time_is_slept_through_at_its_rate(monkeypatch):
    world = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: world[0])
    slept = []

    def sleep(seconds):
        slept.append(seconds)
        world[0] += seconds

    monkeypatch.setattr("time.sleep", sleep)
    clock = RealClock(rate=10.0)
    clock.sleep_until(5.0)
    assert slept == [0.5]
    assert clock.now() == 5.0


def test_a_time_that_has_passed_is_not_slept_for():
    clock = RealClock()
    clock.sleep_until(-1.0)
    assert clock.now() >= 0.0


def test_a_clock_that_stands_still_is_refused():
    with pytest.raises(ValueError, match="rate 0: not above zero"):
        RealClock(rate=0.0)
