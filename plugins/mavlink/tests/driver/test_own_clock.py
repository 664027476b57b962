"""A vehicle whose clock does not keep time with the run's, as in simulations that are sped up."""

import json
from contextlib import closing
from types import SimpleNamespace

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.own_clock import OwnClock
from mmrs_runtime.clock import Clock
from mmrs_runtime.records.blackbox import BlackBox, black_box_path

FIVE_TIMES = (
    "the vehicle's clock runs 5 times as fast as the run's (warning: durations, time-outs and the times in"
    " the log do not fit it: a simulation needs --speedup 5)"
)


class GivenClock(Clock):
    """A clock of a run that shows what it is set to."""

    time = 0.0

    def now(self) -> float:
        return self.time


@pytest.fixture
def watched(tmp_path):
    """Return what takes pairs of the vehicle's and the run's seconds; it returns what is said and written."""

    def watch(shown, speedup: float = 1.0, system: int = 1):
        path, said = black_box_path(tmp_path / "alpha.jsonl"), []
        clock = GivenClock(speedup)
        with closing(BlackBox(path, "run-0", "alpha", clock.now)) as box:
            own = OwnClock(SimpleNamespace(system=1, component=1), clock, said.append, box)
            for seconds, clock.time in shown:
                message = mavlink.MAVLink_system_time_message(0, round(1000.0 * seconds))
                message._header.srcSystem, message._header.srcComponent = system, 1
                own(message, False)
        lines = path.read_text("ascii").splitlines() if path.exists() else []
        return said, [(line["kind"], line["rate"]) for line in map(json.loads, lines)]

    return watch


def steady(rate: float, seconds: int, begin: float = 0.0, since: float = 100.0):
    """Yield what a clock shows five times a second."""
    for tick in range(5 * seconds):
        yield since + rate * tick / 5.0, begin + tick / 5.0


def test_a_clock_that_runs_faster_is_told_once_with_its_rate_and_written(watched):
    assert watched(steady(5.0, 60)) == ([FIVE_TIMES], [("clock", 5.0)])


def test_nothing_is_told_within_the_first_ten_seconds(watched):
    assert watched(steady(5.0, 10)) == ([], [])


@pytest.mark.parametrize(
    ("rate", "speedup", "needed"), [(0.2, 5.0, "1"), (0.5, 10.0, "5"), (1.2, 1.0, "1.2"), (0.8, 1.0, "0.8")]
)
def test_the_speed_up_that_fits_is_named(rate, speedup, needed, watched):
    (said,), ((_, measured),) = watched(steady(rate, 300), speedup)
    assert said.endswith(f"a simulation needs --speedup {needed})")
    assert measured == pytest.approx(rate, abs=0.01)


@pytest.mark.parametrize("rate", [1.0, 0.95, 1.05])
def test_a_clock_that_is_off_by_less_than_a_tenth_keeps_time(rate, watched):
    assert watched(steady(rate, 600)) == ([], [])


def test_messages_that_are_late_are_no_other_rate(watched):
    late = ((own, now + 4.9 * (tick % 7 == 0)) for tick, (own, now) in enumerate(steady(1.0, 120)))
    growing = ((own, now + min(4.9, 0.4 * now)) for own, now in steady(1.0, 120))
    for shown in (sorted(late, key=lambda each: each[1]), growing):
        assert watched(shown) == ([], [])


def test_a_vehicle_that_stood_still_or_started_anew_keeps_time_from_then_on(watched):
    stood = [*steady(1.0, 30), *steady(1.0, 60, begin=70.0, since=130.0)]
    anew = [*steady(1.0, 30), *steady(1.0, 60, begin=30.2, since=0.0)]
    assert watched(stood) == watched(anew) == ([], [])


def test_clocks_of_other_systems_do_not_count(watched):
    assert watched(steady(5.0, 60), system=2) == ([], [])
