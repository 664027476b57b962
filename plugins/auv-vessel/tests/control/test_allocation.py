import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_vessels import VECTORED, heavy_sheet, level, pool_sheet, sheet, torpedo_sheet

from auv_vessel.control.allocation import DEGREES, TINY, Allocation, bounded_least_squares

COUNTS = st.integers(1, 8)


@st.composite
def problems(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Make a matrix, a right side and bounds; some bounds leave nothing free, some columns are alike."""
    rows, columns = draw(st.integers(1, 6)), draw(COUNTS)
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    matrix = random.normal(size=(rows, columns))
    if columns > 1 and draw(st.booleans()):
        matrix[:, 1] = matrix[:, 0]
    low = -random.uniform(0.0, 3.0, columns)
    high = random.uniform(0.0, 3.0, columns)
    still = random.random(columns) < 0.2
    low[still] = high[still] = 0.0
    return matrix, random.normal(size=rows) * draw(st.sampled_from((0.1, 1.0, 20.0))), low, high


def definite(matrix: np.ndarray, tiny: float = TINY) -> np.ndarray:
    hessian = matrix.T @ matrix
    return hessian + tiny * hessian.diagonal().max() * np.eye(len(hessian))


@given(problems())
def test_no_thrust_within_bounds_would_come_nearer(
    problem: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
) -> None:
    """The conditions of Karush, Kuhn and Tucker hold, which for a convex problem prove the least."""
    matrix, wanted, low, high = problem
    x = bounded_least_squares(matrix, wanted, low, high)
    assert np.all(x >= low)
    assert np.all(x <= high)
    slope = definite(matrix) @ x - matrix.T @ wanted
    tolerance = 1e-6 * (1.0 + np.abs(matrix.T @ wanted).max())
    for number in range(len(x)):
        if low[number] == high[number]:
            continue
        if x[number] > low[number]:
            assert slope[number] <= tolerance
        if x[number] < high[number]:
            assert slope[number] >= -tolerance


@given(st.integers(0, 2**32 - 1))
def test_a_search_over_all_of_a_grid_finds_nothing_better(seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix, wanted = random.normal(size=(3, 3)), 3.0 * random.normal(size=3)
    low, high = -random.uniform(0.1, 1.0, 3), random.uniform(0.1, 1.0, 3)
    x = bounded_least_squares(matrix, wanted, low, high)
    axes = [np.linspace(low[each], high[each], 21) for each in range(3)]
    grid = np.array(np.meshgrid(*axes)).reshape(3, -1)
    hessian = definite(matrix)

    def cost(points: np.ndarray) -> np.ndarray:
        return 0.5 * np.einsum("ij,ij->j", points, hessian @ points) - (matrix.T @ wanted) @ points

    assert cost(x[:, None])[0] <= cost(grid).min() + 1e-9


@pytest.mark.parametrize("vehicle", [pool_sheet(), torpedo_sheet(), heavy_sheet()])
def test_a_wrench_that_thrusters_can_give_is_given(vehicle: object) -> None:
    allocation = Allocation(vehicle)
    count = allocation.matrix.shape[1]
    thrusts = np.random.default_rng(1).uniform(-10.0, 10.0, count)
    wrench = allocation.matrix @ thrusts
    found = allocation.thrusts(wrench, np.full(count, -35.0), np.full(count, 35.0))
    assert allocation.missing(wrench, found) == pytest.approx(np.zeros(6), abs=2e-3)
    assert np.linalg.norm(found) <= np.linalg.norm(thrusts) + 1e-6


def test_depth_and_heading_go_before_speed_when_thrust_is_short() -> None:
    allocation = Allocation(pool_sheet())
    bounds = np.full(6, 10.0)
    wrench = np.array((60.0, 0.0, 15.0, 0.0, 0.0, 4.0))
    given = allocation.matrix @ allocation.thrusts(wrench, -bounds, bounds)
    assert given[2] == pytest.approx(15.0, rel=0.02)
    assert given[5] == pytest.approx(4.0, rel=0.05)
    assert 10.0 < given[0] < 40.0 / np.sqrt(2.0)


@pytest.mark.parametrize(
    ("vehicle", "served"),
    [
        (pool_sheet(), {"Surge", "Sway", "Heave", "Roll", "Yaw"}),
        (torpedo_sheet(), {"Surge", "Heave", "Pitch", "Yaw"}),
        (heavy_sheet(), set(DEGREES)),
        (sheet(VECTORED), {"Surge", "Sway", "Yaw"}),
        (sheet((level("T", -0.3, 0.0, 0.0),)), {"Surge"}),
        (sheet(()), set()),
    ],
)
def test_degrees_that_thrusters_serve_follow_from_their_mounting(vehicle: object, served: set[str]) -> None:
    allocation = Allocation(vehicle)
    found = allocation.served([True] * allocation.matrix.shape[1])
    assert {name for name, serves in zip(DEGREES, found, strict=True) if serves} == served


def test_a_dead_thruster_takes_degrees_with_it() -> None:
    allocation = Allocation(torpedo_sheet())
    found = allocation.served([False, True, True, True])
    assert {name for name, serves in zip(DEGREES, found, strict=True) if serves} == {"Heave", "Pitch"}


def test_what_a_dead_thruster_did_others_do_where_they_can() -> None:
    allocation = Allocation(heavy_sheet())
    low, high = np.full(8, -35.0), np.full(8, 35.0)
    low[5] = high[5] = 0.0
    wrench = np.array((20.0, 0.0, 20.0, 0.0, 0.0, 3.0))
    found = allocation.thrusts(wrench, low, high)
    assert found[5] == 0.0
    assert allocation.missing(wrench, found) == pytest.approx(np.zeros(6), abs=2e-3)
