"""Writes several files, all or none."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator, Mapping
from errno import EEXIST, ENOTEMPTY
from pathlib import Path

from mmrs_core.languages.writing import part_of, replace_file


def replace_files(texts: Mapping[Path, bytes]) -> None:
    """Put texts into files, and make the folders that they need.

    Raises:
        OSError: if one cannot be written; all files and folders are as they were before, except those
            that it names because they could not be put back. A folder with new files of other
            programs stays.
    """
    before: dict[Path, bytes | None] = {}
    folders: list[Path] = []
    parts: dict[Path, Path] = {}
    try:
        for file, text in texts.items():
            _make_for(file, folders)
            before[file] = file.read_bytes() if file.exists() else None
            parts[file] = part_of(file, text)
        for file, part in parts.items():
            part.replace(file.resolve())
    except BaseException as error:
        for part in parts.values():
            part.unlink(missing_ok=True)
        if lost := [*_put_back(before), *_take_away(folders)]:
            why = str(error) or type(error).__name__
            raise OSError(f"{why}; and not as before: {', '.join(map(str, lost))}") from error
        raise


def make_folder(folder: Path, texts: Mapping[Path, bytes]) -> None:
    """Make a folder with files in it, in one step that a crash cannot divide.

    Raises:
        OSError: if it cannot be made; nothing is there then.
    """
    if folder.exists():
        replace_files(texts)
        return
    made: list[Path] = []
    part = folder.with_name(f".{folder.name}.{os.getpid()}.part")
    try:
        _make_for(part, made)
        replace_files({part / file.relative_to(folder): text for file, text in texts.items()})
        part.rename(folder)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        list(_take_away(made))
        raise


def _make_for(file: Path, made: list[Path]) -> None:
    """Make the folders that a file needs, outer ones first; each is reported as soon as it exists."""
    for folder in [folder for folder in file.parents if not folder.exists()][::-1]:
        folder.mkdir()
        made.append(folder)


def _put_back(before: Mapping[Path, bytes | None]) -> Iterator[Path]:
    """Give files their old content, and yield those for which that fails; None: there was no file."""
    for file, text in before.items():
        try:
            if text is None:
                file.unlink(missing_ok=True)
            elif file.read_bytes() != text:
                replace_file(file, text)
        except OSError:
            yield file


def _take_away(folders: list[Path]) -> Iterator[Path]:
    """Remove folders, inner ones first, and yield those for which that fails though they are empty."""
    for folder in reversed(folders):
        try:
            folder.rmdir()
        except OSError as error:
            if error.errno not in (ENOTEMPTY, EEXIST):
                yield folder
