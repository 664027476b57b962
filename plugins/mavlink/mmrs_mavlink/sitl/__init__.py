"""Simulated MAVLink vehicles, for testing controllers without hardware.

``mmrs sitl`` starts them; a test starts its own with `SimulatedVehicle`. A vehicle is a
point mass without aerodynamics: it accelerates, flies straight legs, climbs, turns and lands.
"""

from mmrs_mavlink.sitl.faults import FAULTS, Faults
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.vehicle import Host, SimulatedVehicle

__all__ = ["FAULTS", "Faults", "Host", "Settings", "SimulatedVehicle"]
