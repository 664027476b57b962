"""How robots are, as people read it."""

import pytest

from mmrs_runtime.engine.status import WAITS, WORKS
from mmrs_runtime.orders.status_table import lines_of

PLACE = {"latitude": 42.3503916, "longitude": 13.3908992, "height": 35.02}
FLIES = {"robot": "Kestrel", "phase": WORKS, "mode": "guided", "armed": True, "speed": 3.31, "place": PLACE}
STANDS = {"robot": "Bo", "phase": WORKS, "mode": "hold", "armed": False, "speed": 0.0}
NEAR = {"north": -2.04, "east": 11.5, "height": 0.0}


def test_several_robots_stand_in_columns():
    flies = {**FLIES, "energy": 0.934, "move": "m18", "step": "begin", "time": 605.569903}
    stands = {**STANDS, "energy": None, "move": "start", "step": "end", "time": 3.97, "place": NEAR}
    assert list(lines_of([flies, stands])) == [
        "'Kestrel'  works  'm18' since 10:06     guided, armed   battery 93%      "
        "42.350392, 13.390899, 35.0 m up      3.3 m/s",
        "'Bo'       works  'start' done at 0:04  hold, disarmed  battery unknown  "
        "-2.0 m north, 11.5 m east, 0.0 m up  0.0 m/s",
    ]


def test_a_robot_whose_vehicle_was_not_heard_says_so_and_nothing_else():
    assert list(lines_of([{"robot": "a", "phase": WAITS}])) == ["'a'  waits for its vehicle"]


@pytest.mark.parametrize(
    ("more", "line"),
    [
        ({"asks": "gas?"}, "  asks 'gas?': order 'answer' with --question 'gas?' and --says yes or no"),
        (
            {"reported": {"name": "seen", "content": {"what": "a goat", "legs": "4"}}},
            "  has reported 'seen': what a goat, legs 4",
        ),
        ({"reported": {"name": "", "content": {"what": "a goat"}}}, "  has reported: what a goat"),
        ({"reported": {"name": "seen", "content": {}}}, "  has reported 'seen'"),
    ],
)
def test_what_a_robot_asks_or_has_reported_stands_below_it(more, line):
    assert list(lines_of([{**STANDS, **more}, FLIES]))[1] == line


@pytest.mark.parametrize(
    ("step", "time", "words"),
    [("act", 65.2, "at 'm', act 1:05"), ("end", 3725.0, "'m' done at 1:02:05"), (None, 0.0, "at 'm'")],
)
def test_what_a_robot_did_last_is_told_by_the_runs_clock(step, time, words):
    made = {} if step is None else {"step": step, "time": time}
    (line,) = lines_of([{"robot": "a", "phase": WORKS, "move": "m", **made}])
    assert line == f"'a'  works  {words}"
