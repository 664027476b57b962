"""The targets for MAVLink."""

from __future__ import annotations

from mmrs_core.contributions.targets import Target
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL

TARGETS: tuple[Target, ...] = (MAVLINK_PYTHON, QGC_PLAN, WPL)
