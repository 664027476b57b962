"""Reads mapping files and checks them against the languages that they lead to."""

from __future__ import annotations

import tomllib
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_core.migration.rules.mapping import DialectMapping
from mmrs_core.migration.rules.notation import declared_structure
from mmrs_core.migration.rules.rules_file import read_rules
from mmrs_core.migration.rules.toml_tables import Table
from mmrs_core.migration.sources.documents import KnownDocument
from mmrs_core.migration.sources.metamodels import Dialect
from mmrs_core.migration.sources.structure import Structure

LARGEST = 4 * 1024 * 1024


def read_mapping(path: Path, registry: Registry) -> DialectMapping:
    """Return the mapping in a file.

    Raises:
        UnreadableError: if it is no mapping, or leads to a class or feature that no installed language has;
            says where.
    """
    try:
        value = tomllib.loads(read_bytes(path, LARGEST).decode())
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as fault:
        raise UnreadableError(f"{path}: not TOML: {str(fault).lower()}") from None
    top = Table(str(path), value)
    mapping = _mapping(top, registry)
    top.done()
    return mapping


def _mapping(top: Table, registry: Registry) -> DialectMapping:
    languages = top.table("languages").text_by_key()
    for prefix, ns_uri in languages.items():
        if not registry.has(ns_uri):
            raise top.fault(f"languages: {prefix}: {ns_uri} is not installed")
    structure = _structure(top)
    return DialectMapping(
        name=top.take("name", str, "") or top.where,
        dialect=_dialect(top.table("packages")),
        structure=structure,
        rules=read_rules(top.table("rules"), languages, registry, structure),
        types=top.table("types").text_by_key(),
        documents=tuple(_document(name, table) for name, table in top.table("documents").tables().items()),
    )


def _dialect(packages: Table) -> Dialect:
    uris, files = {}, {}
    for name, table in packages.tables().items():
        uris[name] = table.texts("uris")
        files[name] = table.texts("files") or (f"{name}.ecore",)
        table.done()
    return Dialect(uris, files)


def _structure(top: Table) -> Structure:
    packages = {
        package: {name: classes.texts(name) for name in classes.keys}
        for package, classes in top.table("structure").tables().items()
    }
    try:
        return declared_structure(packages)
    except ValueError as fault:
        raise top.fault(f"structure: {fault}") from None


def _document(name: str, table: Table) -> KnownDocument:
    found = KnownDocument(
        table.take("is", str, "") or name,
        table.take("under", str, ""),
        table.texts("keys"),
        table.take("models", bool, False),
    )
    if not found.under and not found.keys:
        raise table.fault("needs 'under' or 'keys', which such a file is recognised by")
    table.done()
    return found
