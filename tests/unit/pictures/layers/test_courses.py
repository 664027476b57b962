"""Paths and tracks become lines with times, and what robots did or met points."""

from collections import Counter

import numpy as np
import pytest
from flights_by_hand import flight_as, track_of

from mmrs_core.drawings.drawing import Geometry, HeightReference, MapFeature, Role
from mmrs_core.pictures.layers.chart import chart_of
from mmrs_core.pictures.layers.courses import Courses, flight_as_planned
from mmrs_core.pictures.layers.layer import Layer
from mmrs_core.scene import Frame
from mmrs_runtime.records.entries import Entry

FRAME = Frame("EPSG:4326", 42.37, 13.35, 100.0, "MSL")


@pytest.fixture
def courses(behaviour, types, contributions):
    return Courses(chart_of(FRAME, (HeightReference.SEA_LEVEL,)), behaviour, types, contributions)


def test_each_planned_path_is_one_line_from_home_to_home(courses, behaviour, run):
    paths = list(courses.lines(flight_as_planned(behaviour, run), Layer.PATHS))
    assert [(path.name, path.role, path.geometry) for path in paths] == [
        (name, Role.PATH, Geometry.LINE) for name in ("alpha", "beta")
    ]
    for path, (robot, samples) in zip(paths, run.tracks.items(), strict=True):
        assert path.properties["robot"] == robot
        assert path.times == pytest.approx([sample.time for sample in samples], abs=0.001)
        assert path.heights[0] == pytest.approx([sample.up + 100.0 for sample in samples], abs=0.001)
        assert path.rings[0][0] == pytest.approx(path.rings[0][-1], abs=1e-8)


def test_every_photo_and_other_action_of_the_plan_is_where_and_when_it_is_done(courses, behaviour, run):
    points = list(courses.points(flight_as_planned(behaviour, run)))
    photos = [point for point in points if point.folders[0] in (Layer.PHOTOS, Layer.ACTIONS)]
    taken = [record for record in run.records if record.label == "act"]
    assert Counter(photo.properties["robot"] for photo in photos) == Counter(each.robot for each in taken)
    assert sorted(photo.properties["seconds"] for photo in photos) == pytest.approx(
        sorted(r.time for r in taken), abs=0.001
    )
    assert {photo.heights[0][0] for photo in photos if photo.properties["robot"] == "alpha"} == {120.0}
    assert sorted((photo.name, photo.folders[0]) for photo in photos) == [
        ("alpha 1", "photos"),
        ("arrived", "actions"),
    ]
    assert photos[0].properties["device"] == "camera"


def test_whoever_waits_is_shown_where_that_is(courses, behaviour, run):
    (wait,) = (
        point
        for point in courses.points(flight_as_planned(behaviour, run))
        if point.folders[0] == Layer.WAITS
    )
    assert (wait.name, wait.properties["for"]) == ("beta waits for alpha", "alpha")
    assert wait.properties["wait"] > 1.0


def test_a_track_is_cut_at_gaps_and_a_lone_fix_is_a_point(courses, run, behaviour):
    rows = [(0.0, 0.0, 0.0, 5.0), (1.0, 3.0, 0.0, 5.0), (60.0, 9.0, 0.0, 5.0), (90.0, 0.0, 0.0, 5.0)]
    flight = flight_as(
        run, behaviour, alpha={"track": track_of(rows, broken=[1, 2])}, beta={"track": track_of([])}
    )
    *pieces, (layer, lost) = courses.lines(flight, Layer.TRACKS)
    assert [(piece.geometry, piece.times.tolist()) for piece in pieces] == [
        (Geometry.LINE, [0.0, 1.0]),
        (Geometry.POINT, [60.0]),
        (Geometry.POINT, [90.0]),
    ]
    assert (layer, str(lost.what)) == (Layer.TRACKS, "track of 'beta'")


def test_a_robot_that_stays_has_no_path(courses, run, behaviour):
    still = track_of([(0.0, 1.0, 1.0, 0.0), (9.0, 1.0, 1.0, 0.0)])
    (_, lost), path = courses.lines(flight_as(run, behaviour, alpha={"track": still}), Layer.PATHS)
    assert (lost.reason, path.name) == ("stays where it is", "beta")


def test_events_and_measurements_are_where_the_robot_was_and_else_missed(courses, run, behaviour):
    entries = (
        Entry(
            "r", "alpha", 10.0, "", "decision", {"what": "LINK_LOST", "why": "silent", "response": "RETURN"}
        ),
        Entry("r", "alpha", 12.0, "", "measured", {"name": "co2", "content": {"ppm": 417.5}}),
        Entry("r", "alpha", 1e6, "", "decision", {"what": "PEER_LOST", "why": "", "response": "HOLD"}),
    )
    drawn = list(courses.points(flight_as(run, behaviour, alpha={"entries": entries})))
    event, measured = (
        next(each for each in drawn if isinstance(each, MapFeature) and each.folders[0] == layer)
        for layer in (Layer.EVENTS, Layer.MEASUREMENTS)
    )
    assert (event.name, event.properties["why"]) == ("LINK_LOST", "silent; response: RETURN")
    assert (measured.name, measured.properties["content"]) == ("co2", "ppm 417.5")
    at = run.tracks["alpha"]
    assert measured.heights[0][0] - 100.0 == pytest.approx(
        np.interp(12.0, [s.time for s in at], [s.up for s in at]), abs=0.001
    )
    (lost,) = (each[1] for each in drawn if not isinstance(each, MapFeature))
    assert lost.what.startswith("event 'PEER_LOST' of 'alpha'")
