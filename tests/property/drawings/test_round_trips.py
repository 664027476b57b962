"""What is written in a format is read again: shapes to a centimetre, and all that is said of them."""

from __future__ import annotations

import warnings
from contextlib import suppress

import pytest
from drawn_features import assert_same, drawings
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.drawings import geojson, kml
from mmrs_core.errors import UnreadableError

WRITERS = {
    "geojson": (geojson.write, geojson.read),
    "kml": (kml.write, kml.read),
    "kmz": (kml.write_archive, kml.read),
}


@pytest.mark.parametrize("format", WRITERS)
@given(drawing=drawings(), title=st.text(max_size=10))
def test_a_round_trip_keeps_shapes_and_all_that_is_said_of_them(format, drawing, title):
    write, read = WRITERS[format]
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
