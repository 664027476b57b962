"""Which package, class or feature a reference in an .ecore file means, without ever touching the network."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os.path import isfile
from pathlib import Path
from typing import NoReturn
from urllib.parse import unquote

from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages.datatypes import ECORE, XML_TYPES, shown
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.metamodels.ecore_file import EcoreFile, EcoreNode, read_ecore
from mmrs_core.languages.references.hrefs import real_path

_OF_ECLIPSE = {
    "/org.eclipse.emf.ecore/model/Ecore.ecore": ECORE,
    "/org.eclipse.emf.ecore/model/XMLType.ecore": XML_TYPES,
}
Address = tuple[str, ...]
"""nsURI and class name, with the feature's name behind them where a feature is meant."""


@dataclass(frozen=True, slots=True)
class Located:
    """A package, and where it came from.

    Attributes:
        ecore: the .ecore file or EPackage as it was given.
        parent: nsURI of the package it stands in; empty at the top.
        root: which of the elements at the top of its file it is, or stands in, counted from 0.
        path: the real path of its .ecore file; None for a pyecore EPackage.
        file, node: the file and the element that describe it; None for an EPackage, and for what stands.
    """

    ns_uri: str
    name: str
    provider: str
    ecore: Path | object
    parent: str = ""
    root: int = 0
    path: Path | None = None
    file: EcoreFile | None = None
    node: EcoreNode | None = None

    def refuse(self, reason: str, node: EcoreNode | None = None, between: str = ": ") -> NoReturn:
        """Raise the error for something in it, with the position of the element, if one is given."""
        place = (
            f"{self.file.name}:{node.line}" if self.file is not None and node is not None else self.provider
        )
        raise PluginError(f"{place}: {self.ns_uri}{between}{reason}")


def located_in(ecore: Path, provider: str) -> list[Located]:
    """Return the packages of a file, those inside others included; messages name who brings it.

    Raises:
        UnreadableError: if the file is not a metamodel.
    """
    who = "" if provider in (str(ecore), ecore.name) else f"{provider}: "
    try:
        file = read_ecore(ecore)
    except UnreadableError as fault:
        raise UnreadableError(
            f"{who}{fault}", code=fault.code, reason=fault.reason, file=fault.file, line=fault.line
        ) from None
    file.name = f"{who}{file.name}"
    path = real_path(ecore)
    return [
        Located(node.get("nsURI"), node.get("name"), provider, ecore, parent, root, path, file, node)
        for node, root, parent in file.packages()
    ]


def standing(package: Package) -> Located:
    """Return where a package that stands already came from."""
    path = real_path(package.ecore) if isinstance(package.ecore, Path) else None
    return Located(
        package.ns_uri, package.name, package.provider, package.ecore, package.parent, package.root, path
    )


