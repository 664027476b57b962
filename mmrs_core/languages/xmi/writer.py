"""From elements to XMI, as EMF writes it: the same order, the same forms, no defaults."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from mmrs_core.languages.element import Element, Unknown, held, holds, metaclass_of, path_of
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.addresses import Addresses
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.events import XMI, XSI

_ATTRIBUTE_ESCAPES = {"&": "&amp;", "<": "&lt;", '"': "&quot;", "\n": "&#xA;", "\t": "&#x9;", "\r": "&#xD;"}
_IN_ATTRIBUTE = re.compile('[&<"\n\t\r]')
_TEXT_ESCAPES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\r": "&#xD;"}
_IN_TEXT = re.compile('[&<"\r]|(?<=]])>')
_NO_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")

_Attributes = list[tuple[str, str]]
_Job = str | tuple[Element, str, Feature | None, int]


class XmiWriter:
    """Writes one document."""

    def __init__(self, roots: Sequence[Element], registry: Registry, file: Path | None) -> None:
        self._roots = roots
        self._registry = registry
        self._addresses = Addresses(roots, file)
        self._prefixes: dict[str, str] = {}
        self._typed = False
        self._lines: list[str] = []

    def document(self, schema_location: Mapping[str, str]) -> str:
        """Return the whole text.

        Raises:
            ValueError: if a value has the wrong type, holds a character that XML cannot hold, or a reference
                leads to an element that stands in no file.
        """
        wrapped = len(self._roots) != 1
        for root in self._roots:
            self._tree(root, 1 if wrapped else 0)
        head = "".join(f' {name}="{value}"' for name, value in self._head(schema_location))
        declaration = '<?xml version="1.0" encoding="UTF-8"?>\n'
        if not wrapped:
            return f"{declaration}{self._lines[0]}{head}{''.join(self._lines[1:])}"
        if not self._roots:
            return f"{declaration}<xmi:XMI{head}/>\n"
        return f"{declaration}<xmi:XMI{head}>\n{''.join(self._lines)}</xmi:XMI>\n"

    def _head(self, schema_location: Mapping[str, str]) -> _Attributes:
        head = [("xmi:version", "2.0"), ("xmlns:xmi", XMI)]
        used = sorted((prefix, ns_uri) for ns_uri, prefix in self._prefixes.items())
        places = [f"{ns_uri} {schema_location[ns_uri]}" for _, ns_uri in used if ns_uri in schema_location]
        if self._typed or places:
            head.append(("xmlns:xsi", XSI))
        head += [(f"xmlns:{prefix}", _attribute(ns_uri)) for prefix, ns_uri in used]
        if places:
            head.append(("xsi:schemaLocation", _attribute(" ".join(places))))
        return head

    def _tree(self, root: Element, depth: int) -> None:
        jobs: list[_Job] = [(root, "", None, depth)]
        while jobs:
            job = jobs.pop()
            if isinstance(job, str):
                self._lines.append(job)
            else:
                self._element(*job, jobs)

    def _element(
        self, element: Element, tag: str, feature: Feature | None, depth: int, jobs: list[_Job]
    ) -> None:
        indent = "  " * depth
        if isinstance(element, Unknown):
            self._unknown(element, indent, jobs)
            return
        metaclass = metaclass_of(element)
        if feature is None:
            tag = self._name(metaclass)
        elif metaclass is not feature.type:
            tag = f'{tag} xsi:type="{self._kind(metaclass)}"'
        identifier = self._addresses.identifier(element)
        if identifier is not None:
            tag = f'{tag} xmi:id="{_attribute(identifier)}"'
        attributes, children = self._features(element, metaclass, depth + 1)
        text = "".join(f' {name}="{value}"' for name, value in attributes)
        if feature is None:
            self._open_root(f"{indent}<{tag}", text, indent, metaclass, children, jobs)
            return
        if children:
            self._lines.append(f"{indent}<{tag}{text}>\n")
            jobs.append(f"{indent}</{feature.name}>\n")
            jobs.extend(reversed(children))
        else:
            self._lines.append(f"{indent}<{tag}{text}/>\n")

    def _open_root(
        self, tag: str, text: str, indent: str, metaclass: Metaclass, children: list[_Job], jobs: list[_Job]
    ) -> None:
        """Write in two pieces: the namespaces come between them, once it is known which are used."""
        self._lines.append(tag)
        self._lines.append(f"{text}>\n" if children else f"{text}/>\n")
        if children:
            jobs.append(f"{indent}</{self._name(metaclass)}>\n")
            jobs.extend(reversed(children))

    def _unknown(self, element: Unknown, indent: str, jobs: list[_Job]) -> None:
        text = element._mmrs_xml
        end = re.match(r"<[^\s/>]+", text)
        assert end is not None  # it was cut out of a well-formed document
        head, rest = text[: end.end()], text[end.end() :]
        own = "".join(
            f' xmlns{prefix and ":" + prefix}="{_attribute(uri)}"'
            for prefix, uri in element._mmrs_scope.items()
            if uri and f"xmlns{prefix and ':' + prefix}=" not in rest.partition(">")[0]
        )
        self._lines.append(f"{indent}{head}{own}")
        self._lines.append(f"{rest}\n")

    def _features(self, element: Element, metaclass: Metaclass, depth: int) -> tuple[_Attributes, list[_Job]]:
        attributes: _Attributes = []
        children: list[_Job] = []
        for feature in metaclass.features:
            if not feature.stored or (feature.is_container and not self._addresses.stands_apart(element)):
                continue
            if not holds(element, feature):
                self._blank(element, feature, depth, attributes, children)
                continue
            values = held(element, feature)
            if not feature.is_reference:
                self._values(element, feature, values, depth, attributes, children)
            elif feature.containment:
                children.extend(self._contained(element, feature, values, depth))
            else:
                self._references(element, feature, values, depth, attributes, children)
        return attributes, children

    def _blank(
        self,
        element: Element,
        feature: Feature,
        depth: int,
        attributes: _Attributes,
        children: list[_Job],
    ) -> None:
        """Write that nothing is in a feature, if its file said so."""
        if not feature.unsettable or not self._addresses.is_blank(element, feature):
            return
        if feature.many:
            attributes.append((feature.name, ""))
        else:
            self._typed = True
            children.append(f'{"  " * depth}<{feature.name} xsi:nil="true"/>\n')

    def _values(
        self,
        element: Element,
        feature: Feature,
        values: Iterable[object],
        depth: int,
        attributes: _Attributes,
        children: list[_Job],
    ) -> None:
        indent = "  " * depth
        texts = [self._rendered(element, feature, value) for value in values]
        if not texts:
            self._typed = True
            children.append(f'{indent}<{feature.name} xsi:nil="true"/>\n')
        elif feature.many or feature.name == "href":  # as an attribute, EMF would take that for a link
            children.extend(f"{indent}<{feature.name}>{_text(text)}</{feature.name}>\n" for text in texts)
        else:
            attributes.append((feature.name, _attribute(texts[0])))

    def _rendered(self, element: Element, feature: Feature, value: object) -> str:
        kind = feature.type
        if isinstance(kind, Metaclass) or not kind.accepts(value):
            raise ValueError(f"{_where(element, feature)}: {value!r} is not of the type {kind.name}")
        text = kind.render(value)
        bad = _NO_XML.search(text)
        if bad is not None:
            code = ord(bad.group())
            raise ValueError(f"{_where(element, feature)}: holds U+{code:04X}, which XML cannot hold")
        return text

    def _contained(
        self, element: Element, feature: Feature, values: Iterable[object], depth: int
    ) -> Iterable[_Job]:
        for value in values:
            if not isinstance(value, Element):
                raise ValueError(f"{_where(element, feature)}: {value!r} is no element")
            if self._addresses.stands_elsewhere(value):
                yield self._href(element, feature, value, depth)
            else:
                yield value, feature.name, feature, depth

    def _references(
        self,
        element: Element,
        feature: Feature,
        values: Iterable[object],
        depth: int,
        attributes: _Attributes,
        children: list[_Job],
    ) -> None:
        targets = [value for value in values if isinstance(value, Element)]
        if all(self._addresses.stands_here(target) for target in targets):
            fragments = " ".join(self._addresses.fragment(target) for target in targets)
            attributes.append((feature.name, _attribute(fragments)))
        else:
            children.extend(self._href(element, feature, target, depth) for target in targets)

    def _href(self, element: Element, feature: Feature, target: Element, depth: int) -> str:
        metaclass = metaclass_of(target)
        kind = "" if metaclass is feature.type else f' xsi:type="{self._kind(metaclass)}"'
        try:
            href = self._addresses.href(target)
        except ValueError as fault:
            raise ValueError(f"{_where(element, feature)}: {fault}") from None
        return f'{"  " * depth}<{feature.name}{kind} href="{_attribute(href)}"/>\n'

    def _kind(self, metaclass: Metaclass) -> str:
        self._typed = True
        return self._name(metaclass)

    def _name(self, metaclass: Metaclass) -> str:
        return f"{self._prefix(metaclass.ns_uri)}:{metaclass.name}"

    def _prefix(self, ns_uri: str) -> str:
        known = self._prefixes.get(ns_uri)
        if known is not None:
            return known
        wanted = self._registry.package(ns_uri).prefix or "p"
        taken = {"xmi", "xsi", "xml", "xmlns", *self._prefixes.values()}
        prefix, number = wanted, 0
        while prefix in taken:
            number += 1
            prefix = f"{wanted}_{number}"
        self._prefixes[ns_uri] = prefix
        return prefix


def _attribute(value: str) -> str:
    return _IN_ATTRIBUTE.sub(lambda match: _ATTRIBUTE_ESCAPES[match.group()], value)


def _text(value: str) -> str:
    return _IN_TEXT.sub(lambda match: _TEXT_ESCAPES[match.group()], value)


def _where(element: Element, feature: Feature) -> str:
    """Return what an error calls a value; costly, hence only for errors."""
    return f"{path_of(element)}: {feature.name}"
