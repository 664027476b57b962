"""`mmrs run` as a process waits for robots whose batteries are changed."""

import pytest
from fault_table.project import Pad
from patience import wait_for
from real_runs import PATIENCE, begun, judged, ordered

from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("runs")


@pytest.mark.thorough
def test_a_robot_that_came_down_elsewhere_for_its_battery_is_not_resumed_before_it_stands_at_home(fleet):
    flown = fleet(Pad("a", policies=(("BATTERY_LOW", "LAND", None),)))
    process = flown.start("--battery-patience", "600")
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.begin("battery", 0.15)
    assert wait_for(lambda: any("carry it home" in line for line in process.said), PATIENCE)
    vehicle.faults.begin("battery", 1.0)
    for order in ("resume", "return"):
        assert ordered(flown, order)["why"].endswith("m from its home: carry it home")
    with vehicle.lock:
        vehicle.autopilot.body.position = (0.0, 0.0, 0.0)
    assert wait_for(lambda: ordered(flown, "resume")["confirmed"], PATIENCE)
    assert vehicle.autopilot.armed
    assert process.end(PATIENCE) == 0, process.said
    assert judged(flown) is Outcome.SUCCESS


def test_a_robot_in_the_air_waits_for_one_whose_battery_is_changed_and_then_goes_on(fleet):
    low = (("BATTERY_LOW", "RETURN", None),)
    flown = fleet(Pad("a", "give", low, stay=30.0, gives="b"), Pad("b", "wait"))
    process = flown.start()
    vehicle = begun(flown, "a", "stay")
    assert wait_for(
        lambda: any(s["move"] == "out" and s["label"] == "end" for s in flown.steps("b")), PATIENCE
    )
    vehicle.faults.begin("battery", 0.15)
    words = "nothing continues without an order: 'b' waits after 'out'"
    assert wait_for(lambda: any(words in line for line in process.said), PATIENCE), process.said
    assert not vehicle.autopilot.armed
    assert flown.vehicles["b"].autopilot.armed
    vehicle.faults.begin("battery", 1.0)
    assert wait_for(lambda: ordered(flown, "resume")["confirmed"], PATIENCE)
    assert process.end(PATIENCE) == 0, process.said
    assert judged(flown) is Outcome.SUCCESS
