"""What is written in a format is read again: shapes to a centimetre, and all that is said of them."""

from __future__ import annotations

import warnings
from contextlib import suppress

import pytest
from drawn_features import assert_same, drawings
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.drawings import geojson, gpx, gpx_writer, kml, kml_writer
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature
from mmrs_core.errors import UnreadableError

OF_GPX = (HeightReference.NONE, HeightReference.SEA_LEVEL)
WRITERS = {
    "gpx": (gpx_writer.write, gpx.read),
    "geojson": (geojson.write, geojson.read),
    "kml": (kml_writer.write, kml.read),
    "kmz": (kml_writer.write_archive, kml.read),
}


def _place_in_gpx(feature: MapFeature) -> int:
    """Return whether waypoints, routes or tracks hold it, which GPX writes in this order."""
    if feature.geometry is Geometry.LINE:
        return 1 if feature.times is None else 2
    return 0 if feature.geometry is Geometry.POINT else 2


@pytest.mark.parametrize("format", WRITERS)
@given(drawing=drawings(), title=st.text(max_size=10))
def test_a_round_trip_keeps_shapes_and_all_that_is_said_of_them(format, drawing, title):
    write, read = WRITERS[format]
    if format == "gpx":
        able = [each for each in drawing.features if each.reference in OF_GPX]
        drawing = Drawing(tuple(sorted(able, key=_place_in_gpx)))
    assert_same(drawing, read(write(drawing, title), f"farm.{format}"))


@pytest.mark.parametrize("format", WRITERS)
@given(drawing=drawings(), data=st.data())
def test_of_a_damaged_file_comes_a_drawing_or_a_clear_error(format, drawing, data):
    write, read = WRITERS[format]
    content = bytearray(write(drawing, "farm"))
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 3))] = data.draw(
            st.binary(max_size=4)
            | st.sampled_from([b"nan", b"1e999", b"null", b"[[", b'"', b"<x>", b"9" * 30])
        )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with suppress(UnreadableError):
            read(bytes(content), f"farm.{format}")
