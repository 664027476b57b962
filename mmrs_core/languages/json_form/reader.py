"""From a tree of JSON objects to elements: all faults reported, references left as texts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Protocol

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import Element, Unknown, label_of
from mmrs_core.languages.json_form.tree import Node, Words, is_text
from mmrs_core.languages.json_form.unknown import kept
from mmrs_core.languages.json_form.values import parsed
from mmrs_core.languages.metaclass import Feature, Metaclass, is_null
from mmrs_core.languages.missing import hint_for
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.references.documents import Draft, Pending
from mmrs_core.languages.registry import Registry

TYPE, ID, REF, ROOTS, LANGUAGES, PLACES = "$type", "$id", "$ref", "$roots", "$languages", "$schemaLocation"
_HEAD = frozenset((LANGUAGES, PLACES, ROOTS, "$schema"))

_HELPED_FAULTS = 200
"""Beyond this many faults nobody reads which name was probably meant, and looking for it takes time."""

_Job = tuple[Node, Element | None, Feature | None]


class Lined(Protocol):
    """A tree of objects, and the lines on which they say what they say."""

    @property
    def file(self) -> str:
        """What messages call the file."""

    @property
    def top(self) -> object:
        """What stands at the top."""

    def line_of(self, node: Node, key: str) -> int:
        """Return the line on which an object says something."""


class JsonReader:
    """Reads one tree into a draft.

    Attributes:
        made: the element that was made of each object, by the object's `id`.
    """

    def __init__(self, tree: Lined, draft: Draft, registry: Registry) -> None:
        self.made: dict[int, Element] = {}
        self._tree = tree
        self._draft = draft
        self._registry = registry
        self._languages: Mapping[str, str] = {}
        self._missing: dict[str, str] = {}

    def read(self) -> None:
        """Make all elements of the file."""
        top = self._tree.top
        if isinstance(top, Node):
            self._languages = self._mapping(top, LANGUAGES)
        jobs: list[_Job] = [(node, None, None) for node in self._roots(top)]
        jobs.reverse()
        while jobs:
            self._element(*jobs.pop(), jobs)

    # the file

    def _roots(self, top: object) -> Iterator[Node]:
        if not isinstance(top, Node):
            self._draft.fault("XMI015", "the file: no model: its top is not an object", 1)
            return
        listed = top.members.get(ROOTS, top if TYPE in top.members else None)
        for key in top.members if ROOTS in top.members else ():
            if key not in _HEAD:
                self._draft.fault("XMI004", f"{key}: not beside {ROOTS}", self._tree.line_of(top, key))
        if listed is None:
            hint = f"say which class it is of by {TYPE}; 'mmrs migrate' reads the JSON of another platform"
            self._draft.fault("XMI015", f"the root: no model: it has no {TYPE}", top.line, hint=hint)
        for node in listed if isinstance(listed, list) else (listed,):
            if isinstance(node, Node):
                yield node
            elif listed is not None:
                message = f"{ROOTS}: takes a list of objects"
                self._draft.fault("XMI010", message, self._tree.line_of(top, ROOTS))

    def _mapping(self, top: Node, key: str) -> Mapping[str, str]:
        found = top.members.get(key, Node({}))
        entries = found.members if isinstance(found, Node) else {"": None}
        if all(is_text(value) for value in entries.values()):
            return {name: str(value) for name, value in entries.items()}
        self._draft.fault("XMI010", f"{key}: takes an object of texts", self._tree.line_of(top, key))
        return {}

    # elements

    def _element(self, node: Node, owner: Element | None, feature: Feature | None, jobs: list[_Job]) -> None:
        metaclass = feature.type if feature is not None and TYPE not in node.members else None
        claimed = node.members.get(TYPE)
        if metaclass is None:
            ns_uri, name = self._claimed(node, owner)
            if not ns_uri:
                return
            if not self._registry.has(ns_uri):
                self._keep(node, ns_uri, name, owner, feature)
                return
            metaclass = self._metaclass(node, ns_uri, name, owner)
        if not isinstance(metaclass, Metaclass):
            return
        if metaclass.implementation is None:
            message = f"{metaclass.name}: abstract; say which kind of it by {TYPE}"
            self._fault("XMI003", message, node, owner)
            return
        if feature is not None and claimed is not None and not _fits(feature, metaclass):
            message = f"{metaclass.name}: not a {feature.type.name}, which {feature.name} takes"
            self._fault("XMI008", message, node, owner, broken=feature)
            return
        element = metaclass.implementation.__new__(metaclass.implementation)
        self._stands(element, node, owner, feature)
        self._members(element, metaclass, node, jobs)

    def _stands(self, element: Element, node: Node, owner: Element | None, feature: Feature | None) -> None:
        self.made[id(node)] = element
        element._mmrs_line = node.line
        element._mmrs_source = self._draft.source
        if owner is None or feature is None:
            self._draft.roots.append(element)
            return
        if feature.many:
            getattr(owner, feature.attribute).put(element)
        else:
            type(owner)._mmrs_slots[feature.attribute].__set__(owner, element)
        element._mmrs_container = owner
        element._mmrs_feature = feature
        opposite = feature.opposite
        if opposite is not None and not isinstance(element, Unknown):
            type(element)._mmrs_slots[opposite.attribute].__set__(element, owner)

    def _claimed(self, node: Node, owner: Element | None) -> tuple[str, str]:
        claimed = node.members.get(TYPE)
        if not is_text(claimed):
            code = "XMI015" if TYPE not in node.members else "XMI010"
            message = f"{TYPE}: the name of a class, such as mission:Mission, is needed"
            self._fault(code, message, node, owner)
            return "", ""
        if "#" in claimed:
            ns_uri, _, name = claimed.rpartition("#")
            return ns_uri, name.removeprefix("//")
        prefix, _, name = claimed.rpartition(":")
        if prefix not in self._languages:
            hint = nearest(prefix, self._languages) or f"say in {LANGUAGES} which language {prefix!r} is"
            message = f"{claimed}: the prefix {prefix!r} is not declared"
            self._fault("XMI014", message, node, owner, hint, key=TYPE)
        return self._languages.get(prefix, ""), name

    def _metaclass(self, node: Node, ns_uri: str, name: str, owner: Element | None) -> Metaclass | None:
        try:
            return self._registry.metaclass(ns_uri, name)
        except ValueError as fault:
            message, _, hint = str(fault).partition("; ")
            self._fault("XMI002", message, node, owner, hint, key=TYPE)
            return None

    def _keep(
        self, node: Node, ns_uri: str, name: str, owner: Element | None, feature: Feature | None
    ) -> None:
        if ns_uri not in self._missing:
            self._missing[ns_uri] = hint_for(ns_uri, self._registry)
        message = f"{ns_uri}: no such metamodel, needed for {name}"
        self._fault("XMI001", message, node, owner, self._missing[ns_uri], key=TYPE)
        try:
            unknown = kept(node, f"{ns_uri}#{name}", self._languages)
        except ValueError as fault:
            raise UnreadableError(f"{self._tree.file}:{node.line}: {fault}") from None
        self._stands(unknown, node, owner, feature)

    # what elements say

    def _members(self, element: Element, metaclass: Metaclass, node: Node, jobs: list[_Job]) -> None:
        children: list[_Job] = []
        head = _HEAD if node is self._tree.top else frozenset()
        for key, value in node.members.items():
            feature = metaclass.by_name.get(key[1:] if key.startswith("$$") else key)
            if key.startswith("$") and not key.startswith("$$"):
                self._own_key(element, metaclass, node, key, head)
            elif feature is None:
                label = label_of(element)
                message = f"{key}: no feature of {metaclass.name}{label and f' {label!r}'}"
                helps = len(self._draft.diagnostics) < _HELPED_FAULTS
                hint = nearest(key, metaclass.by_name) if helps else ""
                self._fault("XMI004", message, node, element, hint, key=key)
            elif value == [] or (value is None and feature.is_reference):
                if feature.unsettable:
                    self._draft.source.blanks.add((element, feature))
            elif not feature.is_reference:
                self._values(element, feature, node, key, value)
            else:
                self._references(element, feature, node, key, value, children)
        jobs.extend(reversed(children))

    def _own_key(
        self, element: Element, metaclass: Metaclass, node: Node, key: str, head: frozenset[str]
    ) -> None:
        if key == ID:
            identifier = node.members[ID]
            if is_text(identifier) and identifier:
                self._identify(element, node, identifier, own=False)
            else:
                self._fault("XMI010", f"{ID}: takes a text", node, element, key=key)
        elif key != TYPE and key not in head:
            message = f"{key}: no key of this form, and no feature of {metaclass.name}"
            self._fault("XMI004", message, node, element, nearest(key, (TYPE, ID, REF)), key=key)

    def _values(self, element: Element, feature: Feature, node: Node, key: str, value: object) -> None:
        if feature.many:
            values = value if isinstance(value, list) else _parts(value)
        elif isinstance(value, list) and len(value) == 1:
            values = value
        elif isinstance(value, list):
            message = f"{feature.name}: a list of {len(value)} values, takes one"
            self._fault("XMI009", message, node, element, broken=feature, key=key)
            return
        else:
            values = [value]
        for each in values:
            self._value(element, feature, node, key, each)

    def _value(self, element: Element, feature: Feature, node: Node, key: str, value: object) -> None:
        kind = feature.type
        assert not isinstance(kind, Metaclass)  # it is an attribute
        if is_null(feature, value):
            getattr(element, feature.attribute).append(None)
            return
        if value is None:
            if feature.many or getattr(kind, "primitive", True):
                self._fault("XMI005", f"{feature.name}: cannot be null", node, element, "", feature, key)
            elif feature.default is not None:
                type(element)._mmrs_slots[feature.attribute].__set__(element, None)
            elif feature.unsettable:
                self._draft.source.blanks.add((element, feature))
            return
        try:
            found = parsed(kind, value)
        except ValueError as fault:
            self._fault("XMI005", f"{feature.name}: {fault}", node, element, "", feature, key)
            return
        if feature.many:
            getattr(element, feature.attribute).append(found)
        else:
            type(element)._mmrs_slots[feature.attribute].__set__(element, found)
        if feature.is_id:
            self._identify(element, node, str(value), own=True)

    def _references(
        self, element: Element, feature: Feature, node: Node, key: str, value: object, children: list[_Job]
    ) -> None:
        values = value if isinstance(value, list) else [] if value is None else [value]
        if len(values) > 1 and not feature.many:
            message = f"{feature.name}: a list of {len(values)}, takes one"
            self._fault("XMI009", message, node, element, broken=feature, key=key)
            return
        for each in values:
            uri = each.members[REF] if isinstance(each, Node) and set(each.members) == {REF} else each
            if isinstance(uri, Node) and feature.containment:
                children.append((uri, element, feature))
            elif is_text(uri) and (uri is not each or not feature.containment):
                line = each.line if isinstance(each, Node) else self._tree.line_of(node, key)
                self._draft.pending.append(Pending(element, feature, uri, line))
            else:
                wanted = "objects" if feature.containment else "the paths of elements, such as //@tasks.0"
                self._fault("XMI010", f"{feature.name}: takes {wanted}", node, element, "", feature, key)

    def _identify(self, element: Element, node: Node, identifier: str, own: bool) -> None:
        other = self._draft.ids.setdefault(identifier, element)
        if other is not element:
            message = f"{identifier}: an id used twice; first on line {other._mmrs_line}"
            self._fault("XMI012", message, node, element)
        elif not own:
            self._draft.source.ids[element] = identifier

    def _fault(
        self,
        code: str,
        message: str,
        node: Node,
        element: Element | None,
        hint: str = "",
        broken: Feature | None = None,
        key: str = "",
    ) -> None:
        line = self._tree.line_of(node, key) if key else node.line
        self._draft.fault(code, message, line, element, hint)
        if element is not None and broken is not None:
            self._draft.broken.add((element, broken.name))


def _fits(feature: Feature, metaclass: Metaclass) -> bool:
    kind, made = feature.type, metaclass.implementation
    # by interface, since every element is an EObject, though no metamodel says so
    return isinstance(kind, Metaclass) and made is not None and issubclass(made, kind.interface)


def _parts(value: object) -> list[object]:
    return list(value.split()) if isinstance(value, Words) else [value]
