"""What executions of behaviours know of robots: their states, ways and faults, and conditions.

These are the engine's own; plug-ins find them here.
"""

from __future__ import annotations

from mmrs_runtime.engine.clocks import RunClock as Clock
from mmrs_runtime.vehicle import Condition, Fault, Sample
from mmrs_runtime.vehicle import VehicleState as RobotState

__all__ = ["Clock", "Condition", "Fault", "RobotState", "Sample"]
