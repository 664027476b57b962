"""Places that lie apart from all others, so that they are hardly meant."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mmrs_core.analysis.constraints.findings import CONTEXT, MISSION, finding
from mmrs_core.analysis.constraints.outliers import BOTH_SIGNS, EAST_SIGN, EXCHANGED, NORTH_SIGN, Rival, Stray
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.grounding.features import number
from mmrs_core.grounding.frame import is_geographic
from mmrs_core.languages.element import Element, root_of
from mmrs_core.languages.modelset import ModelSet

_READ = (EXCHANGED, NORTH_SIGN, EAST_SIGN)


def _misread(reading: str, words: str) -> Callable[[Element, ModelSet], Iterator[Finding]]:
    """Return what finds elements that one other reading of their figures puts among all others."""

    def check(mission: Element, models: ModelSet) -> Iterator[Finding]:
        for stray in sketch_of(models).outliers.strays:
            if stray.reading == reading:
                yield finding(stray.element, f"{_apart(stray)}; {words}")

    return check


def _apart(stray: Stray) -> str:
    element = stray.element
    if not is_geographic(element):
        return f"lies {_kilometres(stray.apart)} from all other places"
    north, east = number(element, "latitude") or 0.0, number(element, "longitude") or 0.0
    return f"latitude {north:g} and longitude {east:g} lie {_kilometres(stray.apart)} from all other places"


def _kilometres(metres: float) -> str:
    return f"{metres / 1000:.0f} km"


def _astray(mission: Element, models: ModelSet) -> Iterator[Finding]:
    outliers = sketch_of(models).outliers
    for stray in outliers.strays:
        if stray.reading not in _READ:
            both = "; with the other signs, it lies among them" if stray.reading == BOTH_SIGNS else ""
            yield finding(stray.element, f"{_apart(stray)}{both}")
    yield from (_rivalry(each) for each in outliers.rivals if not _is_context(each))


def _elsewhere(context: Element, models: ModelSet) -> Iterator[Finding]:
    yield from (_rivalry(each) for each in sketch_of(models).outliers.rivals if _is_context(each))


def _is_context(rival: Rival) -> bool:
    return all(each.hand == "context" for each in rival.owners)


def _rivalry(rival: Rival) -> Finding:
    first, more = rival.owners[0].element, len(rival.owners) - 1
    others = f" and {more} more of this file lie" if more else " lies"
    hint = "see which of them are right, and correct the others" + (
        "; latitude and longitude may be exchanged in one of the two" if rival.exchanged else ""
    )
    reported = (
        "its places lie" if rival.whole else f"it{others}"
    ) + f" {_kilometres(rival.apart)} from the others, and nothing tells which are right"
    return finding(root_of(first) if rival.whole else first, reported, f"{hint}; {_MEANT}")


_MEANT = "if this is meant, give the mission a largestGap in metres"
_ASTRAY = f"check latitude and longitude, and their signs; {_MEANT}"

CONSTRAINTS = (
    Constraint(
        "MML027",
        "Latitude and longitude are not exchanged.",
        (MISSION, "Mission"),
        _misread(EXCHANGED, "exchanged with each other, its latitude and longitude lie among them"),
        f"latitude is the one that grows to the north; {_MEANT}",
    ),
    Constraint(
        "MML028",
        "The places of a mission and its context lie together.",
        (MISSION, "Mission"),
        _astray,
        _ASTRAY,
    ),
    Constraint(
        "MML029",
        "Latitudes have the right sign.",
        (MISSION, "Mission"),
        _misread(NORTH_SIGN, "with the other sign, its latitude lies among them"),
        f"north of the equator, latitude is positive; {_MEANT}",
    ),
    Constraint(
        "MML030",
        "Longitudes have the right sign.",
        (MISSION, "Mission"),
        _misread(EAST_SIGN, "with the other sign, its longitude lies among them"),
        f"east of Greenwich, longitude is positive; {_MEANT}",
    ),
    Constraint(
        "CTX008",
        "The context describes the area of the mission.",
        (CONTEXT, "Context"),
        _elsewhere,
        f"check that this is the context of this mission; {_MEANT}",
    ),
)
