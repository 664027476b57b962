"""The ways that moves should have gone, by what a robot began."""

from dataclasses import replace

import numpy as np
import pytest
from mmrs_multicopter.testing import go_to, robot_program, take_off

from mmrs_core.behaviour.program import MoveTarget
from mmrs_core.pictures.flights.flight import Flown
from mmrs_core.pictures.flights.planned import legs_of
from mmrs_core.pictures.flights.tracks import NOWHERE, Track
from mmrs_runtime.records.steps import StepRecord

UP, EAST, NORTH = take_off("up", 5.0), go_to("east", (10.0, 0.0, 5.0)), go_to("north", (10.0, 20.0, 5.0))


@pytest.fixture
def legs(contributions):
    def made(moves, *begun, track=NOWHERE):
        steps = [
            (time + part, label, id) for time, id in begun for part, label in ((0.0, "begin"), (9.0, "end"))
        ]
        records = tuple(StepRecord("r", "a", i, i, *step) for i, step in enumerate(steps))
        return legs_of(robot_program("a", moves), Flown("a", records, track), contributions.move_kinds)

    return made


def test_each_way_begins_where_the_one_before_should_have_ended(legs):
    found = legs([UP, EAST, NORTH], (0.0, "up"), (10.0, "east"), (20.0, "north"))
    assert [leg.way[0] for leg in found] == [(0.0, 0.0, 0.0), (0.0, 0.0, 5.0), (10.0, 0.0, 5.0)]
    assert [leg.way[-1] for leg in found] == [(0.0, 0.0, 5.0), (10.0, 0.0, 5.0), (10.0, 20.0, 5.0)]
    assert [(leg.begin, leg.end, leg.ended) for leg in found] == [
        (0, 9, True),
        (10, 19, True),
        (20, 29, True),
    ]


def test_a_move_that_was_broken_off_lasts_as_long_as_anything_is_known(legs):
    times = np.array([0.0, 50.0])
    track = Track(times, np.zeros((2, 3)), np.full(2, np.nan), np.zeros(2, dtype=bool))
    records = (StepRecord("r", "a", 0, 0, 10.0, "begin", "up"),)
    (leg,) = legs_of(robot_program("a", [UP]), Flown("a", records, track), {})
    assert (leg.begin, leg.end, leg.ended, leg.way) == (10.0, 50.0, False, ())


def test_after_an_object_a_way_begins_where_the_robot_was(legs):
    search = replace(EAST, target=MoveTarget((10.0, 0.0, 5.0), "red tent", 30.0))
    times, places = np.array([0.0, 20.0]), np.array([[0.0, 0.0, 5.0], [33.0, 7.0, 5.0]])
    track = Track(times, places, np.full(2, np.nan), np.zeros(2, dtype=bool))
    found = legs([UP, search, NORTH], (0.0, "up"), (10.0, "east"), (20.0, "north"), track=track)
    assert found[1].way == ()
    assert found[2].way == ((33.0, 7.0, 5.0), (10.0, 20.0, 5.0))


def test_without_a_place_nobody_knows_the_way_after_an_object(legs):
    search = replace(EAST, target=MoveTarget(None, "red tent", None))
    assert [leg.way for leg in legs([UP, search, NORTH], (10.0, "east"), (20.0, "north"))] == [(), ()]
