"""What mends figures of thrusters that can only be meant in one way."""

from __future__ import annotations

from mmrs_core.analysis.fixes.figures import exchanged
from mmrs_core.contributions.fixes import Fix

FIXES = (
    Fix("AUV005", "exchange operatingThrust and maxThrust", exchanged("operatingThrust", "maxThrust")),
    Fix("AUV006", "exchange operatingPower and maxPower", exchanged("operatingPower", "maxPower")),
)
