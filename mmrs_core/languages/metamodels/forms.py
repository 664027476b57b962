"""What EMF reads in .ecore files, brought into the form that pyecore reads.

Each function and each row of a table names one case. What pyecore has no use for (operations, annotations'
contents, anything unknown) is left out; what it cannot hold (keys, the bound -2) is in `Forms`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from collections.abc import Set as AbstractSet
from typing import NoReturn

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE, builtin_type, shown
from mmrs_core.languages.metamodels.ecore_file import FLAGS, WHOLE, EcoreNode
from mmrs_core.languages.metamodels.locating import Address, Directory, Located
from mmrs_core.languages.xmi.escapes import in_attribute
from mmrs_core.languages.xmi.events import XMI, XSI

_WHOLE = re.compile(r"[+-]?[0-9]{1,20}")
_WORDS = {"eClassifiers": "classifier", "eStructuralFeatures": "feature"}
_FEATURE = ("ordered", "unique", "lowerBound", "upperBound", "changeable", "volatile", "transient", "derived")
_ATTRIBUTES = {
    "EPackage": ("name", "nsURI", "nsPrefix"),
    "EClass": ("name", "abstract", "interface"),
    "EEnum": ("name",),
    "EDataType": ("name", "serializable"),
    "EAttribute": ("name", *_FEATURE, "unsettable", "iD"),
    "EReference": ("name", *_FEATURE, "unsettable", "containment", "resolveProxies"),
    "EEnumLiteral": ("name", "value", "literal"),
}
"""What pyecore reads of each kind, beside types and references."""
_BEGIN = f'<xmi:XMI xmlns:xmi="{XMI}" xmlns:xsi="{XSI}" xmlns:ecore="{ECORE}">\n'


class Forms:
    """Files that refer to each other, as the one document that pyecore reads.

    Attributes:
        targets: what each reference in the text leads to, of which kind that must be, and the package and
            the element that refer; the text has their numbers, as in ``k7``.
        supertypes: of each class.
        keys: of each reference that has some.
        names: the true names of what stands under others in the text, because pyecore or Python keeps them
            for something else.
        nodes: the elements of classes and features, for messages.
    """

    def __init__(
        self,
        directory: Directory,
        located: Iterable[Located],
        features: AbstractSet[str],
        literals: AbstractSet[str],
    ) -> None:
        """Take the packages to be loaded, and the names that features and literals cannot have in pyecore."""
        self.targets: list[tuple[Address, str, Located, EcoreNode]] = []
        self.supertypes: dict[Address, tuple[Address, ...]] = {}
        self.keys: dict[Address, tuple[Address, ...]] = {}
        self.names: dict[str, str] = {}
        self.nodes: dict[Address, tuple[Located, EcoreNode]] = {}
        self._directory = directory
        self._located = {id(entry.node): entry for entry in located if entry.node is not None}
        self._reserved = {"eStructuralFeatures": features, "eLiterals": literals}
        self._tokens: dict[tuple[Address, str], str] = {}

    def document(self) -> bytes:
        """Return the text.

        Raises:
            UnreadableError: if a file has content that an .ecore file cannot have.
            PluginError: if a metamodel is referred to that is not at hand.
        """
        tops = [entry for entry in self._located.values() if not entry.parent]
        body = (line for entry in tops for line in self._package(entry, "ecore:EPackage"))
        return "".join((_BEGIN, *body, "</xmi:XMI>")).encode()

    def _package(self, entry: Located, tag: str) -> Iterator[str]:
        node = entry.node
        assert node is not None  # only files are brought into form
        usual = {} if "nsPrefix" in node.attributes else {"nsPrefix": entry.name}
        yield self._begin(tag, node, entry, "EPackage", usual)
        yield from _annotations(node)
        seen: dict[str, EcoreNode] = {}
        for each in node.all("eClassifiers"):
            kind, name = _kind(each, entry, ("EClass", "EEnum", "EDataType")), _needed(each, entry)
            if name in seen:
                before = f"before in line {seen[name].line}"
                _refuse(entry, each, f"{kind} {name} is declared twice, {before}")
            seen[name] = each
            self.nodes[entry.ns_uri, name] = (entry, each)
            yield from getattr(self, f"_{kind}")(each, entry)
        for inner in node.all("eSubpackages"):
            if not inner.get("href"):  # what lies elsewhere is a package of its own
                yield from self._package(self._located[id(inner)], "eSubpackages")
        yield f"</{tag}>\n"

    def _EClass(self, node: EcoreNode, entry: Located) -> Iterator[str]:  # noqa: N802  # named like Ecore's class
        supertypes = self._links(node, entry, "eSuperTypes")
        for generic in node.all("eGenericSuperTypes"):  # without its arguments
            supertypes += self._links(generic, entry, "eClassifier")
        supertypes = list(dict.fromkeys(supertypes))
        self.supertypes[entry.ns_uri, node.get("name")] = tuple(supertypes)
        tokens = " ".join(self._token(above, "EClass", entry, node) for above in supertypes)
        more = {"instanceClassName": _java_class(node)} if _java_class(node) else {}
        more |= {"eSuperTypes": tokens} if tokens else {}
        yield self._begin("eClassifiers", node, entry, "EClass", more)
        yield from _annotations(node)
        for each in node.all("eStructuralFeatures"):
            yield from self._feature(each, node, entry)
        yield "</eClassifiers>\n"

    def _EEnum(self, node: EcoreNode, entry: Located) -> Iterator[str]:  # noqa: N802
        yield self._begin("eClassifiers", node, entry, "EEnum", {})
        yield from _annotations(node)
        for each in node.all("eLiterals"):
            _needed(each, entry)
            yield self._begin("eLiterals", each, entry, "EEnumLiteral", {})
            yield from (*_annotations(each), "</eLiterals>\n")
        yield "</eClassifiers>\n"

    def _EDataType(self, node: EcoreNode, entry: Located) -> Iterator[str]:  # noqa: N802
        usual = {} if "serializable" in node.attributes else {"serializable": "true"}
        more = ({"instanceClassName": _java_class(node)} if _java_class(node) else {}) | usual
        yield self._begin("eClassifiers", node, entry, "EDataType", more)
        yield from (*_annotations(node), "</eClassifiers>\n")

    def _feature(self, node: EcoreNode, owner: EcoreNode, entry: Located) -> Iterator[str]:
        kind, name = _kind(node, entry, ("EAttribute", "EReference")), _needed(node, entry)
        address = (entry.ns_uri, owner.get("name"), name)
        self.nodes[address] = (entry, node)
        target = self._type(node, owner, entry, kind == "EReference")
        wanted = "EClass" if kind == "EReference" else "EDataType"
        more = {"eType": self._token(target, wanted, entry, node)} if target else {}
        opposite = self._links(node, entry, "eOpposite", 2)
        if opposite and kind == "EReference":
            more["eOpposite"] = self._token(opposite[0], "EReference", entry, node)
        if keys := self._links(node, entry, "eKeys", 2):
            self.keys[address] = tuple(keys)
        if "defaultValueLiteral" in node.attributes:
            more["defaultValueLiteral"] = _default(node.get("defaultValueLiteral"), target)
        yield self._begin("eStructuralFeatures", node, entry, kind, more)
        yield from (*_annotations(node), "</eStructuralFeatures>\n")

    def _type(self, node: EcoreNode, owner: EcoreNode, entry: Located, is_reference: bool) -> Address | None:
        """Return the type of a feature: of a generic one, what is left of it without its arguments.

        None where the file says nothing of it, as descriptions of old dialects do.
        """
        if found := self._links(node, entry, "eType"):
            return found[0]
        generic = next(node.all("eGenericType"), None)
        seen: set[int] = set()
        anything = (ECORE, "EObject" if is_reference else "EJavaObject")
        while generic is not None and id(generic) not in seen:
            seen.add(id(generic))
            if direct := self._links(generic, entry, "eClassifier"):
                return direct[0]
            generic = self._bound(generic, owner, entry)
        return anything if seen else None

    def _bound(self, generic: EcoreNode, owner: EcoreNode, entry: Located) -> EcoreNode | None:
        """Return the first bound of the type parameter that a generic type names."""
        assert entry.file is not None
        for uri in entry.file.uris(generic, "eTypeParameter"):
            names = entry.file.named(uri.rpartition("#")[2])
            if names is None:
                _refuse(entry, generic, f"eTypeParameter: {shown(uri)} leads to no element")
            parameters = {each.get("name"): each for each in owner.all("eTypeParameters")}
            if names[-1] not in parameters:
                _refuse(entry, generic, f"{shown(uri)}: no type parameter of {owner.get('name')}")
            return next(parameters[names[-1]].all("eBounds"), None)
        return None

    def _links(self, node: EcoreNode, entry: Located, name: str, wanted: int = 1) -> list[Address]:
        assert entry.file is not None
        found = entry.file.uris(node, name)
        return [self._directory.find(uri, entry, node, wanted, name) for uri in found]

    def _token(self, address: Address, kind: str, entry: Located, node: EcoreNode) -> str:
        if (address, kind) not in self._tokens:
            self._tokens[address, kind] = f"k{len(self.targets)}"
            self.targets.append((address, kind, entry, node))
        return self._tokens[address, kind]

    def _begin(self, tag: str, node: EcoreNode, entry: Located, kind: str, more: dict[str, str]) -> str:
        """Return the begin of an element; `more` is what is worked out, or not as the file has it."""
        found = {name: node.attributes[name] for name in _ATTRIBUTES[kind] if name in node.attributes} | more
        for name, value in found.items():
            found[name] = _sound(name, value, node, entry)
        if found["name"] in self._reserved.get(tag, ()):
            self.names[f"n{len(self.names)}_"] = found["name"]
            found["name"] = f"n{len(self.names) - 1}_"
        stated = "".join(f' {name}="{in_attribute(value)}"' for name, value in found.items())
        kinds = f' xsi:type="ecore:{kind}"' if tag in _WORDS else ""
        return f"<{tag}{kinds}{stated}>\n"


def _annotations(node: EcoreNode) -> Iterator[str]:
    """Yield the annotations of an element, with their details only."""
    for each in node.all("eAnnotations"):
        yield f'<eAnnotations source="{in_attribute(each.get("source"))}">'
        for detail in each.all("details"):
            key, value = in_attribute(detail.get("key")), in_attribute(detail.get("value"))
            yield f'<details key="{key}" value="{value}"/>'
        yield "</eAnnotations>\n"


def _sound(name: str, value: str, node: EcoreNode, entry: Located) -> str:
    """Return a flag or a number in the notation that pyecore reads.

    EMF takes ``TRUE`` and ``+1``; the bound -2 (unspecified) means one value.
    """
    place = f"{entry.file.name if entry.file is not None else ''}:{node.line}"
    if name in FLAGS:
        if value.lower() not in ("true", "false"):
            raise UnreadableError(f"{place}: {name}: {shown(value)}: not true or false")
        return value.lower()
    if name not in WHOLE:
        return value
    if not _WHOLE.fullmatch(value):
        raise UnreadableError(f"{place}: {name}: {shown(value)} is not a whole number")
    if not -(1 << 31) <= int(value) < 1 << 31:
        raise UnreadableError(f"{place}: {name}: {shown(value)} does not fit into 32 bits")
    return "1" if name == "upperBound" and int(value) == -2 else str(int(value))


def _default(text: str, target: Address | None) -> str:
    """Return a default of one of Ecore's types as pyecore reads it: EMF takes ``0x1p3`` and ``1.5d``."""
    kind = builtin_type(*target) if target is not None and target[0] == ECORE else None
    if kind is None:
        return text
    try:
        return kind.render(kind.parse(text))
    except ValueError:  # whoever derives the feature says so
        return text


def _java_class(node: EcoreNode) -> str:
    return node.get("instanceClassName") or node.get("instanceTypeName")


def _kind(node: EcoreNode, entry: Located, known: tuple[str, ...]) -> str:
    space, _, kind = node.get("xsi:type").rpartition(" ")
    if space != ECORE or kind not in known:
        _refuse(entry, node, f"{kind or 'no xsi:type'}: no kind of {_WORDS[node.tag]} ({', '.join(known)})")
    return kind


def _needed(node: EcoreNode, entry: Located) -> str:
    name = node.get("name")
    if not name and node.get("href"):
        _refuse(entry, node, f"{shown(node.get('href'))}: in another file, which is not supported")
    if not name:
        _refuse(entry, node, "name is missing")
    return name


def _refuse(entry: Located, node: EcoreNode, reason: str) -> NoReturn:
    assert entry.file is not None
    entry.file.refuse(node, reason)
