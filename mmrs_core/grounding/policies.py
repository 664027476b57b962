"""What robots do about faults, as models declare it."""

from __future__ import annotations

from mmrs_core.grounding.values import children, literal, number
from mmrs_core.languages.element import Element
from mmrs_core.scene import Policy
from mmrs_runtime.policies import EVENTS, RESPONSES


def policies_of(element: Element) -> tuple[Policy, ...]:
    """Return the policies that a mission, robot type, robot or transition declares."""
    return tuple(
        Policy(
            literal(each, "event", EVENTS, "LINK_LOST"),
            literal(each, "response", RESPONSES, "HOLD"),
            number(each, "after"),
        )
        for each in children(element, "policies")
    )
