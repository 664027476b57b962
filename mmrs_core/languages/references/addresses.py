"""How a document that is being written refers to elements, its own and those of other files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from mmrs_core.languages.element import Element, Hidden, Unknown, held, holds, metaclass_of, path_of, root_of
from mmrs_core.languages.links import LinkedList, raw
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.documents import Names
from mmrs_core.languages.references.hidden import strayed
from mmrs_core.languages.references.hrefs import relative_href
from mmrs_core.languages.sources import Source

_ID = re.compile(r"[^\s#:%/][^\s#:%]*")


class Addresses:
    """Fragments and hrefs, each computed once."""

    def __init__(self, roots: Sequence[Element], file: Path | None) -> None:
        """Take the roots of the document, and the file it is for (None: not known)."""
        self._roots = roots
        self._here = {id(root) for root in roots}
        self._sources = {id(root._mmrs_source) for root in roots if root._mmrs_source is not None}
        self._folder = file.resolve().parent if file is not None else None
        self._entered: dict[int, str] = {}
        self._names = Names()

    def stands_here(self, element: Element) -> bool:
        """Return whether the document holds the element, or the unknown one around it."""
        if isinstance(element, Hidden):
            element = element._mmrs_outer
        return id(element) in self._fragments()

    def stands_elsewhere(self, element: Element) -> bool:
        """Return whether a contained element is the root of another file, and stays there."""
        source = element._mmrs_source
        if source is None or source.path is None or id(source) in self._sources or id(element) in self._here:
            return False
        return any(root is element for root in source.roots)

    def stands_apart(self, element: Element) -> bool:
        """Return whether a root of the document is contained in an element of another file."""
        container = element._mmrs_container
        return container is not None and id(element) in self._here and not self.stands_here(container)

    def is_blank(self, element: Element, feature: Feature) -> bool:
        """Return whether the file of an element says that nothing is in a feature, which is not silence."""
        source = element._mmrs_source
        return source is not None and (element, feature) in source.blanks

    def fragment(self, element: Element) -> str:
        """Return the fragment of an element of this document."""
        if isinstance(element, Hidden):
            return _inside(self.fragment(element._mmrs_outer), element)
        return self._fragments()[id(element)]

    def refuse_strays(self, element: Unknown) -> None:
        """Refuse an unknown element whose text refers to others that stand elsewhere now.

        Raises:
            ValueError: if it does: the text is kept as it was read, and would refer to other elements.
        """
        path = strayed(element, self._roots)
        if path:
            name = element._mmrs_type.rpartition("#")[2]
            message = (
                f"{path_of(element)}: the {name} is kept as it was read, and {path} in it leads elsewhere now"
            )
            raise ValueError(
                f"{message}; install what brings {element._mmrs_type}, or keep the elements in place"
            )

    def identifier(self, element: Element) -> str | None:
        """Return the ``xmi:id`` that its file gave to an element."""
        source = element._mmrs_source
        return source.ids.get(element) if source is not None and source.ids else None

    def href(self, element: Element) -> str:
        """Return the reference to an element.

        Raises:
            ValueError: if it stands neither here nor in a file.
        """
        if self.stands_here(element):
            return f"#{self.fragment(element)}"
        if isinstance(element, Hidden):
            document, _, fragment = self.href(element._mmrs_outer).rpartition("#")
            return f"{document}#{_inside(fragment, element)}"
        top = root_of(element)
        for candidate in _upwards(element):
            if candidate._mmrs_source is not None and candidate in candidate._mmrs_source.roots:
                top = candidate
                break
        source = top._mmrs_source
        if source is not None and source.ns_uri and (names := self._names.fragment(top, element)) is not None:
            return f"{source.ns_uri}#{names}"
        if source is None or source.path is None or top not in source.roots:
            raise ValueError(f"refers to {element!r}, which stands in no file")
        if self._folder is None:
            raise ValueError(f"refers to {source.file}; state the file that the model is written to")
        return f"{relative_href(source.path, self._folder)}#{self._fragment_in(source, top, element)}"

    def _fragment_in(self, source: Source, top: Element, element: Element) -> str:
        own = _own_id(element)
        if own is not None:
            return own
        if len(source.roots) == 1 and (names := self._names.fragment(top, element)) is not None:
            return names
        steps = []
        while element is not top:
            container, feature = element._mmrs_container, element._mmrs_feature
            assert container is not None  # top is above it
            assert feature is not None
            values = raw(container, feature)
            index = f".{values.position(element)}" if isinstance(values, LinkedList) else ""
            steps.append(f"/@{feature.name}{index}")
            element = container
        number = str(source.roots.index(top)) if len(source.roots) > 1 else ""
        return f"/{number}{''.join(reversed(steps))}"

    def _fragments(self) -> dict[int, str]:
        """Return the fragments of all elements; computed at the first request."""
        if not self._entered:
            for index, root in enumerate(self._roots):
                self._enter(root, f"/{index}" if len(self._roots) > 1 else "/")
        return self._entered

    def _enter(self, root: Element, fragment: str) -> None:
        pending = [(root, fragment)]
        while pending:
            element, fragment = pending.pop()
            self._entered[id(element)] = _own_id(element) or fragment
            metaclass = type(element)._mmrs_metaclass
            for feature in metaclass.features if metaclass is not None else ():
                if not feature.containment:
                    continue
                for index, value in enumerate(held(element, feature)):
                    if isinstance(value, Element) and not self.stands_elsewhere(value):
                        step = f"/@{feature.name}.{index}" if feature.many else f"/@{feature.name}"
                        pending.append((value, fragment + step))


def _inside(outer: str, element: Hidden) -> str:
    """Return the fragment of what stands inside an unknown element, given that of the element."""
    rest = element._mmrs_rest
    return f"{outer}{rest}" if rest.startswith("/") else rest


def _own_id(element: Element) -> str | None:
    """Return the value of its id attribute, or the ``xmi:id`` that its file gave to it, fit to refer with.

    A text that readers would not take for one id, such as two words, is none: then the path refers.
    """
    identifier = identifier_of(element)
    return identifier if identifier is not None and _ID.fullmatch(identifier) else None


def identifier_of(element: Element) -> str | None:
    """Return the value of its id attribute, or the ``xmi:id`` that its file gave to it; None without."""
    if element._mmrs_source is not None and element in element._mmrs_source.ids:
        return element._mmrs_source.ids[element]
    if type(element)._mmrs_metaclass is None:
        return None
    for feature in metaclass_of(element).features:
        if feature.is_id and holds(element, feature) and not isinstance(feature.type, Metaclass):
            for value in held(element, feature):
                return feature.type.render(value) if feature.type.accepts(value) else None
    return None


def _upwards(element: Element) -> list[Element]:
    chain = [element]
    while (container := chain[-1]._mmrs_container) is not None:
        chain.append(container)
    return chain


class Positions(dict[Element, str]):
    """The fragment of each element of a document that is asked for, such as ``//@tasks.0``.

    Only for elements that have no identifier, come from the document's own file or from none, and are held by
    what contains them, up to a root. For all else, what is given as ``unanswered`` is raised.
    """

    def __init__(self, roots: Sequence[Element], home: Source | None, unanswered: type[Exception]) -> None:
        """Take the roots of the document and the file that they were read from (None: from none)."""
        super().__init__()
        self._home = home
        self._unanswered = unanswered
        self._nameless: dict[type, bool] = {}
        for index, root in enumerate(roots):
            if self._plain(root):
                self[root] = f"/{index}" if len(roots) > 1 else "/"

    def __missing__(self, element: object) -> str:
        """Work out the fragments of an element and of all beside it."""
        chain = []
        current = element
        while current not in self:
            if not isinstance(current, Element):  # above the outermost container stands None
                raise self._unanswered
            chain.append(current)
            current = current._mmrs_container
        for each in reversed(chain):
            if each not in self:
                self._number(each)
        assert isinstance(element, Element)  # it is in the chain
        return self[element]

    def _number(self, element: Element) -> None:
        """Enter an element and all beside it, once its container is entered."""
        container, feature = element._mmrs_container, element._mmrs_feature
        assert container is not None  # it is entered
        assert feature is not None  # set together with the container
        begin = f"{self[container]}/@{feature.name}"
        value = raw(container, feature)
        if isinstance(value, list):
            fragments = map(f"{begin}.".__add__, map(str, range(len(value))))
            plain = self._plain
            if all(map(plain, value)):
                self.update(zip(value, fragments, strict=True))
            else:
                self.update(pair for pair in zip(value, fragments, strict=True) if plain(pair[0]))
        elif value is element and self._plain(element):
            self[element] = begin
        if element not in self:
            raise self._unanswered

    def _plain(self, element: Element) -> bool:
        """Whether position is all that there is to refer to it by."""
        source = element._mmrs_source
        if source is not None and source is not self._home:
            return False
        known = self._nameless.get(element.__class__)
        if known is None:
            metaclass = type(element)._mmrs_metaclass
            known = metaclass is None or not any(feature.is_id for feature in metaclass.features)
            self._nameless[element.__class__] = known
        return known
