"""The text of a metamodel as it stands beside the others in one folder, with references that fit there."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from mmrs_core.errors import PluginError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.metamodels.ecore_file import LARGEST_METAMODEL
from mmrs_core.languages.metamodels.locating import Directory, standing
from mmrs_core.languages.metamodels.text import package_text
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.escapes import in_attribute
from mmrs_core.languages.xmi.events import Document, read_bytes

_LINKS = ("eType", "eSuperTypes", "eOpposite", "eKeys", "eClassifier", "eTypeParameter", "eExceptions")
_REFERRING = frozenset((*_LINKS, "references", "href"))
_DECLARED = re.compile(r"""\A(<\?xml\b[^>]*?\bencoding\s*=\s*)(?:"[^"]*"|'[^']*')""")
_TAG = re.compile(rb"<[^\s<>/=]+")
_ATTRIBUTE = re.compile(rb"""\s+([^\s<>/="']+)\s*=\s*("[^"]*"|'[^']*')""")


class Rewriter:
    """Writes metamodels for a folder where all stand side by side."""

    def __init__(self, registry: Registry, names: Mapping[str, str]) -> None:
        """Take the metamodels, and the name of the file that each of them gets, by nsURI."""
        self._names = names
        self._packages = {package.ns_uri: package for package in registry.packages}
        self._located = {package.ns_uri: standing(package) for package in registry.packages}
        self._directory = Directory(self._located.values(), ())

    def text(self, package: Package) -> str:
        """Return the text of the file of a package at the top.

        Raises:
            UnreadableError: if its file cannot be read any more.
        """
        if not isinstance(package.ecore, Path):
            return package_text(package, lambda ns_uri: self._address(ns_uri, package))
        data = _as_utf8(read_bytes(package.ecore, LARGEST_METAMODEL), str(package.ecore))
        document = Document(data, str(package.ecore))
        places = _Places(document)
        document.parse(places)
        pieces, done = [], 0
        for offset, attributes in places.found:
            for begin, end, name in _values(data, offset):
                if name in attributes:
                    pieces += [data[done:begin], self._attribute(attributes[name], package)]
                    done = end
        return b"".join((*pieces, data[done:])).decode()

    def _attribute(self, value: str, package: Package) -> bytes:
        tokens = " ".join(self._token(token, package) for token in value.split())
        return f'"{in_attribute(tokens)}"'.encode()

    def _token(self, token: str, package: Package) -> str:
        document, hash_, fragment = token.partition("#")
        if not hash_ or not document:
            return token
        referrer = self._located[package.ns_uri]
        with suppress(PluginError):  # an annotation may refer to what is not a metamodel, and stays as it is
            ns_uri, file = self._directory.document(document, referrer, token)
            if ns_uri not in self._packages:
                return token
            if document == ns_uri and fragment.startswith("//"):
                return self._address(ns_uri, package) + fragment.removeprefix("//")
            return f"{'' if file == referrer.path else self._names[ns_uri]}#{fragment}"
        return token

    def _address(self, ns_uri: str, referrer: Package) -> str:
        """Return what stands before the name of a class of that package, in the file of the referrer."""
        if ns_uri == ECORE or ns_uri not in self._packages:
            return f"{ns_uri}#//"
        steps = []
        package = self._packages[ns_uri]
        while package.parent:
            steps.append(package.name)
            package = self._packages[package.parent]
        file = self._names[package.ns_uri]
        own = "" if file == self._names[referrer.ns_uri] else file
        return f"{own}#/{package.root or ''}/{''.join(f'{step}/' for step in reversed(steps))}"


def _as_utf8(data: bytes, file: str) -> bytes:
    """Return the text of an XML file in UTF-8, and saying so."""
    document = Document(data, file)
    document.parse(_Deaf())
    wide = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16", b"<\0": "utf-16-le", b"\0<": "utf-16-be"}
    text = data.decode(wide.get(data[:2], document.encoding), "replace").removeprefix("\ufeff")
    return _DECLARED.sub(r'\1"UTF-8"', text).encode()


def _values(data: bytes, offset: int) -> list[tuple[int, int, str]]:
    """Return begin, end and name of the quoted values in the tag that begins there."""
    found = []
    match = _TAG.match(data, offset)
    while match is not None:
        match = _ATTRIBUTE.match(data, match.end())
        if match is not None:
            found.append((match.start(2), match.end(2), match[1].decode()))
    return found


class _Places:
    """Notes where references to other documents stand, with their values."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self.found: list[tuple[int, dict[str, str]]] = []

    def start(self, tag: str, attributes: list[str]) -> None:
        """Note those of an element."""
        pairs = zip(attributes[::2], attributes[1::2], strict=True)
        referring = {name: value for name, value in pairs if name in _REFERRING and "#" in value}
        if referring:
            self.found.append((self._document.offset, referring))

    def end(self, tag: str) -> None:
        """Pass over."""

    def text(self, text: str) -> None:
        """Pass over."""


class _Deaf:
    """Ignores all events: only the encoding of the document is needed."""

    def start(self, tag: str, attributes: list[str]) -> None:
        """Pass over."""

    def end(self, tag: str) -> None:
        """Pass over."""

    def text(self, text: str) -> None:
        """Pass over."""
