"""A simulated vehicle that speaks MAVLink like ArduPilot: for trying controllers without hardware.

Run one with ``python -m mmrs_core.sitl --help``, or many in a test with `SimulatedVehicle`.
It knows no aerodynamics: it accelerates, flies straight lines, climbs, turns, and lands.
"""

from mmrs_core.sitl.faults import FAULTS, Faults
from mmrs_core.sitl.hosting import Host
from mmrs_core.sitl.settings import Settings
from mmrs_core.sitl.vehicle import SimulatedVehicle

__all__ = ["FAULTS", "Faults", "Host", "Settings", "SimulatedVehicle"]
