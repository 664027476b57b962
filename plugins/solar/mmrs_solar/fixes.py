"""Quick fixes of figures of panel groups."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.fixes.figures import as_part
from mmrs_core.contributions.fixes import Edit, Fix, Wrong, with_value
from mmrs_core.grounding.features import number
from mmrs_solar.figure_checks import OVERLAPS


def _azimuth_in_the_circle(wrong: Wrong) -> Iterator[Edit]:
    """Yield an azimuth that counts anticlockwise, or beyond the circle, as one from 0 to 360."""
    found = number(wrong.element, "azimuth") if wrong.element is not None else None
    attribute = wrong.tag.attribute("azimuth")
    if attribute is not None and found is not None and not 0.0 <= found <= 360.0 and abs(found) <= 720.0:
        yield with_value(attribute, f"{found % 360.0:.12g}")


FIXES = (
    Fix("SOL002", "write the azimuth clockwise from north", _azimuth_in_the_circle),
    Fix("SOL007", "write the overlaps as parts of one", as_part(*OVERLAPS)),
)
