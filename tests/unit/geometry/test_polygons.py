import pytest

from mmrs_core.geometry.polygons import contains, less, parts, polygon, ring_faults, rings

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))


def test_a_square_is_sound():
    assert ring_faults(SQUARE) == ()


@pytest.mark.parametrize(
    ("ring", "fault"),
    [
        ((), "0 distinct points"),
        (((0, 0), (1, 1)), "2 distinct points"),
        (((0, 0), (1, 1), (0, 0), (1, 1)), "2 distinct points"),
        (((0, 0), (10, 10), (10, 0), (0, 10)), "crosses"),
        (((0, 0), (5, 5), (10, 10)), "no area"),
        (((0, 0), (0, 0), (10, 0), (10, 10)), "repeats point 1"),
        (((0, 0), (10, 0), (10, 10), (0, 0)), "repeats point 0"),
        (((0, 0), (float("nan"), 0), (10, 10)), "finite"),
    ],
)
def test_faults_of_a_ring_are_named(ring, fault):
    assert any(fault in reason for reason in ring_faults(ring))


def test_points_are_inside_or_not():
    assert contains(SQUARE, [[5, 5], [15, 5], [5, -1], [9.99, 9.99]]).tolist() == [True, False, False, True]


def test_what_is_left_comes_largest_first():
    left = less(SQUARE, [polygon(((6.0, -1.0), (7.0, -1.0), (7.0, 11.0), (6.0, 11.0)))])
    assert [round(piece.area) for piece in left] == [60, 30]


def test_small_parts_are_dropped():
    assert parts(polygon(SQUARE), smallest=100.0) == ()


def test_a_polygon_gives_back_its_rings():
    holed = less(SQUARE, [polygon(((4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0)))])[0]
    shell, holes = rings(holed)
    assert len(shell) == 4
    assert [len(hole) for hole in holes] == [4]


def test_an_unsound_ring_makes_no_polygon():
    with pytest.raises(ValueError, match="crosses"):
        polygon(((0, 0), (10, 10), (10, 0), (0, 10)))
