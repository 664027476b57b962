"""Writes generated files, and never over a hand-written one.

A file is overwritten only if the folder's manifest lists it and it is still as it was generated; a
file that was changed by hand, or that was not generated, stops everything before anything is
written. Files that a former run generated and this one does not are removed if they are unchanged.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from hashlib import sha256
from pathlib import Path

from mmrs_core.contributions.targets import GeneratedFile
from mmrs_core.errors import InternalError, MmrsError
from mmrs_core.generation.manifest import Recorded, read_manifest
from mmrs_core.languages.writing import replace_files


def write(files: Iterable[GeneratedFile], directory: Path, *, force: bool = False) -> tuple[Path, ...]:
    """Write the files of one target into a folder, all or none; return what was written.

    Args:
        files: as rendered, the manifest last.
        directory: made where it is missing.
        force: overwrite files that were changed by hand or come from elsewhere, too. Files that
            belong to the user once written stay as they are even then.

    Raises:
        MmrsError: something in the folder must not be overwritten; lists all of it.
        UnreadableError: the folder's manifest is not a manifest.
        OSError: the folder cannot be written to.
    """
    files = tuple(files)
    if not files:
        return ()
    manifest = read_manifest(directory / files[-1].path)
    known = {entry.path: entry for entry in manifest.files} if manifest is not None else {}
    written = [file for file in files if not (file.once and (directory / file.path).exists())]
    if not force:
        _refuse_strangers(written[:-1], directory, known)
    for file in written:
        _check_inside(directory, file.path)
    replace_files({directory / file.path: file.content for file in written})
    _remove_stale({file.path for file in files}, directory, known)
    return tuple(directory / file.path for file in written)


def _refuse_strangers(files: Sequence[GeneratedFile], directory: Path, known: dict[str, Recorded]) -> None:
    strangers = [
        f"{directory / file.path}: " + ("was changed by hand" if file.path in known else "was not generated")
        for file in files
        if (directory / file.path).exists()
        and (directory / file.path).read_bytes() != file.content
        and not _untouched(directory, known.get(file.path))
    ]
    if strangers:
        raise MmrsError("; ".join(strangers) + ": would be overwritten")


def _untouched(directory: Path, entry: Recorded | None) -> bool:
    if entry is None or not (directory / entry.path).is_file():
        return False
    return sha256((directory / entry.path).read_bytes()).hexdigest() == entry.sha256


def _check_inside(directory: Path, path: str) -> None:
    if not (directory / path).resolve().is_relative_to(directory.resolve()):
        raise InternalError(f"{path}: leads out of {directory}")


def _remove_stale(current: set[str], directory: Path, known: dict[str, Recorded]) -> None:
    for path, entry in known.items():
        if path not in current and not entry.once and _untouched(directory, entry):
            _check_inside(directory, path)
            (directory / path).unlink()
