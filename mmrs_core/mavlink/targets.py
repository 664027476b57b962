"""The core's own targets."""

from __future__ import annotations

from mmrs_core.contributions.targets import Target
from mmrs_core.mavlink.controllers import MAVLINK_PYTHON
from mmrs_core.mavlink.qgc.target import QGC_PLAN

TARGETS: tuple[Target, ...] = (MAVLINK_PYTHON, QGC_PLAN)
