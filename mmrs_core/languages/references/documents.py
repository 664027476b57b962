"""What is known of a file while its references are still texts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING
from urllib.parse import quote, unquote

from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.element import Element, Unknown, contents, descendants, path_of
from mmrs_core.languages.links import raw
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.named import NamedElements
from mmrs_core.languages.sources import Source

if TYPE_CHECKING:
    from mmrs_core.languages.importers import Importer


class Names:
    """The names of what elements hold, each looked up once."""

    def __init__(self) -> None:
        self._known: dict[Element, dict[str, Element]] = {}

    def inside(self, element: Element) -> dict[str, Element]:
        """Return what an element holds by name; of several of one name, the first.

        Nothing, unless the element is of a class of Ecore or a subclass, of which alone EMF knows names.
        """
        if element not in self._known:
            found: dict[str, Element] = {}
            for child in contents(element) if _is_described(element) else ():
                if name := _name(child):
                    found.setdefault(name, child)
            self._known[element] = found
        return self._known[element]

    def fragment(self, top: Element, element: Element) -> str | None:
        """Return the fragment of an element below a root; None where names do not lead to it."""
        steps: list[str] = []
        while element is not top:
            name, container = _name(element), element._mmrs_container
            if container is None or name.startswith("@") or self.inside(container).get(name) is not element:
                return None
            steps.append(f"/{name if name.isidentifier() else quote(name, safe='')}")
            element = container
        return f"/{''.join(reversed(steps))}" if _is_described(top) else None


def _is_described(element: Element) -> bool:
    metaclass = type(element)._mmrs_metaclass
    return metaclass is not None and metaclass.is_kind(ECORE, "EModelElement")


def _name(element: Element) -> str:
    name = getattr(element, "name", None) if _is_described(element) else None
    return name if isinstance(name, str) else ""


MOST_FAULTS = 10_000

_STEP = re.compile(r"@(?P<name>[^\[]+?)(?:\.(?P<index>[0-9]{1,9})|\[(?P<keys>.*)\])?", re.DOTALL)
_INDEX = re.compile(r"[0-9]{0,9}")
_KEY = re.compile(r"""(?<!\w)(?P<name>\w+)=(?:'(?P<single>[^']*)'|"(?P<double>[^"]*)"|(?P<null>null))""")


@dataclass(slots=True)
class Pending:
    """A reference that is still a text: in ``feature`` of ``element``, on that line.

    What it claims to lead to is ``nsURI#Name``, or empty if it says nothing about that.
    """

    element: Element
    feature: Feature
    text: str
    line: int
    claimed: str = ""


Quick = tuple[Element, Feature, str, int]
"""The same for references without opposite that attributes give, as most are: smaller, and sooner made."""


