"""Ground stations that are left unheard on purpose."""

from types import SimpleNamespace

import pytest
from mavlink_peer import eventually, heartbeat, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.clock import Clock
from mmrs_runtime.injection import Rehearsal, injections

pytestmark = pytest.mark.real_time("parts of flights")

STATION = heartbeat(kind=mavlink.MAV_TYPE_GCS, autopilot=mavlink.MAV_AUTOPILOT_INVALID)
NOBODY = "'alpha': ground-cut@0+0.5: no ground station received yet"


@pytest.fixture
def rehearsed():
    """Return a function that rehearses a fault with the link of a robot named alpha."""
    rehearsals = []

    def begin(text: str, link, robots=("alpha",)):
        said, noted = [], []
        urls = {robot: f"udpin:127.0.0.1:{number}" for number, robot in enumerate(robots, 1)}
        rehearsals.append(Rehearsal(injections([text], urls), Clock(), said.append))
        rehearsals[-1].record("alpha", lambda fault, content: noted.append((fault, content["state"])))
        rehearsals[-1].attend("alpha", link)
        rehearsals[-1].start()
        return SimpleNamespace(said=said, noted=noted)

    yield begin
    for each in rehearsals:
        each.close()


def test_stations_are_not_heard_for_the_time_of_the_cut(rehearsed):
    with linked() as (link, wire):
        wire.say(STATION, system=254)
        eventually(lambda: link.stations.systems)
        found = rehearsed("ground-cut@0.1+0.6", link)
        eventually(lambda: link.stations.deaf)
        eventually(lambda: not link.stations.deaf)
        states = ["asked for", "begins", "ends"]
        eventually(lambda: found.noted == [("ground-cut@0.1+0.6", state) for state in states])


def test_a_cut_of_nothing_is_said(rehearsed):
    with linked() as (link, _):
        found = rehearsed("ground-cut@0+0.5", link)
        eventually(lambda: NOBODY in found.said)


def test_a_cut_of_another_robot_leaves_this_one_alone(rehearsed):
    with linked() as (link, _):
        found = rehearsed("beta:ground-cut@0+0.3", link, ("alpha", "beta"))
        eventually(lambda: "beta:ground-cut@0+0.3: ends" in found.said)
        assert not link.stations.deaf
        assert found.noted == []


def test_a_link_that_is_opened_during_the_cut_hears_none_either():
    with linked() as (link, _):
        urls = {"alpha": "udpin:127.0.0.1:1"}
        rehearsal = Rehearsal(injections(["ground-cut@0"], urls), Clock(), lambda line: None)
        rehearsal.attend("alpha", link)
        assert link.stations.deaf
