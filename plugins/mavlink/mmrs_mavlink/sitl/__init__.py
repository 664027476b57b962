"""A simulated vehicle that speaks MAVLink like ArduPilot: for trying controllers without hardware.

Run one with ``python -m mmrs_mavlink.sitl --help``, or many in a test with `SimulatedVehicle`.
It knows no aerodynamics: it accelerates, flies straight lines, climbs, turns, and lands.
"""

from mmrs_mavlink.sitl.faults import FAULTS, Faults
from mmrs_mavlink.sitl.hosting import Host
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle

__all__ = ["FAULTS", "Faults", "Host", "Settings", "SimulatedVehicle"]
