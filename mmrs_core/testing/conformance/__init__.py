"""What must hold for every contribution of its sort, as test classes for plug-ins to subclass.

A test module of a plug-in says ``class TestConstraints(ConstraintConformance)``, gives what the class
asks for as attributes, and pytest runs all its laws. Needs pytest and hypothesis.
"""

import pytest

_MODULES = (
    "checks",
    "constraints",
    "declared",
    "element_kinds",
    "fixes",
    "metamodels",
    "missions",
    "move_kinds",
    "plugins",
    "robot_kinds",
    "rules",
    "targets",
    "vehicles",
)
pytest.register_assert_rewrite(*(f"{__name__}.{module}" for module in _MODULES))

from mmrs_core.testing.conformance.checks import CheckCase, CheckConformance  # noqa: E402
from mmrs_core.testing.conformance.constraints import Case, ConstraintConformance  # noqa: E402
from mmrs_core.testing.conformance.element_kinds import ElementKindConformance  # noqa: E402
from mmrs_core.testing.conformance.fixes import FixCase, FixConformance  # noqa: E402
from mmrs_core.testing.conformance.metamodels import MetamodelConformance  # noqa: E402
from mmrs_core.testing.conformance.missions import MissionConformance  # noqa: E402
from mmrs_core.testing.conformance.move_kinds import MoveKindConformance  # noqa: E402
from mmrs_core.testing.conformance.plugins import PluginConformance  # noqa: E402
from mmrs_core.testing.conformance.robot_kinds import RobotKindConformance  # noqa: E402
from mmrs_core.testing.conformance.rules import RuleConformance  # noqa: E402
from mmrs_core.testing.conformance.targets import TargetConformance  # noqa: E402
from mmrs_core.testing.conformance.vehicles import VehicleConformance  # noqa: E402

__all__ = [
    "Case",
    "CheckCase",
    "CheckConformance",
    "ConstraintConformance",
    "ElementKindConformance",
    "FixCase",
    "FixConformance",
    "MetamodelConformance",
    "MissionConformance",
    "MoveKindConformance",
    "PluginConformance",
    "RobotKindConformance",
    "RuleConformance",
    "TargetConformance",
    "VehicleConformance",
]
