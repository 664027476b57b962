"""What becomes of the values of attributes, and of those that are missing."""

from __future__ import annotations

from mmrs_core.grounding.features import text as text_of
from mmrs_core.languages.element import Element, metaclass_of
from mmrs_flyaq.building.drafts import Draft, number_in, placed, put, scaled
from mmrs_flyaq.building.robot_types import RobotTypes
from mmrs_flyaq.findings import Category, Record
from mmrs_flyaq.rules.mapping import Constant, DeviceLookup, Use
from mmrs_flyaq.rules.paths import FeaturePath, Keep, reach
from mmrs_flyaq.rules.sense import NUMBER, WORD
from mmrs_flyaq.rules.values import said
from mmrs_flyaq.sources.nodes import SourceNode, Text

_FURTHER = "what is said once stands for further places, too"


class Attributes:
    """Sets attributes of elements as the uses of a mapping say."""

    def __init__(self, draft: Draft, types: RobotTypes, record: Record) -> None:
        self._draft = draft
        self._types = types
        self._record = record
        self._taken: dict[tuple[SourceNode, object], set[str]] = {}
        self._numbers: dict[tuple[SourceNode, str], int] = {}

    def carry_over(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        """Carry over every text that a feature holds."""
        values = [value for value in node.values[feature] if isinstance(value, Text)]
        for index, value in enumerate(values):
            try:
                if index and not self._takes_several(node, element, use):
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
            value = WORD.sub(lambda word: _word(node, word[1]), value)
            value = self._unique(node, feature, value, element, use)
        text = Text(said(value), node.line)
        if use.beside or use.bearing is not None:
            self._draft.assumed[node, feature] = text.text
        else:
            try:
                self._put(node, feature, text, element, use, value)
            except ValueError as fault:
                self._record.value(Category.LOST, str(fault), node, feature, text)
                return
        reason = use.changed if use.void and use.changed else f"{feature} is not given"
        self._record.value(Category.DEFAULTED, f"{reason}: {text.text}", node, feature)

    def find_device(self, node: SourceNode, element: Element, lookup: DeviceLookup, use: Use) -> bool:
        """Set the device of the robot's type that does an action; return whether there is one.

        Args:
            use: what becomes of the action's name.
        """
        named = node.text(lookup.action)
        action = use.values.get(named, named)
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
            self._put(node, feature, value, element, use, text)
            changed = use.changed if not use.void else ""
            if changed or use.times != 1.0:
                reason = changed or f"is multiplied by {use.times:g}"
                self._record.value(Category.CHANGED, reason, node, feature, value)

    def _put(
        self, node: SourceNode, feature: str, source: Text, element: Element, use: Use, value: Constant
    ) -> None:
        """Set a value at all its targets, and report the further ones."""
        keep = self._keep(node, element, use)
        for path in use.to:
            put(element, path, value, keep)
        for path in _further(node, use):
            put(element, path, value, keep)
            self._record.value(Category.DEFAULTED, _FURTHER, node, f"{path} from {feature}", source)

    def _keep(self, node: SourceNode, element: Element, use: Use) -> Keep | None:
        """Return what gives elements a place that are made on the way and only referred to."""
        if not use.hoist:
            return None
        root = self._draft.outermost(node, element)
        target = metaclass_of(root).by_name.get(use.hoist)
        if target is None or not target.many:
            raise ValueError(f"{metaclass_of(root).name} has no {use.hoist} to hold it")
        held_by: list[Element] = getattr(root, target.attribute)
        return lambda made: held_by.append(placed(made, node))

    def _takes_several(self, node: SourceNode, element: Element, use: Use) -> bool:
        return bool(use.to) and reach(element, use.to[0], self._keep(node, element, use))[1].many

    def _doubt(self, reason: str, node: SourceNode, feature: str, value: Text) -> None:
        self._record.value(Category.DOUBTFUL, reason, node, feature, value)

    def _renamed(self, node: SourceNode, feature: str, value: Text, use: Use) -> str:
        text = use.values.get(value.text, value.text)
        if text != value.text:
            reason = f"{value.text!r} is called {text!r} here"
            self._record.value(Category.CHANGED, reason, node, feature, value)
        if not use.robot_type:
            return text
        name, reported = self._types.resolved(text, use.otherwise)
        if reported:
            self._doubt(reported, node, feature, value)
        return name

    def _unique(self, node: SourceNode, feature: str, text: str, element: Element, use: Use) -> str:
        """Return a text that no sibling has: the text itself, or with a number behind it."""
        if not use.unique or node.parent is None:
            return text
        beside = [
            self._taken.setdefault((node.parent, group), set())
            for group in (node.feature, metaclass_of(element).key)
        ]
        number, found = self._numbers.get((node.parent, text), 2), text
        while any(found in names for names in beside):
            number, found = number + 1, f"{text}_{number}"
        self._numbers[node.parent, text] = number
        for names in beside:
            names.add(found)
        if found != text:
            reason = f"{text!r} is taken already, so this one is called {found!r}"
            self._record.value(Category.CHANGED, reason, node, feature)
        return found


def _further(node: SourceNode, use: Use) -> tuple[FeaturePath, ...]:
    """Return the further paths that a value goes to, if their condition holds."""
    if use.also is None or not all(is_given(node, feature) for feature in use.also.given):
        return ()
    return use.also.to


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
    return str(node.index + 1) if name == NUMBER else node.text(name)


def _is_void(text: str, use: Use) -> bool:
    """Return whether a text means that nothing is known; numbers count by their value."""
    try:
        return any(number_in(text) == number_in(void) for void in use.void)
    except ValueError:
        return text in use.void


def _is_below(node: SourceNode, value: Text, use: Use) -> bool:
    other = node.text(use.below)
    return not other or number_in(value.text) < number_in(other)
