"""Missions, fences and rally points by ports that are slow or old, in both executions."""

import pytest
from fault_table.fleet import GENERATED, Fleet
from fault_table.project import Pad
from patience import wait_for
from pymavlink.dialects.v10 import ardupilotmega as old
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import MISSION, RALLY
from mmrs_mavlink.sitl.radio import SimulatedRadio
from mmrs_mavlink.sitl.transfers import Transfers

pytestmark = pytest.mark.real_time("faults")

PATIENCE = 60.0
SPEEDUP = 10.0
SLOW = 0.15 * SPEEDUP
"""Seconds of the run, either way: more, there and back, than the vehicles wait before they ask again."""


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
    with Fleet(tmp_path, [Pad("a")], GENERATED, speedup=SPEEDUP) as fleet:
        fleet.start("--inject", f"delay={SLOW}")
        plans = fleet.vehicles["a"].autopilot.stores
        # Rally points come last, after the mission was read back.
        assert wait_for(lambda: plans[RALLY], PATIENCE), fleet.process.said
        assert plans[MISSION]
        assert mavlink.MAV_MISSION_INVALID_SEQUENCE in refusals


@pytest.fixture
def old_ports(monkeypatch):
    """Make vehicles send MAVLink 1 only, and take no other plans than missions (``GCS_Common.cpp``)."""
    sender = old.MAVLink(None, srcSystem=1, srcComponent=1)
    take = Transfers.take

    def send(radio, message):
        kind = getattr(old, type(message).__name__, None)
        if kind is not None:
            values = [getattr(message, name) for name in kind.fieldnames]
            sent = kind(*(each.encode() if isinstance(each, str) else each for each in values))
            radio.write(bytes(sent.pack(sender)))
            sender.seq = (sender.seq + 1) % 256

    def take_missions(transfers, message):
        if getattr(message, "mission_type", MISSION) == MISSION:
            take(transfers, message)
        elif message.get_type() != "MISSION_ACK":
            peer = message.get_srcSystem(), message.get_srcComponent()
            transfers._acknowledge(peer, mavlink.MAV_MISSION_UNSUPPORTED, message.mission_type)

    monkeypatch.setattr(SimulatedRadio, "send", send)
    monkeypatch.setattr(Transfers, "take", take_missions)


def test_a_port_that_stays_at_mavlink_1_is_named_at_once(tmp_path, old_ports):
    with Fleet(tmp_path, [Pad("a")], GENERATED, speedup=SPEEDUP) as fleet:
        process = fleet.start()
        process.end(PATIENCE)
        said = "\n".join(process.said)
        received = [name for _, name in fleet.vehicles["a"].received]
    assert "fence: the vehicle speaks MAVLink 1 on this port" in said
    assert "SERIALn_PROTOCOL 2" in said
    assert received.count("MISSION_COUNT") == 1
