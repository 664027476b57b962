"""What is written in formats is read again: shapes to a centimetre, and all that is said of them."""

from __future__ import annotations

import warnings
from contextlib import suppress
from itertools import product

import pytest
from counts import many
from drawn_features import assert_same, drawings
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_core.drawings import geojson, gpx, gpx_writer, kml, kml_writer
from mmrs_core.drawings.drawing import Drawing, Geometry, MapFeature
from mmrs_core.errors import UnreadableError

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


@pytest.mark.parametrize(("first", "second"), [*product(WRITERS, repeat=2)])
@settings(max_examples=many(400))
@given(drawing=drawings(), title=st.text(max_size=10))
def test_a_round_trip_keeps_shapes_and_all_that_is_said_of_them(first, second, drawing, title):
    drawing = Drawing(tuple(sorted(drawing.features, key=_place_in_gpx)))
    again = drawing
    for format in (first, second):
        write, read = WRITERS[format]
        again = read(write(again, title), f"farm.{format}")
        assert_same(drawing, again)


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
