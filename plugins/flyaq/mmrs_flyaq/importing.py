"""Importers of models that a mapping file describes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages.importers import Imported, Importer, Recognition

if TYPE_CHECKING:
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.registry import Registry
    from mmrs_flyaq.recognition import Recognised
    from mmrs_flyaq.rules.mapping import DialectMapping

ADVICE = "'mmrs migrate' makes a project of it"


def importer_of(name: str, mapping: Path) -> Importer:
    """Return the importer of a dialect.

    Args:
        name: the dialect in messages.
        mapping: the mapping file; docs/migrate.md explains its keys.
    """
    return Importer(
        name,
        recognise=partial(_recognise, name, mapping),
        prepare=partial(_prepare, name, mapping),
        convert=partial(_convert, name),
        covers=lambda ns_uri: _dialect(name, mapping).dialect.has(ns_uri),
        advice=ADVICE,
    )


def recognised_in(candidate: Recognition) -> Recognised | None:
    """Return what an importer of this plug-in recognised; None if another plug-in's importer did."""
    from mmrs_flyaq.recognition import Recognised

    return candidate.content if isinstance(candidate.content, Recognised) else None


def _dialect(name: str, mapping: Path) -> DialectMapping:
    from mmrs_flyaq.rules.mapping_file import read_dialect

    try:
        return read_dialect(mapping)
    except UnreadableError as fault:
        raise PluginError(f"dialect '{name}': {fault}") from fault


def _recognise(
    name: str, mapping: Path, data: bytes, file: str, registry: Registry, stored: bool
) -> Recognition | None:
    from mmrs_flyaq.recognition import recognised

    found = recognised(data, file, _dialect(name, mapping), registry)
    return Recognition(replace(found, stored=stored), found.is_guess) if found is not None else None


def _prepare(name: str, mapping: Path, candidate: Recognition, file: str, registry: Registry) -> Recognition:
    from mmrs_flyaq.rules.mapping_file import read_mapping

    found = recognised_in(candidate)
    assert found is not None  # as `_recognise` made it
    if found.opened.document is None:
        raise UnreadableError.of("FIL009", found.opened.what, file)
    try:
        rules = read_mapping(mapping, registry)
    except UnreadableError as fault:
        raise UnreadableError.of("FIL010", f"of {name}, and not migrated: {fault}", file) from fault
    return replace(candidate, content=replace(found, mapping=rules))


def _convert(
    name: str, candidates: Sequence[Recognition], registry: Registry, known: Sequence[Element], notes: bool
) -> Sequence[Imported]:
    from mmrs_flyaq.in_memory import migrated

    found = [each for each in map(recognised_in, candidates) if each is not None]
    return migrated(found, name, registry, known, notes=notes)
