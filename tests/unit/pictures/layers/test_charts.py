"""Positions in metres become degrees, heights above what is known, and times of day."""

import numpy as np
import pytest
from pyproj import Geod

from mmrs_core.drawings.drawing import HeightReference, LeftOut
from mmrs_core.pictures.layers.chart import chart_of, drawing_of, lacking_for
from mmrs_core.pictures.layers.layer import Layer
from mmrs_core.scene import Frame

HOME, SEA, ELLIPSOID = HeightReference.HOME, HeightReference.SEA_LEVEL, HeightReference.ELLIPSOID
ALTITUDE = "the altitude of its origin above mean sea level or the ellipsoid"
BOTH = Frame("EPSG:4326", 42.37, 13.35, 770.0, "ELLIPSOID", 47.5)


@pytest.mark.parametrize(
    ("frame", "wanted", "reference", "height", "lacking"),
    [
        (BOTH, (ELLIPSOID,), ELLIPSOID, 765.0, ""),
        (BOTH, (SEA, ELLIPSOID), SEA, 717.5, ""),
        (Frame("EPSG:4326", 42.37, 13.35, 770.0), (SEA, ELLIPSOID), ELLIPSOID, 765.0, ""),
        (Frame("EPSG:4326", 42.37, 13.35, 770.0), (SEA,), HOME, -5.0, "its geoidSeparation"),
        (Frame("EPSG:4326", 42.37, 13.35, 0.0, "ORIGIN"), (SEA, ELLIPSOID), HOME, -5.0, ALTITUDE),
        (Frame("EPSG:4326", 42.37, 13.35), (SEA,), HOME, -5.0, ALTITUDE),
        (BOTH, (), HOME, -5.0, ""),
    ],
)
def test_heights_are_above_the_first_reference_that_is_known(frame, wanted, reference, height, lacking):
    point = chart_of(frame, wanted).point((0.0, 0.0, -5.0))
    assert (point.reference, point.heights[0].tolist()) == (reference, [height])
    assert lacking_for(frame, wanted) == lacking


def test_what_has_no_height_gets_none():
    point = chart_of(BOTH, (SEA,)).point((0.0, 0.0))
    assert (point.reference, point.heights) == (HeightReference.NONE, ())


def test_positions_are_as_far_from_the_origin_as_in_the_frame():
    points = [(300.0, -400.0), (0.0, 20.0), (-1.0, 0.0)]
    (ring,) = chart_of(BOTH, ()).area([points]).rings
    distances = [
        Geod(ellps="WGS84").inv(13.35, 42.37, longitude, latitude)[2] for latitude, longitude in ring
    ]
    assert distances == pytest.approx([500.0, 20.0, 1.0], abs=0.001)


def test_times_are_of_day_only_where_the_start_is_known():
    line = [(0.0, 0.0, 1.0), (0.0, 9.0, 1.0)], np.array([0.5, 2.0])
    of_day, alone = chart_of(BOTH, (), 1000.0).line(*line), chart_of(BOTH, ()).line(*line)
    assert (of_day.times.tolist(), of_day.since_start) == ([1000.5, 1002.0], False)
    assert (alone.times.tolist(), alone.since_start) == ([0.5, 2.0], True)


def test_only_the_wanted_layers_are_drawn_and_missed():
    lost = [(layer, LeftOut(layer.value, "has no position")) for layer in (Layer.TASKS, Layer.EVENTS)]
    assert [each.what for each in drawing_of(lost, [Layer.TASKS]).left_out] == ["tasks"]
    assert len(drawing_of(lost).left_out) == 2
