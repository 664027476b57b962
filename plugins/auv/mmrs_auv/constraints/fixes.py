"""What mends figures of thrusters and tasks that can only be meant in one way."""

from __future__ import annotations

from mmrs_core.analysis.fixes.figures import as_part, exchanged
from mmrs_core.contributions.fixes import Fix

FIXES = (
    Fix("AUV005", "exchange operatingThrust and maxThrust", exchanged("operatingThrust", "maxThrust")),
    Fix("AUV006", "exchange operatingPower and maxPower", exchanged("operatingPower", "maxPower")),
    Fix("AUV023", "write the overlap as a part of one", as_part("overlap")),
    Fix("AUV025", "exchange minDepth and maxDepth", exchanged("minDepth", "maxDepth")),
)
