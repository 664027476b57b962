"""Which packages the given metamodels consist of, and which package a URI in one of them means."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os.path import isfile
from pathlib import Path
from urllib.parse import unquote

from mmrs_core.errors import PluginError
from mmrs_core.languages.datatypes import ECORE, XML_TYPES
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.metamodels.nodes import Tree, read_tree
from mmrs_core.languages.metamodels.parsing import read_tables
from mmrs_core.languages.metamodels.tables import PackageTable
from mmrs_core.languages.references.hrefs import real_path

_OF_ECLIPSE = {
    "/org.eclipse.emf.ecore/model/Ecore.ecore": ECORE,
    "/org.eclipse.emf.ecore/model/XMLType.ecore": XML_TYPES,
}


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
            yield from _flat(Located(table, provider, real_path(ecore), ecore))
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

    def __init__(self, located: Iterable[Located], known: Iterable[Package]) -> None:
        """Take the packages being assembled, and those that stand already."""
        self._roots: dict[Path, dict[int, str]] = {}
        self._files: dict[str, Path | None] = {}
        self._parents: dict[str, str] = {}
        self._children: dict[tuple[str, str], str] = {}
        self._trees: dict[Path, Tree] = {}
        for package in known:
            file = real_path(package.ecore) if isinstance(package.ecore, Path) else None
            self._enter(package.ns_uri, package.name, package.parent, file, package.root)
        self._given: dict[str, set[Path]] = {}
        for entry in located:
            self._enter(entry.table.ns_uri, entry.table.name, entry.parent, entry.file, entry.table.root)
            if entry.file is not None:
                self._given.setdefault(entry.file.name, set()).add(entry.file)

    def _enter(self, ns_uri: str, name: str, parent: str, file: Path | None, root: int) -> None:
        self._parents[ns_uri] = parent
        self._children[parent, name] = ns_uri
        self._files[ns_uri] = file
        if file is not None and not parent:
            self._roots.setdefault(file, {})[root] = ns_uri

    def find(self, uri: str, referrer: Located) -> tuple[str, str]:
        """Return nsURI and class name of what the URI means.

        Raises:
            PluginError: if no package at hand is meant.
        """
        ns_uri, names = self._descend(uri, referrer, 1)
        return ns_uri, names[0]

    def find_feature(self, uri: str, referrer: Located) -> tuple[str, str, str]:
        """Return nsURI, class name and name of the feature that the URI means; errors as in `find`."""
        ns_uri, names = self._descend(uri, referrer, 2)
        return ns_uri, names[0], names[1]

    def document(self, document: str, referrer: Located, uri: str) -> tuple[str, Path | None]:
        """Return the nsURI of the first package of the document that a name means, and its file.

        A document that is named by an nsURI has that package as its first.

        Args:
            document: the part of the URI before the hash; empty for the referring document itself.
            referrer: the package whose file refers.
            uri: the whole URI, for the message.

        Raises:
            PluginError: if no package at hand is meant.
        """
        found = self._named(document) or self._file(document, referrer) if document else self._own(referrer)
        if found is None:
            beside = "" if ":" in document else f" beside {referrer.file or referrer.table.name}"
            raise _fault(referrer, f"needs the metamodel {_cut(document)}{beside} ({_cut(uri)})", " ")
        return found

    def _descend(self, uri: str, referrer: Located, wanted: int) -> tuple[str, list[str]]:
        """Return the package that a URI leads into, and so many names of what it leads to there."""
        document, _, fragment = uri.partition("#")
        ns_uri, file = self.document(document, referrer, uri)
        top, *names = self._by_names(fragment, file)
        if len(names) < wanted or not names[-1]:
            raise _fault(referrer, f"{_cut(uri)} names no {'class' if wanted == 1 else 'reference'}")
        if top not in ("", "0"):
            number = int(top) if len(top) < 9 and top.isdecimal() else -1
            ns_uri = self._roots.get(file, {}).get(number, "") if file is not None else ""
            if not ns_uri:
                raise _fault(referrer, f"{_cut(uri)}: no package {_cut(top)} in that file")
        for step in names[:-wanted]:
            if (ns_uri, step) not in self._children:
                raise _fault(referrer, f"{_cut(uri)}: no package {_cut(step)}")
            ns_uri = self._children[ns_uri, step]
        return ns_uri, names[-wanted:]

    def _by_names(self, fragment: str, file: Path | None) -> list[str]:
        """Return the steps of a fragment; one with positions or by an id is looked up in the file."""
        if fragment.startswith("/") and "@" not in fragment and "%" not in fragment:
            return fragment[1:].split("/")
        if file is None:
            return [""]
        if file not in self._trees:
            self._trees[file] = read_tree(file)
        found = self._trees[file].fragment(fragment)
        return [""] if found is None else found[1:].split("/")

    def _own(self, referrer: Located) -> tuple[str, Path | None] | None:
        if referrer.file is not None:
            return self._first(referrer.file)
        ns_uri = referrer.table.ns_uri
        while parent := self._parents.get(ns_uri, ""):
            ns_uri = parent
        return ns_uri, None

    def _named(self, document: str) -> tuple[str, Path | None] | None:
        """Return the package that an nsURI or a place in Eclipse itself means."""
        known = next((uri for place, uri in _OF_ECLIPSE.items() if document.endswith(place)), document)
        if known in self._parents or known.startswith("http://www.eclipse.org/emf/200"):
            return known, self._files.get(known)
        return None

    def _file(self, document: str, referrer: Located) -> tuple[str, Path | None] | None:
        path = unquote(document)
        if referrer.file is not None and ":" not in path and "\0" not in path:
            beside = real_path(referrer.file.parent / path)
            new = beside not in self._roots and not path.startswith(("/", "\\"))
            if new and isfile(beside):  # noqa: PTH113  Path.is_file raises for long names
                tables = read_tables(beside)
                known = {table.root: table.ns_uri for table in tables if table.ns_uri in self._parents}
                self._roots[beside] = known
            if found := self._first(beside):
                return found
        same = self._given.get(path.rpartition("/")[2], set())
        return self._first(next(iter(same))) if len(same) == 1 else None

    def _first(self, file: Path) -> tuple[str, Path | None] | None:
        roots = self._roots.get(file)
        return (roots[min(roots)], file) if roots else None


def _cut(text: str) -> str:
    """Return a text for a message, not longer than anybody reads."""
    return text if len(text) <= 120 else f"{text[:117]}..."


def _fault(referrer: Located, reason: str, between: str = ": ") -> PluginError:
    return PluginError(f"{referrer.provider}: {referrer.table.ns_uri}{between}{reason}")
