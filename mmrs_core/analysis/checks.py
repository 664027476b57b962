"""The checks that the core contributes."""

from __future__ import annotations

from mmrs_core.analysis.clearance import CLEARANCE
from mmrs_core.analysis.corridors import CORRIDORS
from mmrs_core.analysis.diversions import DIVERSION
from mmrs_core.analysis.endurance import ENDURANCE, ENERGY, RECHARGE_CHECK
from mmrs_core.analysis.envelope import ALTITUDE, DEPTH, TEMPERATURE, WIND
from mmrs_core.analysis.equipment import DEVICES, PAYLOAD, SPEED
from mmrs_core.analysis.radio import RANGE
from mmrs_core.analysis.separation import SEPARATION
from mmrs_core.analysis.states import STATES
from mmrs_core.analysis.structure import STRUCTURE
from mmrs_core.analysis.synchronisation.check import SYNCHRONISATION
from mmrs_core.contributions.checks import Check

CHECKS: tuple[Check, ...] = (
    STRUCTURE,
    SYNCHRONISATION,
    CLEARANCE,
    CORRIDORS,
    ALTITUDE,
    DEPTH,
    RANGE,
    ENDURANCE,
    ENERGY,
    RECHARGE_CHECK,
    DIVERSION,
    STATES,
    SEPARATION,
    SPEED,
    PAYLOAD,
    DEVICES,
    WIND,
    TEMPERATURE,
)
"""In the order in which they are reported: what breaks others first."""
