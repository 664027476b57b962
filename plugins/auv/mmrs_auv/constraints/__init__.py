"""What must hold for underwater vehicles and for missions that use them."""

from __future__ import annotations

from mmrs_auv.constraints.equipment import EQUIPMENT_CONSTRAINTS
from mmrs_auv.constraints.mountings import MOUNTING_CONSTRAINTS
from mmrs_auv.constraints.pipelines import PIPELINE_CONSTRAINTS
from mmrs_auv.constraints.tasks import TASK_CONSTRAINTS
from mmrs_auv.constraints.thrusters import THRUSTER_CONSTRAINTS
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
