"""Simulated vehicles take as long as the same models are planned to take, and as recorded flights took.

MMRS_RECORDED_FLIGHTS is a folder of recorded flights, as in `test_flown_times.py`; without it, simulated
missions are compared with the plan alone.
"""

import os
from pathlib import Path
from shutil import copytree, ignore_patterns

import pytest
from flown_times.comparison import LEGS_WITHIN, MOST_LEGS, WITHIN, compared
from flown_times.simulated import simulate_mission, simulate_steps
from real_flights.routes import COPTER, ROVER, SUB, Route, on_px4, routes
from real_flights.table import ARCS, FLIGHTS

FOLDER = os.environ.get("MMRS_RECORDED_FLIGHTS", "")
MISSIONS = {"carbon-dioxide-auto": "Alba", "rover-long-legs-auto": "Badger"}
"""Recorded missions, and who flew each."""

STEPS = ("handwritten-guided", "lawn-auto", "rover-long-legs-guided", "carbon-dioxide-guided")
"""Recorded flights that were commanded step by step: copters and a rover."""

recorded = pytest.mark.skipif(not FOLDER, reason="MMRS_RECORDED_FLIGHTS is no folder of recorded flights")


def as_recorded(name, tmp_path):
    """Return a folder with the models of a recorded flight, and none of its logs."""
    folder = copytree(Path(FOLDER) / name, tmp_path / name, ignore=ignore_patterns("logs", "*.gz"))
    for file in (folder, *folder.rglob("*")):
        file.chmod(0o755)
    return folder


def faults(flight, simulated):
    """Return in which robots a recorded flight and a simulated one differ by more than they may."""
    found = []
    for one, two in zip(compared(flight), compared(simulated), strict=True):
        both = [(one.legs[move][1], two.legs[move][1]) for move in one.legs if move in two.legs]
        real, imitated = (sum(each) for each in zip(*both, strict=True))
        good = sum(abs(b / a - 1.0) <= LEGS_WITHIN for a, b in both)
        if abs(imitated / real - 1.0) > WITHIN or good < MOST_LEGS * len(both) - 1:
            found.append(f"{one.robot}: {imitated:.1f} of {real:.1f} s, {good} of {len(both)} legs")
    return found


def test_a_submarines_program_may_end_below(tmp_path):
    """Its motors stop there since the program stops them."""
    routes(Route("Nereid", SUB, ((0.0, 5.0, -3.0), (5.0, 5.0, -4.0)), 1.0))(tmp_path / "models")
    simulate_steps(tmp_path / "models")
    (found,) = compared(tmp_path / "models")
    assert found.whole


@pytest.mark.parametrize(
    ("name", "robot", "others"),
    [
        ("copter: plan in AUTO", "Alba", 0),
        ("rover: plan in AUTO", "Badger", 0),
        ("tracked rover: plan in AUTO", "Crawler", 0),
        ("sub: plan in AUTO", "Nereid", 1),
        ("sub: up and down in AUTO", "Nereid", 0),
        ("sub: transect in AUTO", "Nereid", 0),
        ("PX4: plan in AUTO", "Alba", 0),
        ("PX4: ten minutes in AUTO", "Alba", 0),
        ("PX4: strips in AUTO", "Alba", 0),
        ("PX4: quick strips in AUTO", "Alba", 5),
        ("PX4: hops in AUTO", "Alba", 1),
    ],
)
def test_a_simulated_mission_takes_what_is_planned(name, robot, others, tmp_path):
    """`others` are the legs that take other times.

    The last one of the submarine is short, and leads up. Of a PX4 that passes places at 9 m/s, the plan
    counts more of the lag at these, and less after turns.
    """
    next(flight for flight in FLIGHTS if flight.name == name).models(tmp_path / "models")
    simulate_mission(tmp_path / "models", robot)
    (found,) = compared(tmp_path / "models")
    assert found.whole
    assert list(found.faults()) == []
    assert len(found.legs) - found.good_legs <= others


@pytest.mark.parametrize(
    "places",
    [
        ((0.0, 70.0, 12.0), (0.0, 40.0, 12.0), (0.0, 60.0, 12.0), (0.0, 10.0, 12.0)),
        ((20.0, 10.0, 12.0), (20.0, 10.0, 22.0), (20.0, -20.0, 22.0), (40.0, -20.0, 22.0)),
        ((20.0, 30.0, 12.0), (20.0, 0.0, 12.0), (20.0, 0.0, 12.0), (40.0, 0.0, 12.0)),
        tuple((0.3 * (index % 2), 3.0 * (index % 2), 12.0) for index in range(1, 12)),
    ],
    ids=["right round", "climb", "a place twice", "short and sharp"],
)
def test_a_simulated_px4_passes_any_corner_as_planned(places, tmp_path):
    route = Route("Alba", COPTER, places, 5.0, fluid=True)
    on_px4(routes(route))(tmp_path / "models")
    simulate_mission(tmp_path / "models", "Alba")
    (found,) = compared(tmp_path / "models")
    assert found.whole
    assert list(found.faults()) == []


def test_a_simulated_car_shunts_as_slowly_as_real_ones(tmp_path):
    """An ArduRover took 55.7 s for this, in two flights; of that, 14.2 and 14.9 s for one leg of a metre."""
    routes(Route("Badger", ROVER, ARCS, 1.0))(tmp_path / "models")
    simulate_steps(tmp_path / "models")
    (found,) = compared(tmp_path / "models")
    assert found.whole
    assert sum(seconds for _, seconds in found.legs.values()) == pytest.approx(55.7, rel=0.1)


def test_a_simulated_car_takes_as_long_to_what_is_behind_it_as_real_ones(tmp_path):
    """An ArduRover took 20.1, 34.6, 29.2 and 30.4 s."""
    there_and_back = tuple((0.0, north, 0.0) for north in (25.0, 0.0, 25.0, 0.0))
    routes(Route("Badger", ROVER, there_and_back, 1.5))(tmp_path / "models")
    simulate_steps(tmp_path / "models")
    (found,) = compared(tmp_path / "models")
    assert found.whole
    for (_, seconds), real in zip(found.legs.values(), (20.1, 34.6, 29.2, 30.4), strict=True):
        assert seconds == pytest.approx(real, rel=0.1)


@recorded
@pytest.mark.parametrize("name", MISSIONS)
def test_a_simulated_mission_takes_what_a_recorded_one_did(name, tmp_path):
    folder = as_recorded(name, tmp_path)
    simulate_mission(folder, MISSIONS[name])
    assert faults(Path(FOLDER) / name, folder) == []


@recorded
@pytest.mark.timeout(900)  # the longest recorded flight takes six minutes at this speed
@pytest.mark.real_time("faults")
@pytest.mark.parametrize("name", STEPS)
def test_simulated_steps_take_what_recorded_ones_did(name, tmp_path):
    folder = as_recorded(name, tmp_path)
    arguments = ["--backend-option", "objects=expected"] if name == "handwritten-guided" else []
    simulate_steps(folder, *arguments, speedup=4.0)
    assert faults(Path(FOLDER) / name, folder) == []
