"""All metamodels side by side in one folder, as Eclipse needs them to open models without registration."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.ecore_tables import PackageTable
from mmrs_core.languages.ecore_text import package_text
from mmrs_core.languages.locating import Directory, Located
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.writing import replace_file
from mmrs_core.languages.xml_events import Document, read_bytes

_REFERENCE = re.compile(r"""\b(eType|eSuperTypes|eOpposite|eClassifier|eKeys)=(["'])(.*?)\2""", re.DOTALL)

_PROJECT = """<?xml version="1.0" encoding="UTF-8"?>
<projectDescription>
\t<name>mmrs-metamodels</name>
\t<comment></comment>
\t<projects></projects>
\t<buildSpec></buildSpec>
\t<natures></natures>
</projectDescription>
"""


def exported_names(registry: Registry) -> dict[str, str]:
    """Return the file name that each metamodel gets, by nsURI; packages inside others have no own file.

    Models point there by ``schema_location`` of `to_xmi`.
    """
    names: dict[str, str] = {}
    for package in registry.packages:
        if package.parent:
            continue
        name = f"{package.name}.ecore"
        if name in names.values():
            name = f"{package.name}-{len(names)}.ecore"
        names[package.ns_uri] = name
    return names


def export_metamodels(registry: Registry, directory: Path) -> list[Path]:
    """Write all metamodels, with references relative to each other, and an Eclipse project around them.

    Returns:
        The paths of the written files; the folder is made if need be, and what else is in it stays.

    Raises:
        OSError: if the folder cannot be written to.
    """
    names = exported_names(registry)
    rewriter = _Rewriter(registry, names)
    texts = {
        names[package.ns_uri]: rewriter.text(package) for package in registry.packages if not package.parent
    }
    directory.mkdir(parents=True, exist_ok=True)
    written = []
    for name, text in {".project": _PROJECT, **texts}.items():
        replace_file(directory / name, text.encode())
        written.append(directory / name)
    return written


class _Rewriter:
    def __init__(self, registry: Registry, names: Mapping[str, str]) -> None:
        self._names = names
        self._packages = {package.ns_uri: package for package in registry.packages}
        self._located = {package.ns_uri: _located(package) for package in registry.packages}
        self._directory = Directory(self._located.values(), {})

    def text(self, package: Package) -> str:
        if not isinstance(package.ecore, Path):
            return package_text(package, lambda ns_uri: self._address(ns_uri, package))
        data = read_bytes(package.ecore)
        document = Document(data, str(package.ecore))
        document.parse(_Deaf())
        text = document.data.decode(document.encoding)
        text = re.sub(r'(<\?xml[^>]*encoding=")[^"]*', r"\1UTF-8", text.removeprefix("\ufeff"), count=1)
        return _REFERENCE.sub(lambda match: self._attribute(match, package), text)

    def _attribute(self, match: re.Match[str], package: Package) -> str:
        tokens = [self._token(token, package) for token in match[3].split()]
        return f"{match[1]}={match[2]}{' '.join(tokens)}{match[2]}"

    def _token(self, token: str, package: Package) -> str:
        document, hash_, fragment = token.partition("#")
        if not hash_ or not document:
            return token
        ns_uri = self._directory.document(document, 0, self._located[package.ns_uri], token)
        if ns_uri not in self._packages:
            return token
        return self._address(ns_uri, package) + fragment.lstrip("/")

    def _address(self, ns_uri: str, referrer: Package) -> str:
        """Return what stands before the name of a class of that package, in the file of the referrer."""
        if ns_uri == ECORE or ns_uri not in self._packages:
            return f"{ns_uri}#//"
        steps = []
        package = self._packages[ns_uri]
        while package.parent:
            steps.append(package.name)
            package = self._packages[package.parent]
        file = "" if package.ns_uri == referrer.ns_uri else self._names[package.ns_uri]
        return f"{file}#//{''.join(f'{step}/' for step in reversed(steps))}"


def _located(package: Package) -> Located:
    file = package.ecore.resolve() if isinstance(package.ecore, Path) else None
    table = PackageTable(package.ns_uri, package.name, package.prefix)
    return Located(table, package.provider, file, package.ecore, package.parent)


class _Deaf:
    """Hears nothing: only the encoding of the document is wanted."""

    def start(self, tag: str, attributes: list[str]) -> None:
        """Pass over."""

    def end(self, tag: str) -> None:
        """Pass over."""

    def text(self, text: str) -> None:
        """Pass over."""
