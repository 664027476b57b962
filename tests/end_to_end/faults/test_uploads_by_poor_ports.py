"""Missions, fences and rally points by ports that are slow or old, in both executions."""

from __future__ import annotations

import pytest
from fault_table.fleet import GENERATED, Fleet
from fault_table.project import Pad
from patience import wait_for
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import MISSION, RALLY
from mmrs_mavlink.sitl.transfers import Transfers

pytestmark = pytest.mark.real_time("faults")

PATIENCE = 60.0
SLOW = 0.15
"""Real seconds, either way: there and back it takes longer than the vehicles wait before they ask again."""


@pytest.fixture
def refusals(monkeypatch):
    """Return the results of all that vehicles answer by, but that they accept something."""
    results = []
    acknowledge = Transfers._acknowledge

    def noted(transfers, peer, result, kind):
        results.append(result)
        acknowledge(transfers, peer, result, kind)

    monkeypatch.setattr(Transfers, "_acknowledge", noted)
    return results


@pytest.mark.thorough
def test_items_that_come_twice_since_the_way_is_long_end_no_upload(tmp_path, refusals):
    with Fleet(tmp_path, [Pad("a")], GENERATED, speedup=10.0, delay=SLOW) as fleet:
        fleet.start()
        plans = fleet.vehicles["a"].autopilot.stores
        # Rally points come last, after the mission was read back.
        assert wait_for(lambda: plans[RALLY], PATIENCE), fleet.process.said
        assert plans[MISSION]
        assert mavlink.MAV_MISSION_INVALID_SEQUENCE in refusals


def test_a_port_that_stays_at_mavlink_1_is_named_at_once(tmp_path):
    settings = {"a": {"mavlink": 1}}
    with Fleet(tmp_path, [Pad("a")], GENERATED, speedup=10.0, settings=settings) as fleet:
        process = fleet.start()
        process.end(PATIENCE)
        said = "\n".join(process.said)
        received = [name for _, name in fleet.vehicles["a"].received]
    assert "fence: the vehicle speaks MAVLink 1 on this port" in said
    assert "SERIALn_PROTOCOL 2" in said
    assert received.count("MISSION_COUNT") == 1
