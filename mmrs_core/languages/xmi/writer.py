"""From elements to XMI, as EMF writes it: the same order, the same forms, no defaults."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from mmrs_core.languages.element import Element, Unknown, held, holds, metaclass_of, path_of
from mmrs_core.languages.metaclass import Feature, Metaclass, is_null
from mmrs_core.languages.references.addresses import Addresses
from mmrs_core.languages.references.by_name import ReferenceNames
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.values.texts import described
from mmrs_core.languages.xmi.escapes import NO_XML, in_attribute, in_comment, in_text
from mmrs_core.languages.xmi.events import XMI, XSI
from mmrs_core.languages.xmi.unknowns import text_of

_DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>\n'
_PREFIX = re.compile(r"[^\W\d][\w.-]*")
_UNFIT = re.compile(r"[^\w.-]", re.ASCII)
_Attributes = list[tuple[str, str]]


class SiblingRow(NamedTuple):
    """What is left to be written of the elements in a containment feature."""

    owner: Element
    feature: Feature
    values: Iterator[object]
    depth: int


Job = str | SiblingRow
"""What is left to be done: a text to be added, or elements to be written."""


class XmiWriter:
    """Writes one document."""

    def __init__(
        self,
        roots: Sequence[Element],
        registry: Registry,
        file: Path | None,
        comments: Mapping[Element, str] | None = None,
        names: ReferenceNames | None = None,
    ) -> None:
        """Take the document; comments are written before their elements, and names instead of paths."""
        self._names = names
        self._roots = roots
        self._comments = comments or {}
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
        if len(self._roots) == 1 and isinstance(self._roots[0], Unknown):
            return f"{_DECLARATION}{text_of(self._roots[0], lambda prefix, ns_uri: False)}\n"
        wrapped = len(self._roots) != 1
        for root in self._roots:
            self._tree(root, 1 if wrapped else 0)
        head = "".join(f' {name}="{value}"' for name, value in self._head(schema_location))
        if not self._roots:
            return f"{_DECLARATION}<xmi:XMI{head}/>\n"
        if wrapped:
            return "".join((_DECLARATION, f"<xmi:XMI{head}>\n", *self._lines, "</xmi:XMI>\n"))
        comment = self._comment(self._roots[0], "")
        return "".join((_DECLARATION, comment, self._lines[0], head, *self._lines[1:]))

    def parts(
        self, elements: Iterable[Element], prefixes: Mapping[str, str], depth: int
    ) -> tuple[str, dict[str, str]]:
        """Return the text of some elements inside the root, and the namespaces that it needs besides.

        Args:
            elements: each in its place in what contains it.
            prefixes: those that the document declares, with their namespaces.
            depth: of the elements; the root's is 0.

        Raises:
            ValueError: as in `document`.
        """
        self._prefixes = {ns_uri: prefix for prefix, ns_uri in prefixes.items() if prefix}
        for element in elements:
            feature = element._mmrs_feature
            assert feature is not None  # it is inside the root
            jobs: list[Job] = []
            self._element(element, feature.name, feature, depth, jobs)
            self._run(jobs)
        needed = {prefix: ns_uri for ns_uri, prefix in self._prefixes.items()}
        needed |= {"xsi": XSI} if self._typed else {}
        return "".join(self._lines), {
            prefix: ns_uri for prefix, ns_uri in needed.items() if prefixes.get(prefix) != ns_uri
        }

    def _comment(self, element: Element, indent: str) -> str:
        words = self._comments.get(element)
        lines = in_comment(words).replace("\n", f"\n{indent}     ") if words else ""
        return f"{indent}<!-- {lines} -->\n" if lines else ""

    def _head(self, schema_location: Mapping[str, str]) -> _Attributes:
        head = [("xmi:version", "2.0"), ("xmlns:xmi", XMI)]
        used = sorted((prefix, ns_uri) for ns_uri, prefix in self._prefixes.items())
        places = [f"{ns_uri} {schema_location[ns_uri]}" for _, ns_uri in used if ns_uri in schema_location]
        if self._typed or places:
            head.append(("xmlns:xsi", XSI))
        head += [(f"xmlns:{prefix}", in_attribute(ns_uri)) for prefix, ns_uri in used]
        if places:
            head.append(("xsi:schemaLocation", in_attribute(" ".join(places))))
        return head

    def _tree(self, root: Element, depth: int) -> None:
        jobs: list[Job] = []
        self._element(root, "", None, depth, jobs)
        self._run(jobs)

    def _run(self, jobs: list[Job]) -> None:
        while jobs:
            job = jobs.pop()
            if isinstance(job, str):
                self._lines.append(job)
            else:
                self._row(job, jobs)

    def _row(self, row: SiblingRow, jobs: list[Job]) -> None:
        """Write the next element of a row, and leave what follows as jobs."""
        for value in row.values:
            jobs.append(row)
            self._child(row, value, jobs)
            return

    def _child(self, row: SiblingRow, value: object, jobs: list[Job]) -> None:
        element, feature, _, depth = row
        if not isinstance(value, Element):
            raise ValueError(f"{_where(element, feature)}: {value!r} is not an element")
        if self._addresses.stands_elsewhere(value):
            self._lines.append(self._href(element, feature, value, depth))
        else:
            self._element(value, feature.name, feature, depth, jobs)

    def _element(
        self, element: Element, tag: str, feature: Feature | None, depth: int, jobs: list[Job]
    ) -> None:
        indent = "  " * depth
        if isinstance(element, Unknown):
            self._unknown(element, indent)
            return
        metaclass = metaclass_of(element)
        if feature is None:
            tag = self._name(metaclass)
        elif metaclass is not feature.type:
            tag = f'{tag} xsi:type="{self._kind(metaclass)}"'
        identifier = self._addresses.identifier(element)
        if identifier is not None:
            tag = f'{tag} xmi:id="{in_attribute(identifier)}"'
        attributes, children = self._features(element, metaclass, depth + 1)
        text = "".join(f' {name}="{value}"' for name, value in attributes)
        if feature is None:
            self._open_root(f"{indent}<{tag}", text, indent, metaclass, children, jobs)
            return
        self._lines.append(self._comment(element, indent))
        if children:
            self._lines.append(f"{indent}<{tag}{text}>\n")
            jobs.append(f"{indent}</{feature.name}>\n")
            jobs.extend(reversed(children))
        else:
            self._lines.append(f"{indent}<{tag}{text}/>\n")

    def _open_root(
        self, tag: str, text: str, indent: str, metaclass: Metaclass, children: list[Job], jobs: list[Job]
    ) -> None:
        """Write in two pieces: the namespaces come between them, once it is known which are used."""
        self._lines.append(tag)
        self._lines.append(f"{text}>\n" if children else f"{text}/>\n")
        if children:
            jobs.append(f"{indent}</{self._name(metaclass)}>\n")
            jobs.extend(reversed(children))

    def _unknown(self, element: Unknown, indent: str) -> None:
        self._addresses.refuse_strays(element)
        self._lines.append(f"{indent}{text_of(element, self._declares)}\n")

    def _declares(self, prefix: str, ns_uri: str) -> bool:
        """Return whether the root can declare a prefix for what was kept of an element."""
        if (prefix, ns_uri) == ("xsi", XSI):
            self._typed = True
        elif prefix not in ("xmi", "xsi", *self._prefixes.values()) and ns_uri not in self._prefixes:
            self._prefixes[ns_uri] = prefix
        return self._prefixes.get(ns_uri) == prefix or (prefix, ns_uri) in (("xsi", XSI), ("xmi", XMI))

    def _features(self, element: Element, metaclass: Metaclass, depth: int) -> tuple[_Attributes, list[Job]]:
        attributes: _Attributes = []
        children: list[Job] = []
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
                children.append(SiblingRow(element, feature, iter(values), depth))
            else:
                self._references(element, feature, values, depth, attributes, children)
        return attributes, children

    def _blank(
        self, element: Element, feature: Feature, depth: int, attributes: _Attributes, children: list[Job]
    ) -> None:
        """Write that nothing is in a feature, if its file said so."""
        if not feature.unsettable or not self._addresses.is_blank(element, feature):
            return
        if feature.many:
            attributes.append((feature.name, ""))
        else:
            children.append(self._inner(feature, None, depth))

    def _values(
        self,
        element: Element,
        feature: Feature,
        values: Iterable[object],
        depth: int,
        attributes: _Attributes,
        children: list[Job],
    ) -> None:
        texts = [
            None if is_null(feature, value) else self._rendered(element, feature, value) for value in values
        ]
        if not texts:
            children.append(self._inner(feature, None, depth))
        elif feature.many or feature.name == "href":  # as an attribute, EMF would take that for a link
            children.extend(self._inner(feature, text, depth) for text in texts)
        else:
            attributes.append((feature.name, in_attribute(texts[0] or "")))

    def _inner(self, feature: Feature, text: str | None, depth: int) -> str:
        """Return a value as an element; None is nil."""
        self._typed |= text is None
        value = ' xsi:nil="true"/>' if text is None else f">{in_text(text)}</{feature.name}>"
        return f"{'  ' * depth}<{feature.name}{value}\n"

    def _rendered(self, element: Element, feature: Feature, value: object) -> str:
        kind = feature.type
        if isinstance(kind, Metaclass) or not kind.accepts(value):
            raise ValueError(f"{_where(element, feature)}: {described(value)} is not of the type {kind.name}")
        try:
            text = kind.render(value)
        except ValueError as fault:
            raise ValueError(f"{_where(element, feature)}: {fault}") from None
        bad = NO_XML.search(text)
        if bad is not None:
            code = ord(bad.group())
            raise ValueError(f"{_where(element, feature)}: holds U+{code:04X}, which XML cannot hold")
        return text

    def _references(
        self,
        element: Element,
        feature: Feature,
        values: Iterable[object],
        depth: int,
        attributes: _Attributes,
        children: list[Job],
    ) -> None:
        targets = [value for value in values if isinstance(value, Element)]
        if _pairs_with_itself(element, feature, targets):
            children.append(self._href(element, feature, element, depth))
            return
        texts = self._by_name(element, feature, targets)
        texts = texts or [self._fragment(target) for target in targets]
        if None not in texts:
            attributes.append((feature.name, in_attribute(" ".join(map(str, texts)))))
        else:
            children.extend(self._href(element, feature, target, depth) for target in targets)

    def _by_name(
        self, element: Element, feature: Feature, targets: Sequence[Element]
    ) -> list[str | None] | None:
        """Return references of which some are names, or None where none is to be one."""
        if self._names is None:
            return None
        found = [self._names.text(element, feature, target, feature.many) for target in targets]
        if not any(found):
            return None
        # an address of another file stands among names as it is
        return [
            text or self._fragment(target) or self._address(element, feature, target)
            for text, target in zip(found, targets, strict=True)
        ]

    def _fragment(self, target: Element) -> str | None:
        """Return the fragment of an element; None if it is not in the document."""
        return self._addresses.fragment(target) if self._addresses.stands_here(target) else None

    def _href(self, element: Element, feature: Feature, target: Element, depth: int) -> str:
        kind = self._claim(target, feature)
        href = self._address(element, feature, target)
        return f'{"  " * depth}<{feature.name}{kind} href="{in_attribute(href)}"/>\n'

    def _address(self, element: Element, feature: Feature, target: Element) -> str:
        """Return the reference to an element, with its file if that is another."""
        try:
            return self._addresses.href(target)
        except ValueError as fault:
            raise ValueError(f"{_where(element, feature)}: {fault}") from None

    def _claim(self, target: Element, feature: Feature) -> str:
        """Return the class that a link to an element states; empty if it is the expected one."""
        if not isinstance(target, Unknown):
            metaclass = metaclass_of(target)
            return "" if metaclass is feature.type else f' xsi:type="{self._kind(metaclass)}"'
        ns_uri, _, name = target._mmrs_type.rpartition("#")
        if not ns_uri:
            return ""
        self._typed = True
        had = next((prefix for prefix, uri in target._mmrs_scope.items() if uri == ns_uri), "")
        return f' xsi:type="{self._prefix(ns_uri, had)}:{name}"'

    def _kind(self, metaclass: Metaclass) -> str:
        self._typed = True
        return self._name(metaclass)

    def _name(self, metaclass: Metaclass) -> str:
        return f"{self._prefix(metaclass.ns_uri)}:{metaclass.name}"

    def _prefix(self, ns_uri: str, had: str = "") -> str:
        """Return the prefix of a language; of one that is not installed, that which it `had` in its file."""
        known = self._prefixes.get(ns_uri)
        if known is not None:
            return known
        installed = self._registry.has(ns_uri)
        wanted = (_spelt(self._registry.package(ns_uri).prefix) if installed else had) or "p"
        taken = {"xmi", "xsi", "xml", "xmlns", *self._prefixes.values()}
        prefix, number = wanted, 0
        while prefix in taken:
            number += 1
            prefix = f"{wanted}_{number}"
        self._prefixes[ns_uri] = prefix
        return prefix


def _pairs_with_itself(element: Element, feature: Feature, targets: Sequence[Element]) -> bool:
    """Return whether an element is the other end of its own pair, which EMF reads as a link only."""
    opposite = feature.opposite
    return opposite is not None and not feature.many and not opposite.many and targets[0] is element


def _where(element: Element, feature: Feature) -> str:
    """Return what an error calls a value; costly, hence only for errors."""
    return f"{path_of(element)}: {feature.name}"


def _spelt(prefix: str) -> str:
    """Return a prefix as XML can have it: metamodels may state any text."""
    return prefix if not prefix or _PREFIX.fullmatch(prefix) else f"p_{_UNFIT.sub('_', prefix)}"