@dataclass(slots=True)
class Draft:
    """A file between its parsing and the resolution of its references.

    Attributes:
        late: references that wait until the names of all files are known: those by name, and what follows
            them in the same list; each with its target or the name.
        importer: what imports the file; None for a file in our own format.
    """

    source: Source
    roots: list[Element] = field(default_factory=list)
    ids: dict[str, Element] = field(default_factory=dict)
    pending: list[Pending | Quick] = field(default_factory=list)
    late: list[tuple[Pending, Element | str]] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    broken: set[tuple[Element, str]] = field(default_factory=set)
    found: dict[str, Element] = field(default_factory=dict)
    lists: dict[str, list[object]] = field(default_factory=dict)
    names: Names = field(default_factory=Names)
    said_within: dict[str, Unknown] | None = None
    importer: Importer | None = None
    _read_below: list[int] = field(default_factory=list)
    _named: NamedElements | None = None

    def fault(
        self,
        code: str,
        message: str,
        line: int,
        element: Element | None = None,
        hint: str = "",
        broken: Feature | None = None,
        severity: Severity = Severity.ERROR,
    ) -> None:
        """Note a fault at a line, in an element if it is known.

        Args:
            broken: the feature of the element that is left without its value.

        Raises:
            UnreadableError: if there are too many to read: then it is not a model at all.
        """
        if len(self.diagnostics) >= MOST_FAULTS:
            first = self.diagnostics[0]
            message = f"more than {MOST_FAULTS} faults; the first is: {first.message}"
            raise UnreadableError.of("FIL008", message, self.source.file, line)
        path = path_of(element) if element is not None else ""
        if element is not None and broken is not None:
            self.broken.add((element, broken.name))
        self._read_below.append(len(self.roots) - 1)
        self.diagnostics.append(
            Diagnostic(code, severity, message, Place(self.source.file, line, path), hint)
        )

    def identify(self, element: Element, identifier: str, line: int, *, own: bool) -> None:
        """Note an identifier: a value of the element itself (`own`), or what the file calls it."""
        other = self.ids.setdefault(identifier, element)
        if other is not element:
            message = f"{identifier}: an id used twice; first on line {other._mmrs_line}"
            self.fault("XMI012", message, line, element)
        elif not own:
            self.source.ids[element] = identifier

    def take(self, roots: Sequence[Element], diagnostics: Iterable[Diagnostic]) -> None:
        """Take elements that were made of the file, and their diagnostics."""
        self.roots += roots
        self.source.roots = tuple(self.roots)
        self.diagnostics += diagnostics
        for root in roots:
            for element in (root, *descendants(root)):
                element._mmrs_source = self.source

    def number_roots(self) -> None:
        """Take all roots as read: if there are several, their numbers lead the paths of what was noted.

        While the first is read, it is unknown whether others follow.
        """
        self.source.roots = tuple(self.roots)
        if len(self.roots) < 2:
            return
        for index, number in enumerate(self._read_below):
            place = self.diagnostics[index].place
            if place.path:
                path = f"/{number}{place.path.rstrip('/')}"
                self.diagnostics[index] = replace(self.diagnostics[index], place=replace(place, path=path))

    def named(self) -> NamedElements:
        """Return the elements by their names, as they are at the first call."""
        if self._named is None:
            self._named = NamedElements(self.roots)
        return self._named

    def find(self, fragment: str) -> Element | None:
        """Return the element that a fragment means: a path such as ``//@tasks.2``, or an id."""
        known = self.found.get(fragment)
        if known is not None:
            return known
        if not fragment.startswith("/"):
            return self.ids.get(fragment)
        head, _, last = fragment.rpartition("/")
        parent = self.found.get(head) or self._walk(head)
        found = self._step(parent, last) if head else self._root(last)
        if found is not None:
            self.found[fragment] = found
        return found

    def list_at(self, head: str) -> list[object]:
        """Return the list that a path without its last index leads to, such as ``//@robots.3/@moves``.

        What was found once stands in ``lists``.
        """
        above, _, name = head.rpartition("/@")
        owner = self.find(above) if above.startswith("/") else None
        metaclass = type(owner)._mmrs_metaclass if owner is not None else None
        feature = metaclass.by_name.get(name) if metaclass is not None else None
        if owner is None or feature is None or not (feature.is_reference and feature.many):
            return []
        values = raw(owner, feature)
        if isinstance(values, list):
            self.lists[head] = values
            return values
        return []

    def _walk(self, fragment: str) -> Element | None:
        _, root, *steps = fragment.split("/") if fragment else ("", "")
        element = self._root(root)
        for step in steps:
            element = self._step(element, step)
        if element is not None:
            self.found[fragment] = element
        return element

    def entered(self, fragment: str) -> tuple[Unknown | None, str]:
        """Return the unknown element that a path leads into, and the rest of the path; None if into none."""
        _, root, *steps = fragment.split("/")
        element, behind = self._root(root), len(root) + 1
        for step in steps:
            if isinstance(element, Unknown):
                return element, fragment[behind:]
            element = self._step(element, step)
            if element is None:
                break
            behind += len(step) + 1
        return None, ""

    def _root(self, index: str) -> Element | None:
        if not _INDEX.fullmatch(index):
            return None
        number = int(index or 0)
        return self.roots[number] if number < len(self.roots) else None

    def _step(self, parent: Element | None, step: str) -> Element | None:
        if parent is not None and not step.startswith("@"):
            return self.names.inside(parent).get(unquote(step))
        match = _STEP.fullmatch(step)
        metaclass = type(parent)._mmrs_metaclass if parent is not None else None
        if match is None or parent is None or metaclass is None:
            return None
        feature = metaclass.by_name.get(match["name"])
        if feature is None or not feature.is_reference:
            return None
        value = raw(parent, feature)
        values: Sequence[object] = value if isinstance(value, list) else (value,)
        if match["keys"]:
            found = _by_keys(values, _keys(match["keys"]))
        else:
            index = int(match["index"] or 0)
            found = values[index] if index < len(values) else None
        return found if isinstance(found, Element) else None


def _keys(text: str) -> dict[str, str | None]:
    """Return the attributes and their values in a step such as ``[name='a%20b',number='1']``."""
    return {
        key["name"]: None if key["null"] else unquote(key["single"] or key["double"] or "")
        for key in _KEY.finditer(text)
    }


def _by_keys(values: Sequence[object], wanted: dict[str, str | None]) -> object:
    for value in values:
        if wanted and isinstance(value, Element) and _has(value, wanted):
            return value
    return None


def _has(element: Element, wanted: dict[str, str | None]) -> bool:
    metaclass = type(element)._mmrs_metaclass
    features = metaclass.by_name if metaclass is not None else {}
    for name, text in wanted.items():
        feature = features.get(name)
        if feature is None or isinstance(feature.type, Metaclass):
            return False
        value = getattr(element, feature.attribute)
        if (feature.type.render(value) if feature.type.accepts(value) else None) != text:
            return False
    return True
