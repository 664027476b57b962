"""The mission of the paper, carried out by `mmrs run` with three simulated vehicles."""

import pytest
from example_flight.fleets import Ours
from example_flight.mission import SLACK, Mission
from example_flight.ways import by_behaviour

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_runtime.semantics import Outcome

pytestmark = [pytest.mark.real_time("runs"), pytest.mark.thorough]


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Return the mission, the exit code, what was said, and the tracks by robot."""
    folder = tmp_path_factory.mktemp("carbon-dioxide")
    mission = Mission(folder / "mission")
    with Ours(mission.homes, folder) as vehicles:
        codes, said = by_behaviour(mission, vehicles.links, vehicles.speedup)
    return mission, codes, said, vehicles


def test_three_vehicles_fly_it_to_its_end(flown):
    mission, codes, said, vehicles = flown
    assert codes == {"all": 0}, said
    assert len(mission.homes) == 3
    assert not any(vehicles.armed.values())


def test_its_logs_replay(flown):
    mission, *_ = flown
    result = replay(mission.program, read_logs([mission.folder / "logs"]))
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_its_tracks_are_clear_of_every_grown_area_corners_included(flown):
    mission, _, _, vehicles = flown
    for home in mission.homes:
        track = vehicles.tracks[home.robot]
        assert len(track) > 100
        margins = mission.margins(home, track)
        assert margins
        for area, margin in margins.items():
            assert margin >= -SLACK, f"{home.robot} is {-margin:.2f} m too close to {area}"