class Directory:
    """Finds what a URI in an .ecore file means.

    A document is named by an nsURI, by a path relative to the referring file, or by a ``platform:`` path of
    Eclipse. Where a relative path leads nowhere, as in a workspace of Eclipse projects that were moved,
    the only given file of the same name is taken.
    """

    def __init__(self, located: Iterable[Located], known: Iterable[Package], lenient: bool = False) -> None:
        """Take the packages to be loaded, and those that stand; what others are called passes if lenient."""
        self._lenient = lenient
        self._roots: dict[Path, dict[int, str]] = {}
        self._paths: dict[str, Path | None] = {}
        self._parents: dict[str, str] = {}
        self._children: dict[tuple[str, str], str] = {}
        self._files: dict[Path, EcoreFile] = {}
        self._given: dict[str, set[Path]] = {}
        for package in known:
            self._enter(standing(package))
        for entry in located:
            self._enter(entry)
            if entry.path is not None:
                self._given.setdefault(entry.path.name, set()).add(entry.path)

    def _enter(self, entry: Located) -> None:
        self._parents[entry.ns_uri] = entry.parent
        self._children[entry.parent, entry.name] = entry.ns_uri
        self._paths[entry.ns_uri] = entry.path
        if entry.path is not None and entry.file is not None:
            self._files[entry.path] = entry.file
        if entry.path is not None and not entry.parent:
            self._roots.setdefault(entry.path, {})[entry.root] = entry.ns_uri

    def find(self, uri: str, referrer: Located, node: EcoreNode, wanted: int, name: str) -> Address:
        """Return what a URI means.

        Args:
            uri: from the file, such as ``document#//Class``.
            referrer: the package whose file refers.
            node: the element that refers, for the message.
            wanted: 1 for a class, 2 for a feature.
            name: of the reference, for the message.

        Raises:
            UnreadableError: if there is no such element in the file itself.
            PluginError: if no package at hand is meant.
        """
        document, _, fragment = uri.rpartition("#")
        ns_uri, path = self.document(document, referrer, uri, node)
        names = self._by_names(fragment, path)
        if names is None and not document and referrer.file is not None:
            referrer.file.refuse(node, f"{name}: {shown(uri)} leads to no element")
        if names is None and self._lenient:
            names = ["", fragment]
        top, *names = names or [""]
        if len(names) < wanted or not names[-1]:
            referrer.refuse(f"{_cut(uri)} names no {'class' if wanted == 1 else 'reference'}", node)
        if top not in ("", "0"):
            number = int(top) if len(top) < 9 and top.isdecimal() else -1
            ns_uri = self._roots.get(path, {}).get(number, "") if path is not None else ""
            if not ns_uri:
                referrer.refuse(f"{_cut(uri)}: no package {_cut(top)} in that file", node)
        for step in names[:-wanted]:
            if (ns_uri, step) not in self._children and not self._lenient:
                referrer.refuse(f"{_cut(uri)}: no package {_cut(step)}", node)
            ns_uri = self._children.get((ns_uri, step), ns_uri)
        return (ns_uri, *names[-wanted:])

    def document(
        self, document: str, referrer: Located, uri: str, node: EcoreNode | None = None
    ) -> tuple[str, Path | None]:
        """Return the nsURI of the first package of the document that a name means, and its file.

        A document that is named by an nsURI has that package as its first; an empty name means the
        referring document itself.

        Raises:
            PluginError: if no package at hand is meant.
        """
        found = self._named(document) or self._beside(document, referrer) if document else self._own(referrer)
        if found is None and self._lenient:
            return document, None
        if found is None:
            beside = "" if ":" in document else f" beside {referrer.path or referrer.name}"
            referrer.refuse(f"needs the metamodel {_cut(document)}{beside} ({_cut(uri)})", node, " ")
        return found

    def _by_names(self, fragment: str, path: Path | None) -> list[str] | None:
        """Return the steps of a fragment; one with positions or by an id is looked up in the file."""
        if fragment.startswith("/") and "@" not in fragment and "%" not in fragment:
            return fragment[1:].split("/")
        if path is None:
            return None
        if path not in self._files:
            self._files[path] = read_ecore(path)
        return self._files[path].named(fragment)

    def _own(self, referrer: Located) -> tuple[str, Path | None] | None:
        if referrer.path is not None:
            return self._first(referrer.path)
        ns_uri = referrer.ns_uri
        while parent := self._parents.get(ns_uri, ""):
            ns_uri = parent
        return ns_uri, None

    def _named(self, document: str) -> tuple[str, Path | None] | None:
        """Return the package that an nsURI or a place in Eclipse itself means."""
        known = next((uri for place, uri in _OF_ECLIPSE.items() if document.endswith(place)), document)
        if known in self._parents or known.startswith("http://www.eclipse.org/emf/200"):
            return known, self._paths.get(known)
        return None

    def _beside(self, document: str, referrer: Located) -> tuple[str, Path | None] | None:
        place = unquote(document)
        if referrer.path is not None and ":" not in place and "\0" not in place:
            beside = real_path(referrer.path.parent / place)
            new = beside not in self._roots and not place.startswith(("/", "\\"))
            if new and isfile(beside):  # noqa: PTH113  Path.is_file raises for long names
                file = self._files[beside] = read_ecore(beside)
                tops = {root: node.get("nsURI") for node, root, parent in file.packages() if not parent}
                self._roots[beside] = {root: uri for root, uri in tops.items() if uri in self._parents}
            if found := self._first(beside):
                return found
        same = self._given.get(place.rpartition("/")[2], set())
        return self._first(next(iter(same))) if len(same) == 1 else None

    def _first(self, path: Path) -> tuple[str, Path | None] | None:
        roots = self._roots.get(path)
        return (roots[min(roots)], path) if roots else None


def _cut(text: str) -> str:
    """Return a text for a message, cut to a readable length."""
    return text if len(text) <= 120 else f"{text[:117]}..."
