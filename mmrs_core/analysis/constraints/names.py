"""Names that other elements refer to, or that messages must tell apart."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, CONTEXT, MISSION, ROBOT, finding, repeats
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import children, text
from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element, Unknown, descendants, is_set, metaclass_of
from mmrs_core.languages.metaclass import Feature
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.naming import unreadable


def _unique(
    *features: str, key: str = "name", word: str = "name"
) -> Callable[[Element, ModelSet], Iterator[Finding]]:
    """Return what finds elements in features of an owner whose key is already taken."""

    def check(owner: Element, models: ModelSet) -> Iterator[Finding]:
        elements = (each for feature in features for each in children(owner, feature))
        yield from repeats(elements, key, f"the {word}")

    return check


def _policies(owner: Element, models: ModelSet) -> Iterator[Finding]:
    seen: set[str] = set()
    for policy in children(owner, "policies"):
        event = text(policy, "event")
        if event in seen:
            yield finding(policy, f"there is already a policy for {event}")
        seen.add(event)


def _legible(element: Element, models: ModelSet) -> Iterator[Finding]:
    name = text(element, "name")
    if name and (fault := unreadable(name)):
        yield finding(element, f"the name {fault}")


def _legible_parts(robot: Element, models: ModelSet) -> Iterator[Finding]:
    named = [(robot, "id", "identifier"), (robot, "typeName", "name of its type")]
    named += [(move, "name", "name") for move in children(robot, "moves")]
    for element, feature, word in named:
        if (name := text(element, feature)) and (fault := unreadable(name)):
            yield finding(element, f"the {word} {fault}")


def _legible_type(robot: Element, models: ModelSet) -> Iterator[Finding]:
    for element in (robot, *descendants(robot)):
        for feature in () if isinstance(element, Unknown) else ("id", "name", "key"):
            name = text(element, feature)
            if name.strip() and (fault := unreadable(name)):
                yield finding(element, f"the {feature} {fault}")


_RENAME = "give each its own name"
_READABLE = "write a name with something to see, on one line, without tabs or marks that turn the text round"
_ONE_POLICY = "keep one policy for each event"


MAY_BE_EMPTY = ("conditionIdentifier", "description", "value")
"""Features that nothing refers to, or that have a constraint of their own."""


def _empty(root: Element, models: ModelSet) -> Iterator[Finding]:
    for element in (root, *descendants(root)):
        for feature in () if isinstance(element, Unknown) else metaclass_of(element).features:
            if _names(feature) and is_set(element, feature.name) and not text(element, feature.name).strip():
                yield finding(element, f"{feature.name} is empty, but others go by it")


def _names(feature: Feature) -> bool:
    """Return whether a feature is a text that every element of the class has, and needs."""
    kind = feature.type
    one = feature.required and not feature.many
    return one and isinstance(kind, DataType) and kind.python is str and feature.name not in MAY_BE_EMPTY


_GIVE = "write a name or identifier with something to see"


CONSTRAINTS = (
    Constraint("MML002", "Tasks have different names.", (MISSION, "Mission"), _unique("tasks"), _RENAME),
    Constraint(
        "MML003", "Robots of a team have different names.", (MISSION, "Team"), _unique("robots"), _RENAME
    ),
    Constraint(
        "MML008", "A mission has one policy for an event.", (MISSION, "Mission"), _policies, _ONE_POLICY
    ),
    Constraint("MML011", "Names are human-readable.", (MISSION, "NamedElement"), _legible, _READABLE),
    Constraint(
        "CTX002",
        "Areas, corridors and elements of a context have different names.",
        (CONTEXT, "Context"),
        _unique("forbiddenAreas", "obstacles", "emergencyAreas", "corridors", "elements"),
        _RENAME,
        Severity.WARNING,
    ),
    Constraint(
        "RL002",
        "Devices of a robot have different identifiers.",
        (ROBOT, "Robot"),
        _unique("devices", key="id", word="identifier"),
        "give each its own identifier",
    ),
    Constraint(
        "RL031",
        "Names, identifiers and keys of a robot type are human-readable.",
        (ROBOT, "Robot"),
        _legible_type,
        _READABLE,
    ),
    Constraint(
        "RL003",
        "Actions of a device have different names.",
        (ROBOT, "Device"),
        _unique("supportedActions"),
        _RENAME,
    ),
    Constraint(
        "RL004",
        "Parameters of an action have different keys.",
        (ROBOT, "SupportedAction"),
        _unique("parameters", key="key", word="key"),
        "give each its own key",
    ),
    Constraint(
        "RL005",
        "Properties of a device have different keys.",
        (ROBOT, "Device"),
        _unique("properties", word="key"),
        "keep one value for each key",
    ),
    Constraint(
        "RL016", "A robot type has one policy for an event.", (ROBOT, "Robot"), _policies, _ONE_POLICY
    ),
    Constraint(
        "BL010", "Slots of a robot have different names.", (BEHAVIOUR, "Robot"), _unique("slots"), _RENAME
    ),
    Constraint(
        "BL014",
        "Robots of a behaviour have different identifiers.",
        (BEHAVIOUR, "Behaviour"),
        _unique("robots", key="id", word="identifier"),
        "give each its own identifier",
    ),
    Constraint(
        "BL015", "Moves of a robot have different names.", (BEHAVIOUR, "Robot"), _unique("moves"), _RENAME
    ),
    Constraint(
        "BL032",
        "An action gives each parameter one value.",
        (BEHAVIOUR, "Action"),
        _unique("parameters", "payload", key="key", word="key"),
        "keep one value for each key",
    ),
    Constraint("BL048", "A robot has one policy for an event.", (BEHAVIOUR, "Robot"), _policies, _ONE_POLICY),
    Constraint("BL034", "The name of a slot is human-readable.", (BEHAVIOUR, "Slot"), _legible, _READABLE),
    Constraint(
        "BL053",
        "The identifier and type of a robot, and the names of its moves, are human-readable.",
        (BEHAVIOUR, "Robot"),
        _legible_parts,
        _READABLE,
    ),
    Constraint(
        "BL041", "A wait has one policy for an event.", (BEHAVIOUR, "MoveTransition"), _policies, _ONE_POLICY
    ),
    Constraint("MML013", "No required name of a mission is empty.", (MISSION, "Mission"), _empty, _GIVE),
    Constraint("RL028", "No required name of a robot type is empty.", (ROBOT, "Robot"), _empty, _GIVE),
    Constraint("BL051", "No required name of a behaviour is empty.", (BEHAVIOUR, "Behaviour"), _empty, _GIVE),
)
