"""What stands between the stages from models to plans: plain frozen values in one local frame.

Positions are (east, north, up) in metres from the mission's origin; speeds are metres per second,
times and durations seconds, energies joules, masses kilograms. Angles keep the unit of the model
(degrees) only inside `attributes`, under the model's own names. Every task, robot type and area
carries its metaclasses as ((nsURI, name), ...), most specific first, so that plug-ins choose by
metaclass without seeing a model.
"""

from typing import TYPE_CHECKING

from mmrs_core.scene.missions import Area, AreaUse, Corridor, CorridorUse, Dependency, Frame, Scene, Task
from mmrs_core.scene.primitives import (
    AltitudeReference,
    Metaclasses,
    Name,
    Part,
    Point,
    Position,
    Ring,
    TravelMode,
    Value,
)
from mmrs_core.scene.robots import Battery, Capability, Device, DeviceAction, Kinematics, Robot, RobotType
from mmrs_core.scene.works import (
    DISTANCE,
    ActionAt,
    Coverage,
    Gap,
    Look,
    Repetition,
    SharedWorks,
    Stroke,
    Work,
    distinct_works,
)
from mmrs_runtime.policies import Policy, PolicyEvent, PolicyResponse

if TYPE_CHECKING:
    from mmrs_core.scene.plans import (
        Await,
        Branch,
        Launch,
        Omission,
        Plan,
        Recharge,
        Recover,
        RobotPlan,
        Serve,
        Signal,
        Step,
        Transit,
        all_steps,
    )

__all__ = [
    "DISTANCE",
    "ActionAt",
    "AltitudeReference",
    "Area",
    "AreaUse",
    "Await",
    "Battery",
    "Branch",
    "Capability",
    "Corridor",
    "CorridorUse",
    "Coverage",
    "Dependency",
    "Device",
    "DeviceAction",
    "Frame",
    "Gap",
    "Kinematics",
    "Launch",
    "Look",
    "Metaclasses",
    "Name",
    "Omission",
    "Part",
    "Plan",
    "Point",
    "Policy",
    "PolicyEvent",
    "PolicyResponse",
    "Position",
    "Recharge",
    "Recover",
    "Repetition",
    "Ring",
    "Robot",
    "RobotPlan",
    "RobotType",
    "Scene",
    "Serve",
    "SharedWorks",
    "Signal",
    "Step",
    "Stroke",
    "Task",
    "Transit",
    "TravelMode",
    "Value",
    "Work",
    "all_steps",
    "distinct_works",
]


def __getattr__(name: str) -> object:
    """Return a name of plans; their module is imported late, since validating needs none of its many."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from mmrs_core.scene import plans

    return getattr(plans, name)
