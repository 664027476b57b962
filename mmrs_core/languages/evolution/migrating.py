"""Takes the tree of an older model through the steps that lead to the installed version."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from mmrs_core.errors import PluginError
from mmrs_core.languages.evolution.migration import Kind, Migration, Refer, Renaming, after
from mmrs_core.languages.json_form.stream import TYPE, is_own
from mmrs_core.languages.json_form.tree import Leaf, Node, Number
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.registry import Registry

_Held = tuple[Node, Feature | None, str]
"""An object, the feature that holds it, and where it stands."""


@dataclass(frozen=True, slots=True)
class Lost:
    """A value that a newer version has no place for: what it said, on which line."""

    feature: str
    value: str
    line: int
    version: str


class Migrating:
    """One model that is migrated as soon as this is created.

    Attributes:
        steps: that were taken, in order.
        lost: every value that was dropped.
        addresses: the objects by where they stood before, as fragments write it.
    """

    def __init__(
        self, roots: Sequence[Node], registry: Registry, languages: Mapping[str, str], file: str
    ) -> None:
        """Take the objects at the top of a model, which change in place.

        Args:
            roots: with types written ``nsURI#Name``, or with a prefix.
            registry: the installed metamodels, and the migrations that lead to them.
            languages: the prefixes, as nsURIs.
            file: what messages call the model.

        Raises:
            PluginError: if the function of a migration fails; says for which element.
        """
        self._file = file
        self.lost: list[Lost] = []
        self.addresses: dict[str, Node] = {}
        self._registry = registry
        self._languages = languages
        self._finals: dict[int, Metaclass] = {}
        used = {self._kind(node)[0] for node in every_node(roots)}
        self._renaming = Renaming({ns: registry.chains[ns] for ns in used if ns in registry.chains})
        self.steps = self._renaming.steps
        for index, root in enumerate(roots):
            self._enter(root, f"/{index}" if len(roots) > 1 else "/")
        for step in self.steps:
            for node in list(every_node(roots)):
                self._take(step, node)
            if step.rewrite_holder is not None:
                self._rewrite_holders(step.rewrite_holder, step.to_uri, roots)

    def _kind(self, node: Node) -> Kind:
        return class_of(node, self._languages)

    def _enter(self, root: Node, address: str) -> None:
        """Find out of what class every object is and will be, and write down the first of these."""
        pending: list[_Held] = [(root, None, address)]
        while pending:
            node, held_by, address = pending.pop()
            self.addresses[address] = node
            final = self._final(node, held_by)
            if final is not None:
                self._finals[id(node)] = final
            is_foreign = self._is_foreign(node)
            for key, value in list(node.members.items()):
                if is_own(key):
                    continue
                feature = self._feature(node, final, key)
                node.members[key] = arranged = value if is_foreign else _arranged(value, feature)
                pending += _addressed(arranged, feature, f"{address}/@{key}")

    def _is_foreign(self, node: Node) -> bool:
        """Return whether an object is of, or inside, an unknown language; it stays as it is."""
        ns_uri, _ = self._kind(node)
        return not self._registry.has(ns_uri) and ns_uri not in self._registry.chains

    def _final(self, node: Node, held_by: Feature | None) -> Metaclass | None:
        kind = self._kind(node)
        if not kind[0] and held_by is not None and isinstance(held_by.type, Metaclass):
            if "$ref" in node.members:
                return None
            kind = self._renaming.first(held_by.type.key)
        if kind[0]:
            node.members = {TYPE: "#".join(kind), **{k: v for k, v in node.members.items() if k != TYPE}}
        ns_uri, name = self._renaming.last(kind)
        if not self._registry.has(ns_uri):
            return None
        return next((each for each in self._registry.package(ns_uri).metaclasses if each.name == name), None)

    def _feature(self, node: Node, final: Metaclass | None, key: str) -> Feature | None:
        if final is None:
            return None
        return final.by_name.get(self._renaming.feature(key, self._kind(node), final))

    def _take(self, step: Migration, node: Node) -> None:
        kind, final = self._kind(node), self._finals.get(id(node))
        features = self._renaming.meant(step.features, step, kind, final)
        values = self._renaming.meant(step.values, step, kind, final)
        dropped = self._renaming.meant(dict.fromkeys(step.dropped, True), step, kind, final)
        if features or values or dropped:
            self._lose(step, node, dropped)
            node.members = {
                features.get(key, key): _exchanged(value, values.get(key, {}))
                for key, value in node.members.items()
                if key not in dropped
            }
        if kind[0] == step.from_uri:
            node.members[TYPE] = "#".join(after(step, kind))
            if step.rewrite is not None:
                self._rewrite(step.rewrite, node)

    def _rewrite_holders(
        self, rewrite: Callable[[Node, Refer], None], ns_uri: str, roots: Sequence[Node]
    ) -> None:
        """Rewrite the elements of other languages that hold some of the language that was just reached."""
        addresses = {id(node): address for address, node in self.addresses.items()}

        def refer(node: Node) -> Node:
            return Node({"$ref": addresses[id(node)]}, node.line)

        for node in list(every_node(roots)):
            held = {self._kind(each)[0] for each in inside(node)}
            if ns_uri in held and self._kind(node)[0] != ns_uri:
                self._rewrite(lambda holder: rewrite(holder, refer), node)

    def _rewrite(self, rewrite: Callable[[Node], None], node: Node) -> None:
        try:
            rewrite(node)
        except PluginError as fault:
            raise PluginError(f"{fault}; at {self._file}:{node.line}") from fault

    def _lose(self, step: Migration, node: Node, dropped: Mapping[str, bool]) -> None:
        for key in node.members:
            if key in dropped:
                self.lost.append(Lost(key, _shown(node.members[key]), node.line, step.to_uri))


def class_of(node: Node, languages: Mapping[str, str]) -> Kind:
    """Return the class that an object says it is of; two empty texts where it does not.

    Args:
        node: the object.
        languages: nsURIs, by the prefixes that types may have.
    """
    claimed = node.members.get(TYPE)
    if not isinstance(claimed, str):
        return "", ""
    if "#" in claimed:
        ns_uri, _, name = claimed.rpartition("#")
        return ns_uri, name.removeprefix("//")
    prefix, _, name = claimed.rpartition(":")
    return languages.get(prefix, ""), name


def _addressed(value: object, feature: Feature | None, lead: str) -> Iterator[_Held]:
    if isinstance(value, Node):
        yield value, feature, lead
    elif isinstance(value, list):
        for index, each in enumerate(value):
            if isinstance(each, Node):
                yield each, feature, f"{lead}.{index}"


def _arranged(value: object, feature: Feature | None) -> object:
    """Return a value as JSON states it for that feature: XMI does not show what is a list or an object."""
    values = [_plain(each, feature) for each in (value if isinstance(value, list) else [value])]
    if feature is None:
        return values if isinstance(value, list) else values[0]
    if feature.many and isinstance(value, list):
        return values
    return values[0] if len(values) == 1 else values


def _plain(value: object, feature: Feature | None) -> object:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Leaf) and feature is not None and feature.containment and not value.strip():
        return Node({}, value.line)
    return value


def _exchanged(value: object, table: Mapping[str, str]) -> object:
    if isinstance(value, list):
        return [_exchanged(each, table) for each in value]
    if isinstance(value, str) and value in table:
        new = table[value]
        return Number(new) if isinstance(value, Number) else new
    return value


def _shown(value: object) -> str:
    if isinstance(value, Node):
        return value.kind or "an element"
    if isinstance(value, list):
        return ", ".join(_shown(each) for each in value)
    return str(value)


def every_node(roots: Sequence[Node]) -> Iterator[Node]:
    """Yield all objects, outer ones before inner ones."""
    pending = list(roots)[::-1]
    while pending:
        node = pending.pop()
        yield node
        pending.extend(inside(node)[::-1])


def inside(node: Node) -> list[Node]:
    """Return the objects that stand directly in another."""
    said = (value if isinstance(value, list) else [value] for value in node.members.values())
    return [each for values in said for each in values if isinstance(each, Node)]
