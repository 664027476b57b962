"""Models of other tools, which are migrated while they are read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from mmrs_core.diagnostics import Diagnostic
from mmrs_core.languages.element import Element
from mmrs_core.languages.xmi.events import read_bytes

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry


@dataclass(frozen=True, slots=True)
class Foreign:
    """A file that a dialect recognised.

    Attributes:
        content: what the dialect makes elements of; means nothing to anybody else.
        is_guess: whether nobody knows its nsURI, and its classes are only called as the dialect's are.
    """

    dialect: Dialect
    content: object
    is_guess: bool = False


@dataclass(frozen=True, slots=True)
class Migrated:
    """What a file of a dialect became.

    Attributes:
        roots: elements of the registry's languages, all of them with the line that they were made of.
        diagnostics: what was not carried over just as it was.
    """

    roots: tuple[Element, ...]
    diagnostics: tuple[Diagnostic, ...]


class Dialect(Protocol):
    """Reads files of another tool as models of the languages in a registry."""

    @property
    def name(self) -> str:
        """Return what messages call it."""

    def recognised(self, data: bytes, file: str, registry: Registry, *, stored: bool) -> Foreign | None:
        """Return a file of this dialect; None for any other, and for what is no model at all.

        Args:
            stored: whether there is such a file, beside which metamodels may lie.
        """

    def ready(self, file: Foreign, registry: Registry) -> Foreign:
        """Return a file that it recognised, with all that is needed to migrate it.

        Raises:
            UnreadableError: with a code, if it cannot be migrated.
        """

    def migrated(
        self, files: Sequence[Foreign], registry: Registry, known: Sequence[Element]
    ) -> tuple[Migrated, ...]:
        """Return what files became, in their order.

        Args:
            files: all that belong together.
            known: elements of other files that these may name, such as robot types.
        """

    def quiet(self) -> Dialect:
        """Return the same dialect, which does not list what is not just as it was."""


def is_of_dialect(path: Path, registry: Registry) -> bool:
    """Return whether a file is one of the registry's dialects.

    Raises:
        UnreadableError: as `Dialect.ready`, or if the file is missing.
    """
    return recognised(read_bytes(path), str(path), registry) is not None


def recognised(data: bytes, file: str, registry: Registry, *, stored: bool = True) -> Foreign | None:
    """Return a file of one of the registry's dialects; None for any other. Errors as in `Dialect.ready`."""
    known = [each.recognised(data, file, registry, stored=stored) for each in registry.dialects]
    found = sorted((each for each in known if each is not None), key=lambda each: each.is_guess)
    return found[0].dialect.ready(found[0], registry) if found else None
