"""Reads mapping files and checks them against the languages that they lead to."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_flyaq.rules.mapping import DialectMapping
from mmrs_flyaq.rules.paths import Classes
from mmrs_flyaq.rules.rules_file import read_rules
from mmrs_flyaq.rules.toml_tables import Table, line_of
from mmrs_flyaq.sources.documents import KnownDocument
from mmrs_flyaq.sources.metamodels import Dialect
from mmrs_flyaq.sources.structure import Structure, declared_structure

LARGEST = 4 * 1024 * 1024

_LINE = re.compile(r"at line (\d+)")


def read_mapping(path: Path, registry: Registry) -> DialectMapping:
    """Return the mapping in a file.

    Raises:
        UnreadableError: if it is not a mapping, or names a class or feature that no installed language has;
            with the line.
    """
    return _read(path, lambda top: _mapping(top, registry))


def read_dialect(path: Path) -> DialectMapping:
    """Return the mapping in a file without its rules, which tells the files that it is for.

    Raises:
        UnreadableError: if it is not a mapping; with the line.
    """
    return _read(path, _without_rules)


def _read(path: Path, made_of: Callable[[Table], DialectMapping]) -> DialectMapping:
    try:
        text = read_bytes(path, LARGEST).decode()
        value = tomllib.loads(text)
    except ValueError as fault:  # neither UTF-8 nor TOML, or a number that Python does not read
        line = _LINE.search(str(fault))
        place = f"{path}:{line[1]}" if line else str(path)
        raise UnreadableError(f"{place}: not TOML: {str(fault).lower()}") from None
    except RecursionError:
        raise UnreadableError(f"{path}: nested too deeply") from None
    top = Table(str(path), value)
    if not value.get("rules"):
        raise top.fault("contains no rules")
    try:
        return made_of(top)
    except UnreadableError as fault:
        raise UnreadableError(_with_line(str(fault), str(path), text)) from None


def _with_line(message: str, path: str, text: str) -> str:
    """Return a message that begins with a file and keys in it, with the line of the deepest key."""
    said = message.removeprefix(f"{path}: ")
    line = line_of(text, said.split(": "), re.split(r": |\.", said))
    return f"{path}:{line}: {said}" if line else message


def _mapping(top: Table, registry: Registry) -> DialectMapping:
    languages = top.table("languages").text_by_key()
    for prefix, ns_uri in languages.items():
        if not registry.has(ns_uri):
            raise top.fault(f"languages: {prefix}: {ns_uri} is not installed")
    found = _without_rules(top)
    rules = read_rules(top.table("rules"), Classes(registry, languages), found.structure)
    top.done()
    return replace(found, rules=rules)


def _without_rules(top: Table) -> DialectMapping:
    structure = _structure(top)
    dialect = _dialect(top.table("packages"))
    for package in sorted({kind.partition(".")[0] for kind in structure.classes} - set(dialect.uris)):
        raise top.fault(f"packages: {package}: needs 'uris' or 'files', which its models name")
    return DialectMapping(
        name=top.take("name", str, "") or top.where,
        dialect=dialect,
        structure=structure,
        rules={},
        types=top.table("types").text_by_key(),
        documents=tuple(_document(name, table) for name, table in top.table("documents").tables().items()),
    )


def _dialect(packages: Table) -> Dialect:
    uris, files = {}, {}
    for name, table in packages.tables().items():
        uris[name] = table.texts("uris")
        files[name] = table.texts("files")
        if not (uris[name] or files[name]):
            raise table.fault("needs 'uris' or 'files', which its models name")
        files[name] = files[name] or (f"{name}.ecore",)
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
    plain = table.plain(KnownDocument, name="is", holds="models")
    found = KnownDocument(**{**plain, "name": plain["name"] or name})
    if not found.under and not found.keys:
        raise table.fault("needs 'under' or 'keys', which such a file is recognised by")
    table.done()
    return found
