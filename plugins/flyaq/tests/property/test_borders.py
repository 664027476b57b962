"""Every vertex of a border lies in or on the border that is made of it."""

from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st
from mmrs_flyaq.building.borders import border_of
from shapely.geometry import LinearRing, Point, Polygon

ROUNDS = settings(deadline=None, derandomize=True, max_examples=many(20_000))
LEAST = 1e-12
"""Degrees; a tenth of a micrometre, which is what rounding may take."""


@st.composite
def corners(draw):
    """Draw corners that lie anyhow, on one line, nearly on one, or on a few places only."""
    north, east = draw(st.floats(-89.9, 89.9)), draw(st.floats(-179.9, 179.9))
    size = draw(st.sampled_from((0.0, 1e-9, 1e-7, 1e-5, 1e-3, 0.05)))
    count = draw(st.integers(1, 8))
    along = [draw(st.floats(-1, 1)) for _ in range(count)]
    way = draw(st.sampled_from(("anyhow", "line", "nearly", "few")))
    across = [draw(st.floats(-1, 1)) for _ in range(count)]
    slope = draw(st.floats(-1, 1))
    share = {"anyhow": 1.0, "line": 0.0, "nearly": 1e-12, "few": 0.0}[way]
    if way == "few":
        along = [round(value) for value in along]
    return tuple(
        (north + size * one, east + size * (slope * one + share * other))
        for one, other in zip(along, across, strict=True)
    )


@ROUNDS
@given(places=corners(), metres=st.floats(0.1, 100.0))
def test_every_vertex_is_held(places, metres):
    mended = border_of(places, metres)
    ring = Polygon(places if mended is None else mended.corners)
    assert ring.is_valid
    assert LinearRing(ring.exterior.coords).is_simple
    assert ring.area > 0.0
    for place in places:
        assert ring.distance(Point(place)) <= LEAST, (places, mended)
