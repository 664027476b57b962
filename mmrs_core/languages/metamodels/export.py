"""All metamodels side by side in one folder, as Eclipse needs them to open models without registration."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path

from mmrs_core.errors import MmrsError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.metamodels.locating import Directory, Located
from mmrs_core.languages.metamodels.tables import PackageTable
from mmrs_core.languages.metamodels.text import package_text
from mmrs_core.languages.references.hrefs import relative_href
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.writing import replace_file
from mmrs_core.languages.xmi.events import Document, read_bytes

_REFERENCE = re.compile(r"""\b(eType|eSuperTypes|eOpposite|eClassifier|eKeys)=(["'])(.*?)\2""", re.DOTALL)

_RECORD = ".mmrs-export.json"
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

    Models point there by what `schema_locations` returns.
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


def schema_locations(registry: Registry, directory: Path, file: Path) -> dict[str, str]:
    """Return where the metamodels exported to a folder lie, by nsURI, as a model file has to say it.

    Given to `write_model`, it lets Eclipse open the file without any metamodel being registered.

    Args:
        registry: the metamodels.
        directory: where `export_metamodels` has put them.
        file: the model file; paths are relative to its folder.
    """
    names = exported_names(registry)
    base = file.resolve().parent
    places: dict[str, str] = {}
    for package in registry.packages:  # one package comes before those inside it
        if not package.parent:
            places[package.ns_uri] = relative_href(directory.resolve() / names[package.ns_uri], base)
        else:
            above = places[package.parent]
            places[package.ns_uri] = f"{above}{'/' if '#' in above else '#//'}{package.name}"
    return places


def export_metamodels(registry: Registry, directory: Path, *, force: bool = False) -> list[Path]:
    """Write all metamodels, with references relative to each other, and an Eclipse project around them.

    Which files were written, and what was in them, is kept in ``.mmrs-export.json`` beside them.

    Args:
        registry: the metamodels.
        directory: made if need be; what else is in it stays.
        force: replace files that somebody else wrote or changed. A metamodel that is installed from
            there is never replaced.

    Returns:
        The paths of the written files.

    Raises:
        MmrsError: if files would be replaced that must not be; lists all of them.
        OSError: if the folder cannot be written to.
    """
    names = exported_names(registry)
    rewriter = _Rewriter(registry, names)
    texts = {
        names[package.ns_uri]: rewriter.text(package) for package in registry.packages if not package.parent
    }
    files = {name: text.encode() for name, text in {".project": _PROJECT, **texts}.items()}
    sources = [package.ecore for package in registry.packages if isinstance(package.ecore, Path)]
    _refuse(directory, [name for name in files if _is_any(directory / name, sources)], "installed from there")
    if not force:
        _refuse(directory, _others(directory, files), "not as an export left them; --force replaces them")
    directory.mkdir(parents=True, exist_ok=True)
    hashes = {name: _hash(data) for name, data in files.items()}
    for name, data in {**files, _RECORD: json.dumps(hashes, indent=2).encode() + b"\n"}.items():
        replace_file(directory / name, data)
    return [directory / name for name in files]


def _others(directory: Path, files: Mapping[str, bytes]) -> list[str]:
    """Return which files are there with a content that neither is exported now nor was before."""
    recorded = _recorded(directory / _RECORD)
    return [
        name
        for name, data in files.items()
        if os.path.lexists(directory / name)
        and _content(directory / name) not in (_hash(data), recorded.get(name))
    ]


def _content(path: Path) -> str:
    """Return the hash of a file; empty for what is no file that can be read."""
    try:
        return _hash(path.read_bytes()) if path.is_file() else ""
    except OSError:
        return ""


def _recorded(path: Path) -> Mapping[str, str]:
    """Return the hashes by name that an export left; without a sound record, none are known."""
    try:
        found = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return {}
    return (
        {name: each for name, each in found.items() if isinstance(each, str)}
        if isinstance(found, dict)
        else {}
    )


def _refuse(directory: Path, names: list[str], why: str) -> None:
    if names:
        raise MmrsError(f"{', '.join(str(directory / name) for name in names)}: {why}")


def _is_any(path: Path, files: Iterable[Path]) -> bool:
    return path.exists() and any(file.exists() and path.samefile(file) for file in files)


def _hash(data: bytes) -> str:
    return sha256(data).hexdigest()


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
