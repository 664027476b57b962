"""From elements to JSON: one object an element, short ones on one line, no defaults."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from mmrs_core.languages.element import Element, Unknown, held, holds, metaclass_of, path_of
from mmrs_core.languages.json_form.scalars import written
from mmrs_core.languages.json_form.stream import ID, LANGUAGES, PLACES, REF, ROOTS, TYPE, key_of, quoted
from mmrs_core.languages.json_form.tree import formatted, laid_out
from mmrs_core.languages.json_form.unknown import stated
from mmrs_core.languages.metaclass import Feature, Metaclass, is_null
from mmrs_core.languages.references.addresses import Addresses
from mmrs_core.languages.references.by_name import ReferenceNames
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.values.texts import described

_Children = tuple[Feature, tuple[object, ...]]
_Piece = str | tuple[Element, Feature | None, int]
"""What is still to be written: text, or an element with how deep it stands."""


class JsonWriter:
    """Writes one document."""

    def __init__(
        self,
        roots: Sequence[Element],
        registry: Registry,
        file: Path | None,
        names: ReferenceNames | None = None,
    ) -> None:
        self._names = names
        self._roots = roots
        self._registry = registry
        self._addresses = Addresses(roots, file)
        self._prefixes: dict[str, str] = {}
        self._pieces: list[str] = []
        self._kinds: dict[Metaclass, str] = {}

    def document(self, schema_location: Mapping[str, str]) -> str:
        """Return the whole text.

        Raises:
            ValueError: if a value has the wrong type, or a reference leads to an element in no file.
        """
        single = len(self._roots) == 1 and not isinstance(self._roots[0], Unknown)
        body = self._only(self._roots[0]) if single else self._several()
        self._write(body[::-1])
        used = sorted((prefix, ns_uri) for ns_uri, prefix in self._prefixes.items())
        head = [f'  "{LANGUAGES}": {_entries(used)},\n'] if used else []
        places = [(ns_uri, schema_location[ns_uri]) for _, ns_uri in used if ns_uri in schema_location]
        head += [f'  "{PLACES}": {_entries(places)},\n'] if places else []
        return "{\n" + "".join(head) + "".join(self._pieces) + "\n}\n"

    def _only(self, root: Element) -> list[_Piece]:
        return self._lines(*self._said(root, None), 0)

    def _several(self) -> list[_Piece]:
        jobs: list[_Piece] = [f'  "{ROOTS}": [']
        for index, root in enumerate(self._roots):
            jobs += [",\n    " if index else "\n    ", (root, None, 2)]
        return [*jobs, "\n  ]" if self._roots else "]"]

    def _write(self, jobs: list[_Piece]) -> None:
        while jobs:
            job = jobs.pop()
            if isinstance(job, str):
                self._pieces.append(job)
            else:
                self._element(*job, jobs)

    def _element(self, element: Element, feature: Feature | None, depth: int, jobs: list[_Piece]) -> None:
        if isinstance(element, Unknown):
            self._addresses.refuse_strays(element)
            node = stated(element, lambda name: self._short(name, element._mmrs_scope))
            self._pieces.append(formatted(node, depth))
            return
        members, children = self._said(element, feature)
        if not children:
            self._pieces.append(laid_out(members, depth))
            return
        pieces = ["{\n", *self._lines(members, children, depth), "\n" + "  " * depth + "}"]
        jobs.extend(reversed(pieces))

    def _said(self, element: Element, feature: Feature | None) -> tuple[list[str], list[_Children]]:
        """Return the members that hold plain values, and those that hold elements."""
        metaclass = metaclass_of(element)
        members = self._own(element, metaclass, feature)
        children: list[_Children] = []
        for each in metaclass.features:
            if not each.stored or (each.is_container and not self._addresses.stands_apart(element)):
                continue
            if not holds(element, each):
                if each.unsettable and self._addresses.is_blank(element, each):
                    members.append(f"{_key(each)}: {'[]' if each.many else 'null'}")
            elif each.containment:
                children.append((each, held(element, each)))
            else:
                members.append(f"{_key(each)}: {self._plain(element, each, held(element, each))}")
        return members, children

    def _own(self, element: Element, metaclass: Metaclass, feature: Feature | None) -> list[str]:
        """Return the own keys of an element."""
        members: list[str] = []
        if feature is None or metaclass is not feature.type:
            members.append(f'"{TYPE}": {self._kind(metaclass)}')
        identifier = self._addresses.identifier(element)
        if identifier is not None:
            members.append(f'"{ID}": {quoted(identifier)}')
        return members

    def _kind(self, metaclass: Metaclass) -> str:
        found = self._kinds.get(metaclass)
        if found is None:
            prefix = self._prefix(metaclass.ns_uri, self._registry.package(metaclass.ns_uri).prefix)
            found = self._kinds[metaclass] = quoted(f"{prefix}:{metaclass.name}")
        return found

    def _lines(self, members: list[str], children: list[_Children], depth: int) -> list[_Piece]:
        """Return what stands between the braces of an object, a line for each member."""
        margin = "  " * (depth + 1)
        pieces: list[_Piece] = [",\n".join(margin + member for member in members)]
        for feature, values in children:
            pieces.append(f"{',' + chr(10) if pieces[-1] else ''}{margin}{_key(feature)}: ")
            pieces += self._contained(feature, values, depth + 1)
        return pieces

    def _contained(self, feature: Feature, values: tuple[object, ...], depth: int) -> Iterator[_Piece]:
        if not feature.many:
            yield self._one(feature, values[0], depth)
            return
        yield "["
        for index, value in enumerate(values):
            yield ("," if index else "") + "\n" + "  " * (depth + 1)
            yield self._one(feature, value, depth + 1)
        yield "\n" + "  " * depth + "]"

    def _one(self, feature: Feature, value: object, depth: int) -> _Piece:
        if not isinstance(value, Element):
            raise ValueError(f"{feature.name}: {value!r} is not an element")
        if self._addresses.stands_elsewhere(value):
            return laid_out([f'"{REF}": {quoted(self._address(value, value, feature))}'], depth)
        return value, feature, depth

    def _plain(self, element: Element, feature: Feature, values: tuple[object, ...]) -> str:
        kind = feature.type
        if isinstance(kind, Metaclass):
            targets = [value for value in values if isinstance(value, Element)]
            parts = [quoted(self._reference(element, target, feature)) for target in targets]
        else:
            for value in values:
                if not kind.accepts(value) and not is_null(feature, value):
                    where = f"{path_of(element)}: {feature.name}"
                    raise ValueError(f"{where}: {described(value)} is not of the type {kind.name}")
            try:
                parts = ["null" if value is None else written(kind, value) for value in values]
            except ValueError as fault:
                raise ValueError(f"{path_of(element)}: {feature.name}: {fault}") from None
        if feature.many:
            return f"[{', '.join(parts)}]"
        return parts[0] if parts else "null"

    def _reference(self, element: Element, target: Element, feature: Feature) -> str:
        """Return what refers to an element that is not contained."""
        name = self._names.text(element, feature, target, False) if self._names is not None else None
        return self._address(element, target, feature) if name is None else name

    def _address(self, element: Element, target: Element, feature: Feature) -> str:
        if self._addresses.stands_here(target):
            return self._addresses.fragment(target)
        try:
            return self._addresses.href(target)
        except ValueError as fault:
            raise ValueError(f"{path_of(element)}: {feature.name}: {fault}") from None

    def _short(self, name: str, scope: Mapping[str, str]) -> str:
        """Return the type of an element whose metamodel is not installed, by the prefix it had."""
        ns_uri, _, local = name.rpartition("#")
        had = next((prefix for prefix, uri in scope.items() if uri == ns_uri and prefix), "p")
        return f"{self._prefix(ns_uri, had)}:{local}" if ns_uri else name

    def _prefix(self, ns_uri: str, wanted: str) -> str:
        if ns_uri not in self._prefixes:
            taken = set(self._prefixes.values())
            numbered = (f"{wanted or 'p'}_{number}" for number in range(1, len(taken) + 2))
            free = (prefix for prefix in (wanted or "p", *numbered) if prefix not in taken)
            self._prefixes[ns_uri] = next(free)
        return self._prefixes[ns_uri]


def _key(feature: Feature) -> str:
    return quoted(key_of(feature.name))


def _entries(pairs: Iterable[tuple[str, str]]) -> str:
    return laid_out([f"{quoted(name)}: {quoted(value)}" for name, value in pairs], 1)
