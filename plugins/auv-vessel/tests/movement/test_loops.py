import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_vessels import heavy_sheet, pool_sheet, torpedo_sheet

from auv_vessel.movement.abilities import abilities_of
from auv_vessel.movement.loops import Aim, Loops, Motion, bearing, rotation, turn

ANGLES, SPEEDS = st.floats(-180.0, 180.0), st.floats(-3.0, 3.0)
SHEETS = st.sampled_from((pool_sheet(), torpedo_sheet(), heavy_sheet()))


@given(
    SHEETS,
    st.tuples(SPEEDS, SPEEDS, st.floats(0.0, 50.0), ANGLES),
    st.tuples(ANGLES, ANGLES, ANGLES, SPEEDS, SPEEDS, SPEEDS),
    st.booleans(),
)
@settings(max_examples=60)
def test_a_wrench_is_never_more_than_thrusters_can_give(
    sheet: object, aim: tuple[float, ...], motion: tuple[float, ...], limited: bool
) -> None:
    can = abilities_of(sheet)
    loops = Loops(can, (True,) * 6)
    loops.limited = limited
    roll, pitch, heading, surge, sway, heave = motion
    now = Motion(roll=roll, pitch=pitch, heading=heading, surge=surge, sway=sway, heave=heave, depth=5.0)
    for _ in range(20):
        wrench = loops.wrench(Aim(*aim), now, 0.05)
    assert np.all(np.isfinite(wrench))
    assert np.all(np.abs(wrench) <= can.most + 1e-9)


def test_what_no_thruster_serves_is_not_asked_for() -> None:
    loops = Loops(abilities_of(torpedo_sheet()), (True, False, True, False, True, True))
    wrench = loops.wrench(Aim(1.0, 1.0, 2.0, 90.0), Motion(roll=5.0), 0.05)
    assert wrench[1] == wrench[3] == 0.0
    assert wrench[0] > 0.0


def test_integrals_wait_while_thrusters_cannot_give_more() -> None:
    loops = Loops(abilities_of(pool_sheet()), (True,) * 6)
    loops.limited = True
    for _ in range(400):
        loops.wrench(Aim(0.2, 0.0, 5.0, 0.0), Motion(depth=5.0), 0.05)
    held = np.abs(loops._push).max()
    loops.limited = False
    for _ in range(400):
        loops.wrench(Aim(0.2, 0.0, 5.0, 0.0), Motion(depth=5.0), 0.05)
    assert np.abs(loops._push).max() > 5.0 * max(held, 0.1)


def test_an_integral_unwinds_though_thrusters_are_at_their_limit() -> None:
    loops = Loops(abilities_of(pool_sheet()), (True,) * 6)
    for _ in range(200):
        loops.wrench(Aim(0.2, 0.0, 5.0, 0.0), Motion(depth=5.0), 0.05)
    wound = loops._push[0]
    loops.limited = True
    for _ in range(100):
        loops.wrench(Aim(-0.2, 0.0, 5.0, 0.0), Motion(depth=5.0), 0.05)
    assert loops._push[0] < wound


@pytest.mark.parametrize(
    ("wanted", "heading", "left"), [(10, 350, 20), (350, 10, -20), (180, 0, -180), (90, 90, 0)]
)
def test_turns_go_the_shorter_way(wanted: float, heading: float, left: float) -> None:
    assert turn(wanted, heading) == pytest.approx(left)


@given(ANGLES, st.floats(-80.0, 80.0), ANGLES)
def test_a_rotation_keeps_lengths_and_the_way_round(roll: float, pitch: float, heading: float) -> None:
    matrix = rotation(roll, pitch, heading)
    assert matrix @ matrix.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(matrix) == pytest.approx(1.0)


def test_the_bow_points_to_where_the_heading_says() -> None:
    ahead = rotation(0.0, 0.0, 90.0) @ (1.0, 0.0, 0.0)
    assert ahead == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)
    assert bearing(ahead[0], ahead[1]) == pytest.approx(90.0)
