"""Runs of `mmrs run` as processes: orders to them, and what their vehicles and logs show."""

from math import dist

from fault_table.project import Pad
from patience import wait_for

from mmrs_mavlink.sitl.commands import execute
from mmrs_runtime.orders.ordering import give

PATIENCE = 60.0
UNHURRIED = 15.0
"""Speed-up that leaves real time for orders on the way."""

AT_HOME = 0.4
"""Metres from home at which a vehicle may land: ArduCopter landed within 0.3 m (benchmarks/results)."""

TAKE_OFF = 22
HOLDING = 17
"""ArduPilot's number of BRAKE."""

SYNCHRONISED = (Pad("a", "wait"), Pad("b", "give", stay=8.0, gives="a"))


def ordered(fleet, order, robot="a", **options):
    """Give an order to a robot as `mmrs control` does; return its answer."""
    (reply,) = give(fleet.logs, order, [robot], **options)
    return reply


def begun(fleet, robot, move):
    """Wait until a robot has begun a move."""

    def found():
        return any(s["label"] == "begin" and s["move"] == move for s in fleet.steps(robot))

    assert wait_for(found, PATIENCE), fleet.process.said
    return fleet.vehicles[robot]


def judged(fleet):
    """Return the outcome of a replay without complaints."""
    result = fleet.replayed()
    assert result.complaints == ()
    return result.outcome


def landed(fleet):
    """Return whether the motors of all vehicles are off."""
    return not any(vehicle.autopilot.armed for vehicle in fleet.vehicles.values())


def least_distance(vehicle, place):
    """Return how near to a place a vehicle has come: metres."""
    return min(dist(point[1:], place) for point in vehicle.autopilot.track)


def fly_by_hand(vehicle):
    """Have a pilot take off and loiter with a vehicle."""
    assert wait_for(lambda: vehicle.autopilot.ready, PATIENCE)
    with vehicle.lock:
        pilot = vehicle.autopilot
        pilot.set_mode(pilot.numbers["guided"])
        pilot.arm()
        execute(pilot, TAKE_OFF, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 15.0))
    assert wait_for(lambda: vehicle.autopilot.body.position[2] > 10.0, PATIENCE)
    vehicle.faults.begin("stick", "loiter")
