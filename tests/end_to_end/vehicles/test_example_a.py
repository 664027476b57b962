"""Example (a), flown by three vehicles of every sort there is, in both ways."""

import pytest
from example_flight.fleets import FLEETS
from example_flight.mission import SLACK, Mission
from example_flight.ways import WAYS

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("faults")


def _needs(fleet: str) -> list[pytest.MarkDecorator]:
    firmware = getattr(FLEETS[fleet], "firmware", None)
    if firmware is None:
        return [pytest.mark.timeout(900)]
    reason = f"{firmware.variable} names no binary: the example was not flown on {fleet}"
    missing = pytest.mark.skipif(not firmware.binary, reason=reason)
    return [pytest.mark.peer, pytest.mark.timeout(3600), missing]


VEHICLES = [pytest.param(fleet, marks=_needs(fleet)) for fleet in FLEETS]


@pytest.mark.thorough
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("fleet", VEHICLES)
def test_three_vehicles_fly_it_and_stay_clear_of_every_area(tmp_path, fleet, way):
    mission = Mission(tmp_path / "mission", getattr(FLEETS[fleet], "properties", None))
    with FLEETS[fleet](mission.homes, tmp_path) as vehicles:
        codes, said = WAYS[way](mission, vehicles.links, vehicles.speedup)
    assert set(codes.values()) == {0}, said
    result = replay(mission.program, read_logs([mission.folder / "logs"]))
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())
    for home in mission.homes:
        track = vehicles.tracks[home.robot]
        assert len(track) > 100
        for area, margin in mission.margins(home, track).items():
            print(f"{fleet}, {way}: {home.robot} {margin:+.2f} m from {area} beyond what it must be")
            assert margin >= -SLACK, f"{home.robot} is {-margin:.2f} m too close to {area}"
    if fleet == "mavsdk":
        told = vehicles.by_mavsdk[mission.homes[0].robot]
        assert {"COMMAND_ACK", "PARAM_VALUE", "GLOBAL_POSITION_INT"} <= told.keys()
