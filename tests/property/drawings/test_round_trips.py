"""What is written in formats is read again: shapes to a centimetre, and all that is said of them."""

import csv
import io
import warnings
from contextlib import suppress
from itertools import pairwise, product

import pytest
from counts import many
from drawn_features import assert_same, drawings
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_core.drawings import geojson, gpx, gpx_writer, kml, kml_writer, point_table
from mmrs_core.drawings.drawing import Drawing, Geometry, MapFeature
from mmrs_core.errors import UnreadableError

WRITERS = {
    "gpx": (gpx_writer.write, gpx.read),
    "geojson": (geojson.write, geojson.read),
    "kml": (kml_writer.write, kml.read),
    "kmz": (kml_writer.write_archive, kml.read),
}
PAIRS = [*product(WRITERS, repeat=2)]
FAST = [*pairwise([*WRITERS, "gpx"])]
"""Each format once before another and once after one."""


def _place_in_gpx(feature: MapFeature) -> int:
    """Return whether waypoints, routes or tracks hold it, which GPX writes in this order."""
    if feature.geometry is Geometry.LINE:
        return 1 if feature.times is None else 2
    return 0 if feature.geometry is Geometry.POINT else 2


@pytest.mark.parametrize(
    ("first", "second"),
    [pytest.param(*pair, marks=() if pair in FAST else pytest.mark.thorough) for pair in PAIRS],
)
@settings(max_examples=many(400, fast=15))
@given(drawing=drawings(), title=st.text(max_size=10))
def test_a_round_trip_keeps_shapes_and_all_that_is_said_of_them(first, second, drawing, title):
    drawing = Drawing(tuple(sorted(drawing.features, key=_place_in_gpx)))
    again = drawing
    for format in (first, second):
        write, read = WRITERS[format]
        again = read(write(again, title), f"farm.{format}")
        assert_same(drawing, again)


CELLS = st.sampled_from(
    (
        "47.1",
        "8,2",
        "42°21'03\"N",
        "N 42 21.05",
        "-",
        "'",
        '"',
        "nan",
        "9" * 400,
        "",
        " ",
        "lat",
        "x;y",
        "\n",
        "\0",
    )
)


@given(rows=st.lists(st.lists(CELLS, min_size=1, max_size=6), max_size=8), mark=st.sampled_from(",;\t"))
def test_every_row_of_a_table_is_a_feature_or_left_out_or_the_table_is_refused(rows, mark):
    text = "\n".join((mark.join(("name", "lat", "lon", "note")), *(mark.join(row) for row in rows)))
    with suppress(UnreadableError):
        drawing = point_table.read(text.encode(), "a.csv")
        written = sum(any(map(str.strip, row)) for row in csv.reader(io.StringIO(text), delimiter=mark)) - 1
        assert len(drawing.features) + len(drawing.left_out) == written


@given(data=st.binary(max_size=60), header=st.sampled_from((b"lat,lon\n", b"area;y;x\n", b"\xff\xfe", b"")))
def test_of_any_bytes_a_table_comes_or_a_clear_error(data, header):
    with suppress(UnreadableError):
        point_table.read(header + data, "a.csv")


@pytest.mark.parametrize("format", WRITERS)
@settings(max_examples=many(2000, fast=15))
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
