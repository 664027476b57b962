"""What becomes of the values of attributes, and of those that are missing."""

from __future__ import annotations

import re

from mmrs_core.languages.element import Element, label_of
from mmrs_core.languages.grounding.values import text as text_of
from mmrs_core.migration.building.converting import number_in, put, scaled
from mmrs_core.migration.building.drafts import Draft
from mmrs_core.migration.building.robot_types import RobotTypes
from mmrs_core.migration.findings import Category
from mmrs_core.migration.recording import Record
from mmrs_core.migration.rules.mapping import Constant, DeviceLookup, Use
from mmrs_core.migration.rules.paths import reach
from mmrs_core.migration.sources.nodes import SourceNode, Text

_WORD = re.compile(r"\{(\w+)\}")


class Attributes:
    """Sets attributes of elements as the uses of a mapping say."""

    def __init__(self, draft: Draft, types: RobotTypes, record: Record) -> None:
        self._draft = draft
        self._types = types
        self._record = record

    def carry_over(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        """Carry over every text that a feature holds."""
        values = [value for value in node.values[feature] if isinstance(value, Text)]
        several = bool(use.to) and reach(element, use.to[0])[1].many
        for index, value in enumerate(values):
            try:
                if index and not several:
                    raise ValueError(f"{use.to[0]} takes one only, the first")
                self._one(node, feature, value, element, use)
            except ValueError as fault:
                self._record.value(Category.LOST, str(fault), node, feature, value)

    def default(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        """Set what a feature gets that the source does not say, if it gets anything."""
        if use.absent is None or use.drop:
            return
        value: Constant = use.absent
        if isinstance(value, str):
            value = _WORD.sub(lambda word: _word(node, word[1]), value)
            value = self._unique(node, feature, value, element, use)
        for path in _paths(node, use):
            put(element, path, value)
        said = str(value).lower() if isinstance(value, bool) else str(value)
        reason = use.changed if use.void and use.changed else f"{feature} is not given"
        self._record.value(Category.DEFAULTED, f"{reason}: {said}", node, feature)

    def find_device(self, node: SourceNode, element: Element, lookup: DeviceLookup, use: Use) -> bool:
        """Set the device of the robot's type that does an action; return whether there is one.

        Args:
            use: what becomes of the action's name.
        """
        said = node.text(lookup.action)
        action = use.values.get(said, said)
        type_name = next(
            (name for each in self._draft.around(node) if (name := text_of(each, "typeName"))), ""
        )
        device = self._types.device_for(type_name, action)
        if device:
            put(element, lookup.to, device)
            return True
        reason = f"no single device of the robot type {type_name!r} is known to do {action!r}"
        self._record.element(Category.LOST, f"{reason}: add it to the type, and the action to the move", node)
        return False

    def _one(self, node: SourceNode, feature: str, value: Text, element: Element, use: Use) -> None:
        if _is_void(value.text, use):
            self._doubt(use.changed or "stands for 'not known'", node, feature, value)
            self.default(node, feature, element, use)
        elif use.below and not _is_below(node, value, use):
            self._doubt(f"is not below {use.below}, so only that is carried over", node, feature, value)
        else:
            text = scaled(self._renamed(node, feature, value, use), use.times)
            text = self._unique(node, feature, text, element, use)
            for path in _paths(node, use):
                put(element, path, text)
            if use.changed and not use.void:
                self._record.value(Category.CHANGED, use.changed, node, feature, value)

    def _doubt(self, reason: str, node: SourceNode, feature: str, value: Text) -> None:
        self._record.value(Category.DOUBTFUL, reason, node, feature, value)

    def _renamed(self, node: SourceNode, feature: str, value: Text, use: Use) -> str:
        text = use.values.get(value.text, value.text)
        if text != value.text:
            reason = f"{value.text!r} is called {text!r} here"
            self._record.value(Category.CHANGED, reason, node, feature, value)
        if not use.robot_type:
            return text
        name, told = self._types.resolved(text, use.otherwise)
        if told:
            self._doubt(told, node, feature, value)
        return name

    def _unique(self, node: SourceNode, feature: str, text: str, element: Element, use: Use) -> str:
        """Return a text that no sibling has: the text itself, or with a number behind it."""
        if not use.unique or node.parent is None:
            return text
        made = self._draft.made
        near = [made[each] for each in node.parent.nodes(node.feature) if each in made]
        taken = {label_of(each) for each in near if each is not element}
        number, found = 2, text
        while found in taken:
            number, found = number + 1, f"{text}_{number}"
        if found != text:
            reason = f"{text!r} is taken already, so this one is called {found!r}"
            self._record.value(Category.CHANGED, reason, node, feature)
        return found


def _paths(node: SourceNode, use: Use) -> tuple[str, ...]:
    """Return where a value goes, with the further paths if their condition holds."""
    if use.also is None or not all(is_given(node, feature) for feature in use.also.given):
        return use.to
    return (*use.to, *use.also.to)


def is_given(node: SourceNode, feature: str) -> bool:
    """Return whether a feature holds something other than 0."""
    return any(
        not isinstance(value, Text) or not _is_zero(value.text) for value in node.values.get(feature, ())
    )


def _is_zero(text: str) -> bool:
    try:
        return number_in(text) == 0.0
    except ValueError:
        return False


def _word(node: SourceNode, name: str) -> str:
    return str(node.index + 1) if name == "number" else node.text(name)


def _is_void(text: str, use: Use) -> bool:
    """Return whether a text means that nothing is known; numbers count by their value."""
    try:
        return any(number_in(text) == number_in(void) for void in use.void)
    except ValueError:
        return text in use.void


def _is_below(node: SourceNode, value: Text, use: Use) -> bool:
    other = node.text(use.below)
    return not other or number_in(value.text) < number_in(other)
