"""Where elements and metamodels come from; plug-ins import it without loading the languages."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.metaclass import Feature


@dataclass(frozen=True, slots=True)
class MetamodelSource:
    """A metamodel that a plug-in provides.

    Attributes:
        ns_uri: of the package, as its file states it.
        ecore: the .ecore file, a pyecore EPackage, or a module that pyecoregen wrote.
        provider: the distribution that brings it.
    """

    ns_uri: str
    ecore: Path | object
    provider: str = "core"


class Source:
    """A file that elements were read from; to those who know pyecore, a resource that can only be read.

    Attributes:
        file: the path as the user gave it; what messages say.
        path: where it lies; None for text that came from no file.
        roots: the elements at its top.
        ids: the identifiers that the file itself gave to elements (``xmi:id``).
        blanks: the unsettable features that the file states to be nil or empty; EMF takes them for set.
        ns_uri: of the metamodel that it describes, if it was made of one; empty for a file.
    """

    __slots__ = ("blanks", "file", "ids", "ns_uri", "path", "roots")

    def __init__(self, file: str, path: Path | None) -> None:
        self.file = file
        self.path = path
        self.ns_uri = ""
        self.roots: tuple[Element, ...] = ()
        self.ids: dict[Element, str] = {}
        self.blanks: set[tuple[Element, Feature]] = set()

    @property
    def uri(self) -> Any:  # pyecore has no types
        """The path as the user gave it, as a pyecore ``URI``."""
        from pyecore.resources import URI  # pyecore costs 0.2 s of start-up

        return URI(self.file)

    @property
    def contents(self) -> list[Element]:
        """The elements at its top."""
        return list(self.roots)

    def number(self, root: Element) -> str:
        """Return what tells a root from the others, such as ``/1``; nothing if there are no others."""
        if len(self.roots) < 2:
            return ""
        return next((f"/{number}" for number, each in enumerate(self.roots) if each is root), "")
