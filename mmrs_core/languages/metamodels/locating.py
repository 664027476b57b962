"""Which packages the given metamodels consist of, and which package a URI in one of them means."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

from mmrs_core.errors import PluginError
from mmrs_core.languages.metamodels.tables import PackageTable, read_tables


@dataclass(frozen=True, slots=True)
class Located:
    """A package, and where it came from.

    Attributes:
        file: the real path of its .ecore file; None for a pyecore EPackage.
        ecore: the file or EPackage as it was given.
        parent: nsURI of the package it stands in; empty at the top.
    """

    table: PackageTable
    provider: str
    file: Path | None
    ecore: Path | object
    parent: str = ""


def locate_all(sources: Iterable[tuple[str, Path | object, str]]) -> list[Located]:
    """Return the packages of all sources (nsURI, ecore, provider), those inside others included.

    Raises:
        PluginError: if a source does not hold the nsURI that it announces.
        UnreadableError: if a file is no metamodel.
    """
    found: list[Located] = []
    for ns_uri, ecore, provider in sources:
        packages = list(_open(ecore, provider))
        if ns_uri not in [package.table.ns_uri for package in packages]:
            held = ", ".join(package.table.ns_uri for package in packages)
            raise PluginError(f"{provider}: {_label(ecore)} holds {held}, not {ns_uri}")
        found.extend(packages)
    return found


def _open(ecore: Path | object, provider: str) -> Iterable[Located]:
    if isinstance(ecore, Path):
        for table in read_tables(ecore):
            yield from _flat(Located(table, provider, ecore.resolve(), ecore))
        return
    from mmrs_core.languages.ecore_api.tables import package_table  # pyecore costs 0.2 s of start-up

    yield from _flat(Located(package_table(ecore), provider, None, ecore))


def _flat(package: Located) -> Iterable[Located]:
    yield package
    for inner in package.table.subpackages:
        parent = package.table.ns_uri
        yield from _flat(Located(inner, package.provider, package.file, package.ecore, parent))


def _label(ecore: Path | object) -> str:
    return str(ecore) if isinstance(ecore, Path) else f"EPackage {getattr(ecore, 'name', '?')}"


class Directory:
    """Finds the package and class that a URI in an .ecore means, without ever touching the network.

    A document is named by an nsURI, by a path relative to the referring file, or by a ``platform:`` path of
    Eclipse. Where a relative path leads nowhere, as in a workspace of Eclipse projects that were moved,
    the only given file of the same name is taken.
    """

    def __init__(self, located: Iterable[Located], known: Mapping[str, str]) -> None:
        """Take the packages being assembled, and (nsURI to parent's nsURI) those that stand already."""
        self._by_file: dict[Path, list[Located]] = {}
        self._parents = dict(known)
        self._children: dict[tuple[str, str], str] = {}
        for entry in located:
            self._parents[entry.table.ns_uri] = entry.parent
            self._children[entry.parent, entry.table.name] = entry.table.ns_uri
            if entry.file is not None and not entry.parent:
                self._by_file.setdefault(entry.file, []).append(entry)

    def find(self, uri: str, referrer: Located) -> tuple[str, str]:
        """Return nsURI and class name of what the URI means.

        Raises:
            PluginError: if no package at hand is meant.
        """
        document, _, fragment = uri.partition("#")
        top, *steps = fragment.lstrip("#").removeprefix("/").split("/")
        if not steps or not steps[-1]:
            raise PluginError(f"{referrer.provider}: {referrer.table.ns_uri}: {uri} names no class")
        ns_uri = self.document(document, int(top) if top.isascii() and top.isdigit() else 0, referrer, uri)
        for step in steps[:-1]:
            if (ns_uri, step) not in self._children:
                raise PluginError(f"{referrer.provider}: {referrer.table.ns_uri}: {uri}: no package {step}")
            ns_uri = self._children[ns_uri, step]
        return ns_uri, steps[-1]

    def document(self, document: str, root: int, referrer: Located, uri: str) -> str:
        """Return the nsURI of the package that a document's name means.

        Args:
            document: the part of the URI before the hash; empty for the referring document itself.
            root: which of the packages at the top of the document, where it has several.
            referrer: the package whose file refers.
            uri: the whole URI, for the message.

        Raises:
            PluginError: if no package at hand is meant.
        """
        if not document:
            return self._own(referrer, root)
        if document in self._parents or document.startswith("http://www.eclipse.org/emf/200"):
            return document
        if document.endswith("/org.eclipse.emf.ecore/model/Ecore.ecore"):
            return "http://www.eclipse.org/emf/2002/Ecore"
        found = self._file(document, root, referrer)
        if found is None:
            needed = (
                document if ":" in document else f"{document} beside {referrer.file or referrer.table.name}"
            )
            raise PluginError(
                f"{referrer.provider}: {referrer.table.ns_uri} needs the metamodel {needed} ({uri})"
            )
        return found

    def _file(self, document: str, root: int, referrer: Located) -> str | None:
        path = unquote(document)
        if referrer.file is not None and ":" not in path:
            beside = (referrer.file.parent / path).resolve()
            if beside in self._by_file:
                return _nth(self._by_file[beside], root)
            if beside.is_file() and (ns_uri := read_tables(beside)[0].ns_uri) in self._parents:
                return ns_uri
        name = path.rpartition("/")[2]
        same = [entries for file, entries in self._by_file.items() if file.name == name]
        return _nth(same[0], root) if len(same) == 1 else None

    def _own(self, referrer: Located, root: int) -> str:
        if referrer.file is not None:
            return (root and _nth(self._by_file[referrer.file], root)) or self._top(referrer)
        return self._top(referrer)

    def _top(self, referrer: Located) -> str:
        ns_uri = referrer.table.ns_uri
        while parent := self._parents.get(ns_uri, ""):
            ns_uri = parent
        return ns_uri


def _nth(entries: list[Located], index: int) -> str | None:
    return entries[index].table.ns_uri if index < len(entries) else None
