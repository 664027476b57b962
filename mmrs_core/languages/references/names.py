"""Fragments by names, as ``//sub/A``, by which EMF refers to classes and whatever else Ecore gives a name.

Source: ``EModelElementImpl.eObjectForURIFragmentSegment`` of EMF 2.29.
"""

from __future__ import annotations

from urllib.parse import quote

from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.element import Element, contents


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
