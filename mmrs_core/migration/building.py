"""From nodes to elements of our languages, rule by rule; what has to wait is handed on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from mmrs_core.languages.element import Element, held, label_of, metaclass_of
from mmrs_core.languages.grounding.values import number
from mmrs_core.languages.metaclass import Feature
from mmrs_core.languages.registry import Registry
from mmrs_core.migration.converting import number_in, put, scaled
from mmrs_core.migration.findings import Category
from mmrs_core.migration.mapping import Constant, DialectMapping, Rule, Use
from mmrs_core.migration.nodes import Link, Node, Text
from mmrs_core.migration.paths import reach
from mmrs_core.migration.recording import Record
from mmrs_core.migration.robot_types import RobotTypes
from mmrs_core.migration.shapes import widened
from mmrs_core.migration.structure import Sort, Structure

_ORDER = {Sort.ATTRIBUTE: 0, Sort.REFERENCE: 1, Sort.CONTAINED: 2}
_NO_RULE = "the mapping has no rule for this class"
_NO_USE = "the mapping does not say what becomes of this feature"
_NO_FEATURE = "the metamodel has no such feature"


@dataclass(slots=True, eq=False)
class Draft:
    """A model on its way.

    Attributes:
        roots: the elements at its top.
        made: what each node became.
        later: the uses that have to wait until every element stands: (node, feature, element, use).
        waits: the nodes that become conditions of transitions, with their rules.
        rings: the nodes that become way points around a circle, with their rules.
    """

    roots: list[Element] = field(default_factory=list)
    made: dict[Node, Element] = field(default_factory=dict)
    later: list[tuple[Node, str, Element, Use]] = field(default_factory=list)
    waits: list[tuple[Node, Rule]] = field(default_factory=list)
    rings: list[tuple[Node, Rule]] = field(default_factory=list)

    def around(self, node: Node) -> Iterator[Element]:
        """Yield the elements made of the nodes around a node, nearest first."""
        above = node.parent
        while above is not None:
            if above in self.made:
                yield self.made[above]
            above = above.parent


class Builder:
    """Builds the elements of one document.

    Attributes:
        draft: what is built so far.
    """

    def __init__(
        self,
        mapping: DialectMapping,
        structure: Structure,
        registry: Registry,
        types: RobotTypes,
        record: Record,
    ) -> None:
        self.draft = Draft()
        self._mapping = mapping
        self._structure = structure
        self._registry = registry
        self._types = types
        self._record = record

    def root(self, node: Node) -> None:
        """Build what a node at the top of a document becomes."""
        made = self._build(node, "")
        if made is not None:
            self.draft.roots.append(made)

    def _build(self, node: Node, variant: str) -> Element | None:
        """Return the element that a node becomes; None for one that becomes none, which is recorded."""
        rule = self._mapping.rule(node.kind, variant, self._structure)
        if rule is None or rule.drop:
            self._record.element(Category.LOST, rule.drop if rule else _NO_RULE, node)
            return None
        if rule.wait is not None:
            self.draft.waits.append((node, rule))
        if rule.to is None:
            return None
        element = self._registry.create(*rule.to)
        if rule.device is not None and not self._device(node, element, rule):
            return None
        self.draft.made[node] = element
        self._fill(node, element, rule)
        if rule.ring is not None:
            self.draft.rings.append((node, rule))
        return element

    def _fill(self, node: Node, element: Element, rule: Rule) -> None:
        if rule.changed:
            self._record.element(Category.CHANGED, rule.changed, node)
        for path, value in rule.set.items():
            put(element, path, value)
        uses = self._mapping.uses(node.kind, rule, self._structure)
        for feature in self._in_order(node, uses):
            use = uses.get(feature)
            if self._structure.feature(node.kind, feature) is None:
                self._record.value(Category.LOST, _NO_FEATURE, node, feature)
            elif use is None:
                self._record.value(Category.LOST, _NO_USE, node, feature)
            else:
                self._use(node, feature, element, use)

    def _in_order(self, node: Node, uses: Mapping[str, Use]) -> list[str]:
        """Return the features to go through: attributes first, what is contained last."""
        known = {feature.name: feature.sort for feature in self._structure.features(node.kind)}
        names = [name for name in known if name in uses or name in node.values]
        names.sort(key=lambda name: _ORDER[known[name]])
        return [*names, *(name for name in node.values if name not in known)]

    def _use(self, node: Node, feature: str, element: Element, use: Use) -> None:
        values = node.values.get(feature, [])
        if not values:
            self._default(node, feature, element, use)
        elif use.drop:
            self._record.value(Category.LOST, use.drop, node, feature)
        elif not all(node.values.get(other) for other in (use.given, use.beside) if other):
            reason = f"means nothing without {use.given or use.beside}"
            self._record.value(Category.LOST, reason, node, feature)
        elif use.beside:
            return  # the other feature's use takes care of it
        elif use.bearing or any(isinstance(value, Link) for value in values):
            self.draft.later.append((node, feature, element, use))
        else:
            self._texts(node, feature, element, use)
            self._contain(node, feature, element, use)

    # attributes

    def _texts(self, node: Node, feature: str, element: Element, use: Use) -> None:
        values = [value for value in node.values[feature] if isinstance(value, Text)]
        for value in values:
            try:
                self._text(node, feature, value, element, use)
            except ValueError as fault:
                self._record.value(Category.LOST, str(fault), node, feature, value)

    def _text(self, node: Node, feature: str, value: Text, element: Element, use: Use) -> None:
        if value.text in use.void or (_is_zero(value.text) and "0" in use.void):
            self._record.value(
                Category.DOUBTFUL, use.changed or "stands for 'not known'", node, feature, value
            )
            return
        if use.below and not self._is_below(node, value, use):
            reason = f"is not below {use.below}, so only that is carried over"
            self._record.value(Category.DOUBTFUL, reason, node, feature, value)
            return
        text = scaled(self._renamed(node, feature, value, use), use.times)
        text = self._unique(node, feature, text, element, use)
        for path in use.to:
            put(element, path, text)
        if use.changed and not use.void:
            self._record.value(Category.CHANGED, use.changed, node, feature, value)

    def _is_below(self, node: Node, value: Text, use: Use) -> bool:
        other = node.text(use.below)
        return not other or number_in(value.text) < number_in(other)

    def _renamed(self, node: Node, feature: str, value: Text, use: Use) -> str:
        text = use.values.get(value.text, value.text)
        if text != value.text:
            self._record.value(
                Category.CHANGED, f"{value.text!r} is called {text!r} here", node, feature, value
            )
        if not use.robot_type:
            return text
        name, told = self._types.resolved(text)
        if told:
            self._record.value(Category.DOUBTFUL, told, node, feature, value)
        return name

    def _unique(self, node: Node, feature: str, text: str, element: Element, use: Use) -> str:
        """Return a text that no sibling has: the text itself, or with a number behind it."""
        if not use.unique or node.parent is None:
            return text
        near = [self.draft.made[each] for each in node.parent.nodes(node.feature) if each in self.draft.made]
        taken = {label_of(each) for each in near if each is not element}
        number, found = 2, text
        while found in taken:
            number, found = number + 1, f"{text}_{number}"
        if found != text:
            self._record.value(
                Category.CHANGED, f"{text!r} is taken already; called {found!r}", node, feature
            )
        return found

    def _default(self, node: Node, feature: str, element: Element, use: Use) -> None:
        if use.absent is None or use.drop:
            return
        value: Constant = use.absent
        if isinstance(value, str):
            words = {name: node.text(name) for name in node.values}
            value = value.format_map({"number": node.index + 1, **words})
            value = self._unique(node, feature, value, element, use)
        for path in use.to:
            put(element, path, value)
        reason = use.changed or f"{feature} is not given"
        self._record.value(Category.DEFAULTED, f"{reason}: {_shown(value)}", node, feature)

    def _device(self, node: Node, element: Element, rule: Rule) -> bool:
        """Find the device that does an action; return whether there is one."""
        assert rule.device is not None  # asked before
        use = self._mapping.use(node.kind, rule, rule.device.action, self._structure) or Use()
        said = node.text(rule.device.action)
        action = use.values.get(said, said)
        named = (getattr(each, "typeName", None) for each in self.draft.around(node))
        type_name = next((name for name in named if name), "")
        device = self._types.device_for(type_name, action)
        if device:
            put(element, rule.device.to, device)
            return True
        reason = f"no single device of the robot type {type_name!r} is known to do {action!r}"
        self._record.element(Category.LOST, f"{reason}: add it to the type, and the action to the move", node)
        return False

    # elements

    def _contain(self, node: Node, feature: str, element: Element, use: Use) -> None:
        inner = node.nodes(feature)
        if not inner:
            return
        rule = self._mapping.rule(inner[0].kind, use.rule, self._structure)
        if rule is not None and rule.merge:
            self._fill(inner[0], element, rule)
            return
        if use.distinct:
            inner = self._without_repeats(node, feature, inner)
        outermost = [element, *self.draft.around(node)][-1] if use.hoist else element
        owner, target = reach(outermost, use.hoist or use.to[0])
        made = [found for each in inner if (found := self._build(each, use.rule)) is not None]
        self._hold(node, feature, owner, target, made)
        if use.hoist and made:
            setattr(element, metaclass_of(element).feature(use.to[0]).attribute, made[0])
        if use.widen and made:
            self._widen(node, feature, owner, target, use)

    def _hold(
        self, node: Node, feature: str, owner: Element, target: Feature, made: Sequence[Element]
    ) -> None:
        if target.many:
            getattr(owner, target.attribute).extend(made)
        elif made:
            setattr(owner, target.attribute, made[0])
            if len(made) > 1:
                self._record.value(Category.LOST, f"{target.name} takes one only, the first", node, feature)

    def _without_repeats(self, node: Node, feature: str, inner: tuple[Node, ...]) -> tuple[Node, ...]:
        """Return nodes without those whose texts equal the one before, the first following the last."""
        marks = [{name: each.texts(name) for name in each.values} for each in inner]
        kept = tuple(
            each for index, each in enumerate(inner) if index == 0 or marks[index] != marks[index - 1]
        )
        if len(kept) > 1 and marks[0] == marks[inner.index(kept[-1])]:
            kept = kept[:-1]
        if len(kept) < len(inner):
            reason = "vertices that repeat the one before are left out"
            self._record.value(
                Category.CHANGED, reason, node, feature, Text(str(len(inner) - len(kept)), node.line)
            )
        return kept

    def _widen(self, node: Node, feature: str, owner: Element, target: Feature, use: Use) -> None:
        """Replace a border that holds no area by one around it."""
        found = [each for each in held(owner, target) if isinstance(each, Element)]
        places = [(number(each, "latitude"), number(each, "longitude")) for each in found]
        known = tuple((north, east) for north, east in places if north is not None and east is not None)
        ring = widened(known, use.widen) if known else None
        if ring is None:
            return
        key = metaclass_of(found[0]).key
        corners = [self._registry.create(*key, latitude=north, longitude=east) for north, east in ring]
        getattr(owner, target.attribute)[:] = corners
        reason = (
            f"the border holds no area, so it is drawn {use.widen:g} m around its vertices: draw it as it is"
        )
        self._record.value(
            Category.DOUBTFUL, reason, node, feature, Text(f"of {len(known)} vertices", node.line)
        )


def _is_zero(text: str) -> bool:
    try:
        return float(text) == 0.0
    except ValueError:
        return False


def _shown(value: Constant) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
