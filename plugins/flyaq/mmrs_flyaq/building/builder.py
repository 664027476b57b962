"""From nodes to elements of our languages, rule by rule; what has to wait is noted in the draft."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.building.attributes import Attributes, is_given
from mmrs_flyaq.building.borders import border_around, without_repeats
from mmrs_flyaq.building.drafts import Draft, copied, placed, put
from mmrs_flyaq.building.robot_types import RobotTypes
from mmrs_flyaq.findings import Category, Record
from mmrs_flyaq.rules.mapping import DialectMapping, Rule, Use
from mmrs_flyaq.rules.paths import reach
from mmrs_flyaq.rules.values import said
from mmrs_flyaq.sources.nodes import STRAY, Link, SourceNode
from mmrs_flyaq.sources.structure import Sort, Structure

_ORDER = {Sort.ATTRIBUTE: 0, Sort.REFERENCE: 1, Sort.CONTAINED: 2}
_NO_RULE = "the mapping has no rule for this class"
_NO_USE = "the mapping has no rule for this feature"
_NO_FEATURE = "the metamodel has no such feature"
_STRAY = "text where only elements may stand"


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
        self._record = record
        self._attributes = Attributes(self.draft, types, record)
        self._referred: set[SourceNode] = set()

    def build(self, roots: Sequence[SourceNode]) -> Draft:
        """Return what the nodes at the top of a document become, and all in them."""
        self._referred = {
            link.target
            for root in roots
            for node in root.inside()
            for values in node.values.values()
            for link in values
            if isinstance(link, Link) and link.target is not None
        }
        made = (self._element(root, "") for root in roots)
        self.draft.roots += [element for element in made if element is not None]
        return self.draft

    def _element(self, node: SourceNode, variant: str) -> Element | None:
        """Return the element that a node becomes; None for one that becomes none, which is recorded."""
        rule = self._mapping.rule(node.kind, variant, self._structure)
        reason = _NO_RULE if rule is None else rule.drop or (node not in self._referred and rule.unreferred)
        if rule is None or reason or (rule.to is None and rule.wait is None):
            self._record.element(Category.LOST, reason or _NO_RULE, node)
            return None
        if rule.wait is not None:
            self.draft.waits.append((node, rule))
        if rule.to is None:
            return None
        element = placed(self._registry.create(*rule.to), node)
        if not self._has_device(node, element, rule):
            return None
        self.draft.made[node] = element
        self._fill(node, element, rule)
        if rule.ring is not None:
            self.draft.rings.append((node, rule))
        return element

    def _has_device(self, node: SourceNode, element: Element, rule: Rule) -> bool:
        if rule.device is None:
            return True
        use = self._mapping.uses(node.kind, rule, self._structure).get(rule.device.action, Use())
        return self._attributes.find_device(node, element, rule.device, use)

    def _fill(self, node: SourceNode, element: Element, rule: Rule) -> None:
        if rule.changed:
            self._record.element(Category.CHANGED, rule.changed, node)
        for path, value in rule.set.items():
            put(element, path, value)
            self._record.element(Category.DEFAULTED, f"{path} is {said(value)} for all of this class", node)
        uses = self._mapping.uses(node.kind, rule, self._structure)
        for feature in self._in_order(node, uses):
            use = uses.get(feature)
            if feature in node.values and self._structure.feature(node.kind, feature) is None:
                reason = _STRAY if feature == STRAY else _NO_FEATURE
                self._record.value(Category.LOST, reason, node, feature)
            elif use is None:
                self._record.value(Category.LOST, _NO_USE, node, feature)
            else:
                self._use(node, feature, element, use)

    def _in_order(self, node: SourceNode, uses: Mapping[str, Use]) -> list[str]:
        """Return the features to go through: attributes first, then what is contained, copies of it last."""
        known = {feature.name: feature.sort for feature in self._structure.features(node.kind)}
        names = [name for name in known if name in uses or name in node.values]
        names.sort(key=lambda name: _ORDER[known[name]])
        names.sort(key=lambda name: name in uses and bool(uses[name].first_of) and name not in node.values)
        return [*names, *(name for name in dict.fromkeys((*uses, *node.values)) if name not in known)]

    def _use(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        values = node.values.get(feature, [])
        needed = use.given or use.beside
        if not values:
            self._default(node, feature, element, use)
        elif use.drop:
            self._record.value(Category.LOST, use.drop, node, feature)
        elif needed and not is_given(node, needed):
            self._record.value(Category.LOST, f"means nothing without {needed}", node, feature)
        elif use.beside:
            return  # the other feature's use takes care of it
        elif use.bearing or any(isinstance(value, Link) for value in values):
            self.draft.later.append((node, feature, element, use))
        else:
            self._attributes.carry_over(node, feature, element, use)
            self._contain(node, feature, element, use)

    def _default(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        """Give a feature what stands for a value or an element that the source does not have."""
        first = next((self.draft.made.get(each) for each in node.nodes(use.first_of)), None)
        if use.make is not None:
            made = placed(self._registry.create(*use.make.to), node)
            for path, value in use.make.set.items():
                put(made, path, value)
            values = "; ".join(f"{path} {said(value)}" for path, value in use.make.set.items())
            what = f"{metaclass_of(made).name}{values and f' ({values})'}"
            self._record.value(Category.DEFAULTED, f"{feature} is not given: {what}", node, feature)
            self._hold(node, feature, element, use, [made])
        elif first is not None:
            reason = f"{feature} is not given: the first of {use.first_of} is taken"
            self._record.value(Category.DEFAULTED, reason, node, feature)
            self._hold(node, feature, element, use, [placed(copied(first, self._registry), node)])
        else:
            self._attributes.default(node, feature, element, use)
            if use.bearing is not None and use.absent is not None:
                self.draft.later.append((node, feature, element, use))

    # what is contained

    def _contain(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        inner = node.nodes(feature)
        if not inner:
            return
        rule = self._mapping.rule(inner[0].kind, use.rule, self._structure)
        if rule is not None and rule.merge and rule.to is not None:
            if not self._registry.metaclass(*rule.to).accepts(element):
                reason = f"goes into {rule.to[1]}, and this is a {metaclass_of(element).name}"
                self._record.value(Category.LOST, reason, node, feature)
                return
            self._fill(inner[0], element, rule)
            for further in inner[1:]:
                self._record.element(Category.LOST, f"{feature} holds one only, the first", further)
            return
        if use.distinct:
            inner = without_repeats(inner, self._record)
        made: Sequence[Element] = [
            found for each in inner if (found := self._element(each, use.rule)) is not None
        ]
        if use.widen and made:
            made = border_around(node, feature, made, use.widen, self._registry, self._record)
        self._hold(node, feature, element, use, made)

    def _hold(
        self, node: SourceNode, feature: str, element: Element, use: Use, made: Sequence[Element]
    ) -> None:
        """Put new elements where they belong; the first is referred to where they belong elsewhere."""
        outermost = self.draft.outermost(node, element)
        if use.hoist and use.hoist not in metaclass_of(outermost).by_name:
            reason = f"{metaclass_of(outermost).name} has no {use.hoist} to hold it"
            self._record.value(Category.LOST, reason, node, feature)
            return
        owner, target = (
            (outermost, metaclass_of(outermost).feature(use.hoist))
            if use.hoist
            else reach(element, use.to[0])
        )
        fitting = [each for each in made if target.containment and target.type.accepts(each)]
        if len(fitting) < len(made):
            self._record.value(Category.LOST, f"{target.name} does not take it", node, feature)
        if target.many:
            getattr(owner, target.attribute).extend(fitting)
        elif fitting:
            setattr(owner, target.attribute, fitting[0])
            if len(fitting) > 1:
                self._record.value(Category.LOST, f"{target.name} takes one only, the first", node, feature)
        if use.hoist and fitting:
            referring, reference = reach(element, use.to[0])
            if reference.type.accepts(fitting[0]):
                setattr(referring, reference.attribute, fitting[0])
            else:
                self._record.value(Category.LOST, f"{use.to[0]} does not take it", node, feature)
