"""Drawings as map programs make them, at random, and how far two of them are apart."""

import numpy as np
from hypothesis import strategies as st

from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature, Role, printable

CENTIMETRE = 0.01
METRES_PER_DEGREE = 111_320.0
TEXTS = st.text(max_size=12).map(printable)
NAMES = TEXTS.filter(bool)


@st.composite
def rings(draw, least: int, most: int = 6):
    """Draw a ring of different positions anywhere but at the poles, maybe over the antimeridian."""
    middle = np.array([draw(st.floats(-80, 80)), draw(st.floats(-180, 180))])
    offsets = st.tuples(st.integers(-5000, 5000), st.integers(-5000, 5000))
    corners = draw(st.lists(offsets, min_size=least, max_size=most, unique=True))
    ring = middle + np.array(corners) * 1e-5
    ring[:, 1] = (ring[:, 1] + 180.0) % 360.0 - 180.0
    return ring


@st.composite
def features(draw, geometries=tuple(Geometry), references=tuple(HeightReference)):
    geometry = draw(st.sampled_from(geometries))
    least = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}[geometry]
    shape = [draw(rings(least, 1 if least == 1 else 6))]
    if geometry is Geometry.AREA:
        shape += draw(st.lists(rings(3), max_size=2))
    reference = draw(st.sampled_from(references))
    high = reference is not HeightReference.NONE
    metres = st.floats(-200, 9000)
    seconds = st.integers(0, 4 * 10**9).map(lambda tenths: tenths / 10)
    times = draw(st.none() | st.just(True)) if geometry is not Geometry.AREA else None
    return MapFeature(
        geometry,
        tuple(shape),
        tuple(np.array([draw(metres) for _ in ring]) for ring in shape) if high else (),
        reference,
        times=None if times is None else np.array([draw(seconds) for _ in shape[0]]),
        since_start=times is not None and draw(st.booleans()),
        radius=draw(st.none() | st.integers(1, 1000)) if geometry is Geometry.POINT else None,
        name=draw(TEXTS),
        description=draw(st.text(max_size=20)),
        role=draw(st.sampled_from([role for role in Role if role or times is None])),
        folders=tuple(draw(st.lists(NAMES, max_size=3))),
        properties=draw(
            st.dictionaries(
                NAMES.map(lambda key: f"_{key}"), TEXTS | st.integers() | st.booleans(), max_size=3
            )
        ),
        colour=draw(st.sampled_from(("", "#0a1bff"))),
    )


def drawings(**limits):
    return st.lists(features(**limits), max_size=5).map(lambda each: Drawing(tuple(each)))


def metres_apart(one: np.ndarray, other: np.ndarray) -> float:
    """Return how far two rings are apart at most, wherever they begin and whichever way they turn."""
    assert one.shape == other.shape
    turns = [np.roll(ring, n, axis=0) for ring in (other, other[::-1]) for n in range(len(other))]
    return min(_largest(one, turn) for turn in turns)


def _largest(one: np.ndarray, other: np.ndarray) -> float:
    difference = one - other
    difference[:, 1] = (difference[:, 1] + 180.0) % 360.0 - 180.0
    return float(np.abs(difference).max()) * METRES_PER_DEGREE


def assert_same(drawing: Drawing, again: Drawing) -> None:
    """Fail where two drawings differ by more than the digits and the direction of rings."""
    assert not again.left_out
    assert len(again.features) == len(drawing.features)
    for one, other in zip(drawing.features, again.features, strict=True):
        assert other.geometry is one.geometry
        assert len(other.rings) == len(one.rings)
        assert all(metres_apart(a, b) < CENTIMETRE for a, b in zip(one.rings, other.rings, strict=True))
        assert other.reference is one.reference
        for a, b in zip(one.heights, other.heights, strict=True):
            assert np.allclose(np.sort(a), np.sort(b), atol=0.001)
        assert (other.times is None) is (one.times is None)
        assert one.times is None or np.allclose(one.times, other.times, atol=0.001)
        for said in ("name", "role", "folders", "description", "since_start", "radius", "colour"):
            assert getattr(other, said) == getattr(one, said), said
        texts = [{key: str(value).lower() for key, value in each.properties.items()} for each in (one, other)]
        assert texts[0] == texts[1]
