"""The core's own targets."""

from __future__ import annotations

from mmrs_core.contributions.targets import Target
from mmrs_core.mavlink.controllers import MAVLINK_PYTHON
from mmrs_core.mavlink.plans.qgc import QGC_PLAN
from mmrs_core.mavlink.plans.wpl import WPL

TARGETS: tuple[Target, ...] = (MAVLINK_PYTHON, QGC_PLAN, WPL)
