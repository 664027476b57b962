"""The clock of simulated runs."""

from __future__ import annotations

from mmrs_core.runtime.clock import SimulatedClock


def test_simulated_time_jumps_and_never_goes_back():
    clock = SimulatedClock()
    clock.sleep_until(1e6)
    clock.sleep_until(3.0)
    assert clock.now() == 1e6
