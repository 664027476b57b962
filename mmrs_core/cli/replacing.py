"""Writes several files, all or none."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path


def replace_files(texts: Mapping[Path, bytes]) -> None:
    """Put texts into files, and make the folders that they need.

    Raises:
        OSError: if one cannot be written; all files and folders are as they were before.
    """
    from mmrs_core.languages.writing import replace_file

    before: dict[Path, bytes | None] = {}
    folders: list[Path] = []
    try:
        for file, text in texts.items():
            _make_for(file, folders)
            before[file] = file.read_bytes() if file.exists() else None
            replace_file(file, text)
    except BaseException:
        for file, old in before.items():
            _put_back(file, old)
        for folder in reversed(folders):
            folder.rmdir()
        raise


def _make_for(file: Path, made: list[Path]) -> None:
    """Make the folders that a file needs, outer ones first; each is told as soon as it stands."""
    for folder in [folder for folder in file.parents if not folder.exists()][::-1]:
        folder.mkdir()
        made.append(folder)


def _put_back(file: Path, text: bytes | None) -> None:
    from mmrs_core.languages.writing import replace_file

    if text is not None:
        replace_file(file, text)
        return
    with suppress(FileNotFoundError):  # it was not written yet
        file.unlink()
