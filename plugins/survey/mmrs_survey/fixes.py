"""Quick fixes of figures of survey tasks."""

from __future__ import annotations

from mmrs_core.analysis.fixes.figures import as_part
from mmrs_core.contributions.fixes import Fix
from mmrs_survey.grid_checks import OVERLAPS

FIXES = (Fix("SUR003", "write the overlaps as parts of one", as_part(*OVERLAPS)),)
