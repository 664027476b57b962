"""Writes the files of a new plug-in: all of them, or none."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import fields
from pathlib import Path
from tempfile import mkdtemp
from typing import Literal, TypeAlias, get_args

from mmrs_core.errors import MmrsError
from mmrs_core.generation.environment import environment_in, rendered
from mmrs_core.generation.scaffolding.names import PluginNames
from mmrs_core.generation.stubs.write import write_stubs
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.sources import MetamodelSource
from mmrs_core.resources import shipped

Geometry: TypeAlias = Literal["polygon", "line", "point"]
GEOMETRIES: tuple[Geometry, ...] = get_args(Geometry)
PARTS = ("task", "robot", "target", "check", "vehicle")
"""The contributions that a plug-in can begin with."""

_PLAIN = re.compile(r"[A-Za-z0-9 .,:;=#'/()_-]*")
_ENDING = ".jinja"


def write_plugin(
    names: PluginNames,
    parts: Collection[str],
    geometry: Geometry,
    folder: Path,
    installed: Iterable[MetamodelSource] = (),
) -> tuple[Path, ...]:
    """Write a plug-in into a new or empty folder; return its files, sorted.

    Args:
        names: of the plug-in.
        parts: some of `PARTS`.
        geometry: of its task.
        folder: of the plug-in.
        installed: metamodels of other plug-ins.

    Raises:
        MmrsError: if the folder is not empty, or is a file.
        OSError: if the folder cannot be written to.
    """
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise MmrsError(f"{folder}: is not a folder; nothing was written")
    if folder.exists() and any(folder.iterdir()):
        raise MmrsError(f"{folder}: is not empty; nothing was written")
    folder.parent.mkdir(parents=True, exist_ok=True)
    staged = Path(mkdtemp(prefix=".mmrs-", dir=folder.parent))
    try:
        _fill(staged, plugin_files(names, parts, geometry), names, installed)
        if folder.exists():
            folder.rmdir()
        staged.rename(folder)
    except BaseException:
        shutil.rmtree(staged, ignore_errors=True)
        raise
    folder.chmod(0o755)
    return tuple(sorted(file for file in folder.rglob("*") if file.is_file()))


def plugin_files(names: PluginNames, parts: Collection[str], geometry: Geometry) -> dict[str, bytes]:
    """Return the content of each file by its path in the plug-in's folder, with forward slashes.

    The type stubs of the metamodel are not included: they are generated from it.
    """
    folder = shipped("codegen_templates") / "plugin"
    filters: dict[str, Callable[..., str]] = {"plain": plain}
    environment = environment_in(folder, filters)
    view = {each.name: getattr(names, each.name) for each in fields(names)}
    view |= {"title": names.title, "kind": geometry, "parts": tuple(parts), "model": _has_model(parts)}
    environment.globals.update(view)  # what templates import sees globals only
    return {
        path: rendered(environment, template, view).encode()
        for path, template in sorted(_paths(folder, names, parts, geometry))
    }


def plain(value: object) -> str:
    """Return a text without characters that have a meaning in any of the files.

    Raises:
        ValueError: if it has one.
    """
    text = str(value)
    if not _PLAIN.fullmatch(text):
        raise ValueError(f"{text!r} is not plain")
    return text


def _has_model(parts: Collection[str]) -> bool:
    return bool({"task", "robot"} & set(parts))


def _paths(
    folder: Path, names: PluginNames, parts: Collection[str], geometry: Geometry
) -> Iterator[tuple[str, str]]:
    """Yield the path of each file with its template's name."""
    for part in ("common", *(("model",) if _has_model(parts) else ()), *parts):
        for file in (folder / part).rglob(f"*{_ENDING}"):
            inside = file.relative_to(folder / part).as_posix()
            path = re.sub("^package/", f"{names.package}/", inside.removesuffix(_ENDING))
            yield path.replace("language.ecore", f"{names.language}.ecore"), f"{part}/{inside}"
    if "task" in parts:
        for module in ("rule.py", "constraints.py"):
            yield f"{names.package}/{module}", f"{geometry}/{module}{_ENDING}"


def _fill(
    folder: Path, content: dict[str, bytes], names: PluginNames, installed: Iterable[MetamodelSource]
) -> None:
    for path, text in content.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text)
    metamodel = folder / names.package / "metamodels" / f"{names.language}.ecore"
    if metamodel.exists():
        registry, ns_uris = registry_of_files([metamodel], installed)
        write_stubs(registry, ns_uris, folder / names.package)
