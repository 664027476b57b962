"""Writes a new plug-in: the whole of it, or nothing."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path
from tempfile import mkdtemp

from mmrs_core.errors import MmrsError
from mmrs_core.generation.scaffolding.files import TaskKind, metamodel_path, plugin_files
from mmrs_core.generation.scaffolding.names import PluginNames
from mmrs_core.generation.stubs.write import write_stubs
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.sources import MetamodelSource


def write_plugin(
    names: PluginNames, kind: TaskKind, folder: Path, installed: Iterable[MetamodelSource] = ()
) -> tuple[Path, ...]:
    """Write a plug-in into a folder that is empty or not there; return its files, sorted.

    Args:
        names: of the plug-in.
        kind: what its task is about.
        folder: of the plug-in.
        installed: metamodels of other plug-ins.

    Raises:
        MmrsError: if there is something in the folder, or it is a file.
        OSError: if the folder cannot be written to.
    """
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise MmrsError(f"{folder}: is not a folder; nothing was written")
    if folder.exists() and any(folder.iterdir()):
        raise MmrsError(f"{folder}: there is something in it; nothing was written")
    folder.parent.mkdir(parents=True, exist_ok=True)
    staged = Path(mkdtemp(prefix=".mmrs-", dir=folder.parent))
    try:
        _fill(staged, names, kind, installed)
        if folder.exists():
            folder.rmdir()
        staged.rename(folder)
    except BaseException:
        shutil.rmtree(staged, ignore_errors=True)
        raise
    folder.chmod(0o755)
    return tuple(sorted(file for file in folder.rglob("*") if file.is_file()))


def _fill(folder: Path, names: PluginNames, kind: TaskKind, installed: Iterable[MetamodelSource]) -> None:
    for path, content in plugin_files(names, kind).items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
    registry, ns_uris = registry_of_files([folder / metamodel_path(names)], installed)
    write_stubs(registry, ns_uris, folder / names.package)
