"""Fragments by position, as most elements of large models have them; worked out for siblings together."""

from __future__ import annotations

from collections.abc import Sequence

from mmrs_core.languages.element import Element
from mmrs_core.languages.links import raw
from mmrs_core.languages.source import Source


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
