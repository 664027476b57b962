"""A model: what one file holds, and what is wrong with the file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.diagnostics import Diagnostic
from mmrs_core.languages.element import Element, descendants

if TYPE_CHECKING:
    from mmrs_core.languages.importers import Importer


@dataclass(frozen=True, slots=True)
class Model:
    """The elements of one file, or of none.

    Attributes:
        file: the path as the user gave it, or a text that messages may use.
        roots: the elements at the top, in file order.
        diagnostics: every fault found while reading this file.
        linked: the other files that references led to, in the order in which they were met.
        broken: the features (element, name) that a reported fault left without their value.
        importer: what imported the file, which another tool wrote; None for a file in the languages of its
            elements.
    """

    file: Path | str
    roots: tuple[Element, ...]
    diagnostics: tuple[Diagnostic, ...] = ()
    linked: tuple[Model, ...] = ()
    broken: frozenset[tuple[Element, str]] = frozenset()
    importer: Importer | None = None

    def elements(self) -> Iterator[Element]:
        """Yield all elements in document order."""
        for root in self.roots:
            yield root
            yield from descendants(root)
