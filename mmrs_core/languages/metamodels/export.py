"""All metamodels side by side in one folder, as Eclipse needs them to open models without registration."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Collection, Iterable, Mapping
from hashlib import sha256
from pathlib import Path

from mmrs_core.errors import MmrsError
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.metamodels.rewriting import Rewriter
from mmrs_core.languages.references.hrefs import relative_href
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.writing import replace_file

_UNSAFE = re.compile(r"[^\w.-]+")
_LONGEST_NAME = 60
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

    Models point there by what `schema_locations` returns. Packages of one file stay in one file.
    """
    names: dict[str, str] = {}
    files: dict[Path, str] = {}
    for package in registry.packages:
        if package.parent:
            continue
        source = package.ecore if isinstance(package.ecore, Path) else None
        name = files.get(source) if source is not None else None
        if name is None:
            name = _free_name(package, {each.casefold() for each in names.values()})
        if source is not None:
            files[source] = name
        names[package.ns_uri] = name
    return names


def _free_name(package: Package, taken: Collection[str]) -> str:
    """Return a name for the file of a package, which may call itself what no file can be called."""
    stem = _UNSAFE.sub("_", package.name).strip(".")[:_LONGEST_NAME] or "metamodel"
    name, number = f"{stem}.ecore", len(taken)
    while name.casefold() in taken:
        name, number = f"{stem}-{number}.ecore", number + 1
    return name


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
            place = relative_href(directory.resolve() / names[package.ns_uri], base)
            places[package.ns_uri] = f"{place}#/{package.root}" if package.root else place
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
        force: replace files that were written or changed by others. A metamodel that is installed from
            there is never replaced.

    Returns:
        The paths of the written files.

    Raises:
        MmrsError: if files would be replaced that must not be; lists all of them.
        OSError: if the folder cannot be written to.
    """
    names = exported_names(registry)
    rewriter = Rewriter(registry, names)
    tops = {names[package.ns_uri]: package for package in registry.packages if not package.parent}
    texts = {name: rewriter.text(package) for name, package in tops.items()}
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
    """Return the hash of a file; empty for what is not a file that can be read."""
    try:
        return _hash(path.read_bytes()) if path.is_file() else ""
    except OSError:
        return ""


def _recorded(path: Path) -> Mapping[str, str]:
    """Return the hashes by name that an export left; without a sound record, none are known."""
    try:
        found = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
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
