"""A vehicle gives its dive up when a message on its bus has two senders, whoever they are."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import pytest
from sample_vessels import heavy_sheet, pool_sheet
from vessel_rig import Rig

from auv_vessel.api import Craft
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.hosting import WireFault
from auv_vessel.movement.movement import Movement
from auv_vessel.node import Node
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import EMERGENCIES, REASONS
from auv_vessel.wire.codec import Codec, Value
from auv_vessel.wire.frame import Frame

pytestmark = pytest.mark.long

DIVING = replace(pool_sheet(), home=(0.0, 0.0, 2.0))


class Stranger:
    """A device that nobody knows, which says one message again and again.

    It hears nothing, so that others have to notice.
    """

    name = "Stranger"

    def __init__(self, sheet: Sheet, message: str, period: float, **values: Value) -> None:
        self.period = period
        self._codec, self._message, self._values = Codec(sheet), message, values

    def hear(self, frame: Frame, now: float) -> None:
        """Hear nothing."""

    def tick(self, now: float) -> list[Frame]:
        return [self._codec.encode(self._message, **self._values)]


def diving(sheet: Sheet = DIVING) -> Rig:
    rig = Rig(sheet)
    rig.craft.go_to(60.0, 0.0, 2.0, heading=0.0)
    rig.run(6.0)
    assert rig.pushed["status"] > 5.8
    assert rig.emergencies == []
    return rig


MAKERS: dict[str, Callable[[Sheet], Node]] = {
    "movement": lambda sheet: Movement(sheet, Codec(sheet)),
    "sensors": lambda sheet: Sensors(sheet, Codec(sheet)),
    "actuators": lambda sheet: Actuators(sheet, Codec(sheet)),
    "vehicle": lambda sheet: Vehicle(sheet, Codec(sheet), seed=7),
    "decision centre": lambda sheet: Craft(sheet, Codec(sheet)),
}


@pytest.mark.parametrize("kind", MAKERS)
def test_a_second_node_of_any_kind_ends_the_dive(kind: str) -> None:
    rig = diving()
    rig.bus.add(MAKERS[kind](DIVING))
    rig.run(3.0)
    assert {reason for _, reason in rig.emergencies} == {"TWO_SENDERS"}
    assert rig.pushed["command"] < 6.6
    assert rig.pushed["status"] < 6.6
    assert rig.state.emergency == "TWO_SENDERS"
    assert rig.actuators.emergency == "TWO_SENDERS"


@pytest.mark.parametrize(
    ("message", "period", "values"),
    [
        ("WrenchForce", 0.05, {"Surge": 30.0, "Sway": 0.0, "Heave": 0.0, "Enable": True}),
        pytest.param(
            *("WrenchForce", 1.0, {"Surge": 30.0, "Sway": 0.0, "Heave": 0.0, "Enable": True}),
            marks=pytest.mark.thorough,
        ),
        ("Thruster0Command", 0.05, {"Thrust": 30.0, "Enable": True}),
        pytest.param(
            *("Thruster0Status", 0.1, {"Thrust": 0.0, "Power": 0.0, "Drive": "FAULT"}),
            marks=pytest.mark.thorough,
        ),
        ("Depth", 0.05, {"Depth": 0.2, "Uncertainty": 0.1, "Trusted": True}),
        pytest.param(
            *("Pressure", 0.05, {"Pressure": 101325.0, "Temperature": 10.0}), marks=pytest.mark.thorough
        ),
        ("GoalPlace", 0.2, {"North": 0.0, "East": 0.0}),
        ("ActuatorsBeat", 0.5, {"State": "RUNS", "Uptime": 1.0, "Reason": "NONE"}),
    ],
)
def test_a_strange_device_that_says_what_a_node_says_ends_the_dive(
    message: str, period: float, values: dict[str, Value]
) -> None:
    rig = diving()
    rig.bus.add(Stranger(DIVING, message, period, **values))
    rig.run(4.0)
    assert {reason for _, reason in rig.emergencies} == {"TWO_SENDERS"}
    assert rig.pushed["status"] < 6.0 + 2.0 * period + 0.3


class Ear:
    """A node that says nothing, and keeps what it hears under one identifier."""

    name, period = "Ear", 1.0

    def __init__(self, id: int) -> None:
        self.heard: list[Frame] = []
        self._id = id

    def hear(self, frame: Frame, now: float) -> None:
        if frame.id == self._id:
            self.heard.append(frame)

    def tick(self, now: float) -> list[Frame]:
        return []


def test_all_emergencies_of_a_node_go_by_one_counter() -> None:
    rig, ear = diving(), Ear(EMERGENCIES["ActuatorsEmergency"])
    rig.bus.add(ear)
    rig.vehicle.faults.leak = True
    rig.run(2.0)
    rig.bus.add(Stranger(DIVING, "GoalPlace", 0.2, North=0.0, East=0.0))
    rig.run(3.0)
    assert {REASONS[frame.data[0]] for frame in ear.heard} == {"LEAK", "TWO_SENDERS"}
    counters = [frame.data[-2] for frame in ear.heard]
    assert {(later - earlier) % 256 for earlier, later in pairwise(counters)} == {1}


def test_a_vehicle_that_sinks_drops_its_weight_and_comes_up() -> None:
    sheet = replace(heavy_sheet(), drop_weight=7.0, home=(0.0, 0.0, 2.0))
    rig = diving(sheet)
    rig.bus.add(Movement(sheet, Codec(sheet)))
    rig.until(lambda: rig.afloat, 30.0)
    assert rig.vehicle.released


@pytest.mark.parametrize("fault", [WireFault(loss=0.5, seed=3), WireFault(corruption=0.3, seed=3)])
def test_a_bad_bus_alone_is_not_taken_for_two_senders(fault: WireFault) -> None:
    rig = diving()
    rig.bus.disturb(fault)
    rig.run(20.0)
    assert "TWO_SENDERS" not in {reason for _, reason in rig.emergencies}


def test_a_part_that_begins_anew_is_no_second_one() -> None:
    rig = diving()
    rig.bus.kill("Movement")
    rig.run(0.5)
    replaced = Movement(DIVING, Codec(DIVING))
    replaced.name = "Movement anew"
    rig.bus.add(replaced)
    rig.run(5.0)
    assert rig.emergencies == []
    assert rig.pushed["status"] > 11.0
