"""What must hold for underwater vehicles and for missions that use them."""

from __future__ import annotations

from mmrs_auv.constraints.equipment import EQUIPMENT_CONSTRAINTS
from mmrs_auv.constraints.tasks import PIPELINE_CONSTRAINTS, TASK_CONSTRAINTS
from mmrs_auv.constraints.thrusters import MOUNTING_CONSTRAINTS, THRUSTER_CONSTRAINTS
from mmrs_auv.constraints.vehicles import VEHICLE_CONSTRAINTS

CONSTRAINTS = tuple(
    sorted(
        (
            *VEHICLE_CONSTRAINTS,
            *MOUNTING_CONSTRAINTS,
            *EQUIPMENT_CONSTRAINTS,
            *TASK_CONSTRAINTS,
            *PIPELINE_CONSTRAINTS,
            *THRUSTER_CONSTRAINTS,
        ),
        key=lambda each: each.code,
    )
)
