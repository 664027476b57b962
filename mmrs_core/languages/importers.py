"""Importers of other tools' models, which read their files as models of the installed languages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.diagnostics import Diagnostic
from mmrs_core.languages.element import Element
from mmrs_core.languages.xmi.events import read_bytes

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry


@dataclass(frozen=True, slots=True)
class Recognition:
    """A file that an importer recognises.

    Attributes:
        content: whatever the importer needs to convert it.
        is_guess: whether its nsURI is unknown, and only its class names are those of the tool.
    """

    content: object
    is_guess: bool = False


@dataclass(frozen=True, slots=True)
class Imported:
    """The result of importing one file.

    Attributes:
        roots: elements of the registry's languages, each with the line of its source.
        diagnostics: what was changed or not carried over.
    """

    roots: tuple[Element, ...]
    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class Importer:
    """An importer of another tool's models, which every command then accepts.

    Attributes:
        name: the tool's models in messages, such as "Kite planner 3".
        recognise: (data, file, registry, stored) to a `Recognition`; None for a file that is not entirely of
            the tool. `stored`: whether the file exists, so that metamodels may lie next to it.
        prepare: (candidate, file, registry) to a `Recognition` ready to be converted; raises UnreadableError
            with a code if the file cannot be imported.
        convert: (candidates, registry, known, notes) to one `Imported` for each candidate. The candidates
            belong together; `known` are elements of other files that they may name, such as robot types;
            without `notes`, changes are counted instead of listed.
        covers: whether an nsURI is one of the tool's languages.
        advice: how users get files of the installed languages, such as "'mmrs migrate' creates a project".
        notes: whether changes are listed.
    """

    name: str
    recognise: Callable[[bytes, str, Registry, bool], Recognition | None]
    prepare: Callable[[Recognition, str, Registry], Recognition]
    convert: Callable[[Sequence[Recognition], Registry, Sequence[Element], bool], Sequence[Imported]]
    covers: Callable[[str], bool]
    advice: str = ""
    notes: bool = True


@dataclass(frozen=True, slots=True)
class ForeignFile:
    """A file, the importer that reads it, and what that needs."""

    importer: Importer
    candidate: Recognition


def is_importable(path: Path, registry: Registry) -> bool:
    """Return whether an importer recognises a file.

    Raises:
        UnreadableError: if it cannot be imported, or is missing.
    """
    return foreign_file(read_bytes(path), str(path), registry) is not None


def foreign_file(data: bytes, file: str, registry: Registry, *, stored: bool = True) -> ForeignFile | None:
    """Return a file with its importer; None if no importer recognises it.

    An importer that knows the file's nsURI takes precedence over one that only knows its class names.

    Raises:
        UnreadableError: if the file cannot be imported.
    """
    found: ForeignFile | None = None
    for importer in registry.importers:
        candidate = importer.recognise(data, file, registry, stored)
        if candidate is not None and (found is None or found.candidate.is_guess > candidate.is_guess):
            found = ForeignFile(importer, candidate)
    if found is None:
        return None
    return replace(found, candidate=found.importer.prepare(found.candidate, file, registry))
