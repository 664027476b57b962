"""From XMI to elements: one pass over a file, references left as texts."""

from __future__ import annotations

from mmrs_core.diagnostics import Severity
from mmrs_core.languages.element import Element, Unknown, held, label_of
from mmrs_core.languages.links import settle
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass
from mmrs_core.languages.missing import hint_for
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.references.documents import Draft, Pending
from mmrs_core.languages.references.spelling import as_address
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.values.texts import words_of
from mmrs_core.languages.xmi.events import XMI, XSI, Document
from mmrs_core.languages.xmi.unknowns import prefixes_in

_TYPE = f"{XSI} type"
_XMI_TYPE = f"{XMI} type"
_NIL = f"{XSI} nil"
_ID = f"{XMI} id"
_UUID = f"{XMI} uuid"
_IDREF = f"{XMI} idref"
_WRAPPER = f"{XMI} XMI"
HARMLESS = frozenset(
    (_TYPE, _XMI_TYPE, f"{XMI} version", f"{XSI} schemaLocation", f"{XSI} noNamespaceSchemaLocation", _UUID)
)


Frame = tuple[Element, Metaclass, Feature | None]
"""An open XML element: a model element and its metaclass, or a feature's value (then with the feature)."""


class XmiReader:
    """Listens to one document and fills a draft."""

    def __init__(self, document: Document, draft: Draft, registry: Registry) -> None:
        self._document = document
        self._draft = draft
        self._registry = registry
        self._open: list[Frame] = []
        self._text: list[str] = []
        self._ignored = 0
        self._wrapped = False
        self._kept: tuple[Unknown, int] | None = None
        self._nil = False
        self._missing: dict[str, str] = {}
        self._hints: dict[tuple[Metaclass, str], str] = {}

    def start(self, tag: str, attributes: list[str]) -> None:
        """Take the start of an XML element."""
        if self._ignored:
            self._ignored += 1
        elif self._open:
            self._inside(self._open[-1], tag, attributes)
        elif tag == _WRAPPER and not self._wrapped and not self._draft.roots:
            self._wrapped = True
        else:
            self._root(tag, attributes)

    def end(self, tag: str) -> None:
        """Take the end of an XML element."""
        if self._ignored:
            self._ignored -= 1
            if not self._ignored:
                self._keep()
        elif self._open:
            element, _, feature = self._open.pop()
            if feature is not None and not feature.is_reference:
                self._value_ends(element, feature)

    def text(self, text: str) -> None:
        """Take character data."""
        if self._ignored:
            return
        if self._open and self._open[-1][2] is not None:
            self._text.append(text)
        elif not text.isspace():
            self._fault("XMI010", f"{text.strip()[:40]!r}: text where only elements may stand")

    # the kinds of XML element

    def _root(self, tag: str, attributes: list[str]) -> None:
        ns_uri, _, name = tag.rpartition(" ")
        if ns_uri == XMI and self._wrapped:
            self._ignore(f"xmi:{name}")
            return
        metaclass = self._metaclass(ns_uri, name)
        element = self._make(metaclass, f"{ns_uri}#{name}")
        self._draft.roots.append(element)
        if metaclass is not None and not isinstance(element, Unknown):
            self._open.append((element, metaclass, None))
            self._attributes(element, metaclass, attributes)

    def _inside(self, frame: Frame, tag: str, attributes: list[str]) -> None:
        element, metaclass, open_feature = frame
        if open_feature is not None:
            message = f"{tag}: an element inside a value of {open_feature.name}"
            self._fault("XMI010", message, element, broken=open_feature)
            self._ignored = 1
            return
        feature = metaclass.by_name.get(tag)
        if feature is None:
            feature = self._namespaced(element, metaclass, tag)
        if feature is None:
            self._ignored = 1
        elif not feature.is_reference:
            self._text.clear()
            self._nil = _value(attributes, _NIL) in ("true", "1")
            self._open.append((element, metaclass, feature))
        elif (href := _value(attributes, "href")) and (
            "#" in href or not self._owns_href(feature, attributes)
        ):
            self._refer(element, feature, as_address(href), self._claim(attributes))
            self._open.append((element, metaclass, feature))
        elif _value(attributes, _NIL) in ("true", "1"):
            self._leave_blank(element, feature)
            self._open.append((element, metaclass, feature))
        elif feature.containment:
            self._contained(element, feature, attributes)
        elif identifier := _value(attributes, _IDREF):
            self._refer(element, feature, as_address(identifier))
            self._open.append((element, metaclass, feature))
        else:
            message = f"{feature.name}: a reference as an element needs an href"
            self._fault("XMI006", message, element, broken=feature)
            self._ignored = 1

    def _owns_href(self, feature: Feature, attributes: list[str]) -> bool:
        """Return whether ``href``, which is not a link, is a feature of the element; EMF would not ask."""
        assert isinstance(feature.type, Metaclass)  # it is a reference
        if not feature.containment:
            return False
        prefix, _, name = (_value(attributes, _TYPE) or "").rpartition(":")
        ns_uri = self._document.namespaces.uri(prefix) or ""
        known = name and self._registry.has(ns_uri) and self._registry.package(ns_uri).members.get(name)
        metaclass = getattr(known, "_mmrs_metaclass", None) or feature.type
        return "href" in metaclass.by_name

    def _namespaced(self, element: Element, metaclass: Metaclass, tag: str) -> Feature | None:
        ns_uri, _, name = tag.rpartition(" ")
        if ns_uri == XMI:
            self._ignore(f"xmi:{name}")
            return None
        feature = metaclass.by_name.get(name)
        if feature is None or (ns_uri and not self._registry.has(ns_uri)):
            self._no_feature(element, metaclass, name)
            return None
        return feature

    def _contained(self, owner: Element, feature: Feature, attributes: list[str]) -> None:
        kind = _value(attributes, _TYPE) or _value(attributes, _XMI_TYPE)
        assert isinstance(feature.type, Metaclass)  # it is a reference
        metaclass: Metaclass | None = feature.type
        claimed = f"{feature.type.ns_uri}#{feature.type.name}"
        if kind is not None:
            prefix, _, name = kind.rpartition(":")
            ns_uri = self._document.namespaces.uri(prefix) or ""
            claimed = f"{ns_uri}#{name}"
            metaclass = self._metaclass(ns_uri, name, owner, prefix)
        if metaclass is not None and not issubclass(metaclass.interface, feature.type.interface):
            message = f"{metaclass.name}: not a {feature.type.name}, which {feature.name} takes"
            self._fault("XMI008", message, owner)
            metaclass = None
        element = self._make(metaclass, claimed, owner)
        if metaclass is not None and not isinstance(element, Unknown):
            self._open.append((element, metaclass, None))
        self._contain(owner, feature, element)
        if metaclass is not None and not isinstance(element, Unknown):
            self._attributes(element, metaclass, attributes)

    def _contain(self, owner: Element, feature: Feature, element: Element) -> None:
        occupied = not feature.many and bool(held(owner, feature))
        if occupied:
            self._fault("XMI009", f"{feature.name}: given more than once, takes one", owner)
        settle(owner, feature, element, occupied)

    def _make(self, metaclass: Metaclass | None, claimed: str, owner: Element | None = None) -> Element:
        """Make an element; one of an unknown, wrong or abstract class is kept, and holds its place."""
        made = None if metaclass is None else self._registry.implementation(metaclass)
        if metaclass is not None and made is None:
            self._fault("XMI003", f"{metaclass.name}: abstract; state a concrete subclass by xsi:type", owner)
        if made is None:
            element: Element = Unknown.__new__(Unknown)
            assert isinstance(element, Unknown)
            element._mmrs_type = claimed
            self._kept = (element, self._document.offset)
            self._ignored = 1
        else:
            element = made.__new__(made)
        element._mmrs_line = self._document.line
        element._mmrs_source = self._draft.source
        return element

    def _metaclass(
        self, ns_uri: str, name: str, owner: Element | None = None, prefix: str | None = None
    ) -> Metaclass | None:
        if ns_uri and self._registry.has(ns_uri):
            try:
                return self._registry.metaclass(ns_uri, name)
            except ValueError as fault:
                message, _, hint = str(fault).partition("; ")
                self._fault("XMI002", message, owner, hint)
                return None
        if not ns_uri and prefix is not None:
            self._fault("XMI014", f"{prefix}:{name}: the prefix {prefix!r} is not declared", owner)
        elif not ns_uri:
            self._fault("XMI015", f"{name}: the root is not a model: it has no namespace", owner)
        else:
            self._no_metamodel(ns_uri, name, owner)
        return None

    def _no_metamodel(self, ns_uri: str, name: str, owner: Element | None) -> None:
        if ns_uri not in self._missing:
            self._missing[ns_uri] = hint_for(ns_uri, self._registry)
        message = f"{ns_uri}: no such metamodel, needed for {name}"
        self._fault("XMI001", message, owner, self._missing[ns_uri])

    # attributes and values

    def _attributes(self, element: Element, metaclass: Metaclass, attributes: list[str]) -> None:
        pairs = iter(attributes)
        for name, text in zip(pairs, pairs, strict=True):
            feature = metaclass.by_name.get(name)
            if feature is not None:
                self._attribute(element, feature, text)
            elif name == _ID:
                self._draft.identify(element, text, self._document.line, own=False)
            elif name not in HARMLESS:
                self._no_feature(element, metaclass, name.rpartition(" ")[2])

    def _leave_blank(self, element: Element, feature: Feature) -> None:
        if feature.unsettable:
            self._draft.source.blanks.add((element, feature))

    def _attribute(self, element: Element, feature: Feature, text: str) -> None:
        if feature.many and not text.strip(" "):
            self._leave_blank(element, feature)
        elif feature.is_reference:
            self._refer(element, feature, text)
        elif feature.many:
            for word in words_of(text):
                self._value(element, feature, word)
        else:
            self._value(element, feature, text)

    def _claim(self, attributes: list[str]) -> str:
        """Return the class that a link says it leads to, as ``nsURI#Name``; empty if it says none."""
        prefix, _, name = (_value(attributes, _TYPE) or "").rpartition(":")
        return f"{self._document.namespaces.uri(prefix) or ''}#{name}" if name else ""

    def _refer(self, element: Element, feature: Feature, text: str, claimed: str = "") -> None:
        self._draft.pending.append(Pending(element, feature, text, self._document.line, claimed))

    def _value(self, element: Element, feature: Feature, text: str) -> None:
        assert not isinstance(feature.type, Metaclass)  # it is an attribute
        try:
            value = feature.type.parse(text)
        except ValueError as fault:
            hint = feature.type.meant(text) if isinstance(feature.type, Enumeration) else ""
            self._fault("XMI005", f"{feature.name}: {fault}", element, hint, broken=feature)
            return
        if feature.many:
            getattr(element, feature.attribute).append(value)
        elif held(element, feature):
            self._fault("XMI009", f"{feature.name}: given more than once, takes one", element)
            return
        else:
            type(element)._mmrs_slots[feature.attribute].__set__(element, value)
        if feature.is_id:
            self._draft.identify(element, text, self._document.line, own=True)

    def _value_ends(self, element: Element, feature: Feature) -> None:
        text = "".join(self._text)
        self._text.clear()
        if not self._nil:
            self._value(element, feature, text)
        elif feature.many and not getattr(feature.type, "primitive", True):
            getattr(element, feature.attribute).append(None)
        elif feature.many or getattr(feature.type, "primitive", True):
            self._fault("XMI005", f"{feature.name}: cannot be nil", element, broken=feature)
        elif feature.default is not None:
            type(element)._mmrs_slots[feature.attribute].__set__(element, None)
        else:
            self._leave_blank(element, feature)
        self._nil = False

    # faults

    def _no_feature(self, element: Element, metaclass: Metaclass, name: str) -> None:
        label = label_of(element)
        message = f"{name}: no feature of {metaclass.name}{label and f' {label!r}'}"
        if (metaclass, name) not in self._hints:
            self._hints[metaclass, name] = nearest(name, metaclass.by_name)
        self._fault("XMI004", message, element, self._hints[metaclass, name])

    def _ignore(self, what: str) -> None:
        self._ignored = 1
        message = f"{what}: not read, and not kept when the model is saved"
        self._draft.fault("XMI011", message, self._document.line, severity=Severity.WARNING)

    def _fault(
        self,
        code: str,
        message: str,
        element: Element | None = None,
        hint: str = "",
        broken: Feature | None = None,
    ) -> None:
        self._draft.fault(code, message, self._document.line, element, hint, broken)

    def _keep(self) -> None:
        if self._kept is None:
            return
        element, begin = self._kept
        self._kept = None
        element._mmrs_xml = text = self._document.text_from(begin)
        element._mmrs_scope = self._document.namespaces.in_scope(prefixes_in(text))


def _value(attributes: list[str], name: str) -> str | None:
    for index in range(0, len(attributes), 2):
        if attributes[index] == name:
            return attributes[index + 1]
    return None
