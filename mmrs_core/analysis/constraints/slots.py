"""Slots: who owns them, who sets them, who waits for them."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, called, finding
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, text
from mmrs_core.languages.element import Element, container_of, descendants, is_kind
from mmrs_core.languages.modelset import ModelSet


def _foreign(robot: Element, models: ModelSet) -> Iterator[Finding]:
    own = set(children(robot, "slots"))
    for transition in children(robot, "moveTransitions"):
        for slot in children(transition, "waitFor"):
            if slot not in own:
                owner = container_of(slot)
                whose = f"of {called(owner)}" if owner is not None else "of nobody"
                yield finding(
                    transition, f"waits for the slot {text(slot, 'name')!r} {whose}, which is not its own"
                )


def _nobodys(behaviour: Element, models: ModelSet) -> Iterator[Finding]:
    known = {slot for robot in children(behaviour, "robots") for slot in children(robot, "slots")}
    for notify in _notifies(behaviour):
        for slot in _named(notify):
            if slot not in known:
                yield finding(notify, f"sets the slot {text(slot, 'name')!r}, which no robot here has")


def _useless(behaviour: Element, models: ModelSet) -> Iterator[Finding]:
    awaited = {
        slot
        for robot in children(behaviour, "robots")
        for transition in children(robot, "moveTransitions")
        for slot in children(transition, "waitFor")
    }
    for robot in children(behaviour, "robots"):
        for slot in children(robot, "slots"):
            if slot not in awaited:
                yield finding(slot, f"{called(robot)} never waits for it")


def _notifies(behaviour: Element) -> Iterator[Element]:
    return (each for each in descendants(behaviour) if is_kind(each, BEHAVIOUR, "Notify"))


def _named(notify: Element) -> tuple[Element, ...]:
    single = child(notify, "slot")
    return (*children(notify, "slots"), *([single] if single is not None else []))


CONSTRAINTS = (
    Constraint(
        "BL008",
        "A robot waits for its own slots only.",
        (BEHAVIOUR, "Robot"),
        _foreign,
        "give this robot a slot, and let the other one set it with a notify",
    ),
    Constraint(
        "BL031",
        "A notify sets slots of this behaviour's robots.",
        (BEHAVIOUR, "Behaviour"),
        _nobodys,
        "refer to a slot of one of the robots",
    ),
    Constraint(
        "BL033",
        "Slots are waited for.",
        (BEHAVIOUR, "Behaviour"),
        _useless,
        "let a transition wait for it, or take the slot away",
        Severity.WARNING,
    ),
)
