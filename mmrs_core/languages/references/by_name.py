"""How a document that is being written refers to elements by name, where that leads to them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from pathlib import Path

from mmrs_core.languages.element import Element, Hidden, label_of
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.addresses import identifier_of
from mmrs_core.languages.references.named import NamedElements
from mmrs_core.languages.references.spelling import quoted, spelt

NAMELESS = "without a name"
SHARED = "with a name that others have"
FAR = "in files where names are not looked for"
HIDDEN = "of languages that are not installed"


class ReferenceNames:
    """The names that references of one document become.

    Attributes:
        named: how many references were asked for and are written as names.
        left: how many are not, by what their elements are.
    """

    def __init__(
        self,
        roots: Sequence[Element],
        others: Iterable[Sequence[Element]] = (),
        is_near: Callable[[Path], bool] = lambda file: False,
    ) -> None:
        """Take the document, and what else its readers look for names in.

        Args:
            roots: of the document.
            others: the roots of each of the other files.
            is_near: whether names lead into a file from the document, given its real path.
        """
        self.named = 0
        self.left: Counter[str] = Counter()
        self._is_near = is_near
        self._here = NamedElements(roots)
        self._there = [NamedElements(each) for each in others]
        self._identifiers = {identifier_of(element) for element in self._here.all}

    def text(self, element: Element, feature: Feature, target: Element, in_list: bool) -> str | None:
        """Return what refers to an element by its name; None where that does not lead to it.

        Args:
            element: the one that refers.
            feature: in which it does.
            target: to what.
            in_list: whether the text stands among others, divided by blanks.
        """
        name = label_of(target)
        text = self._spelt(name, in_list)
        reason = self._reason_against(name, element, feature, target) or ("" if text else SHARED)
        if reason:
            self.left[reason] += 1
            return None
        self.named += 1
        return text

    def _spelt(self, name: str, in_list: bool) -> str:
        """Return how a name is written so as not to be taken for an identifier; empty where it always is."""
        return next(
            (each for each in (spelt(name, in_list), quoted(name)) if each not in self._identifiers), ""
        )

    def _reason_against(self, name: str, element: Element, feature: Feature, target: Element) -> str:
        kind = feature.type
        if isinstance(target, Hidden) or not isinstance(kind, Metaclass):
            return HIDDEN
        if not name:
            return NAMELESS
        found = self._here.nearest(name, kind, element)
        if not found:
            source = target._mmrs_source
            if source is None or source.path is None or not self._is_near(source.path):
                return FAR
            elsewhere = chain.from_iterable(each.nearest(name, kind, None) for each in self._there)
            found = list(dict.fromkeys(elsewhere))
        return "" if len(found) == 1 and found[0] is target else SHARED
