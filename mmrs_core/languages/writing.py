"""Models into files, XMI or JSON: deterministic; and files replaced: all or none, and never half of one."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from errno import EEXIST, ENOTEMPTY
from pathlib import Path

from mmrs_core.languages.collector import collector_at_rest
from mmrs_core.languages.element import Element
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.json_form.writer import JsonWriter
from mmrs_core.languages.references.by_name import ReferenceNames
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.quick_writer import writer_for
from mmrs_core.languages.xmi.writer import XmiWriter
from mmrs_core.resources import named


def to_xmi(
    roots: Sequence[Element],
    registry: Registry,
    *,
    schema_location: Mapping[str, str] | None = None,
    file: Path | None = None,
    comments: Mapping[Element, str] | None = None,
    names: ReferenceNames | None = None,
) -> bytes:
    """Return the text of a model as EMF writes it, in UTF-8; the same model gives the same bytes.

    Args:
        roots: the elements at the top of the file.
        registry: the metamodels of the elements.
        schema_location: for Eclipse, where the .ecore of each nsURI lies, relative to the file.
        file: where the text will stand; needed when the model refers to other files.
        comments: what is written before some elements; not before one of several roots.
        names: what references become where names lead to their elements; Eclipse does not read those.

    Raises:
        ValueError: if a value is not of its type, holds a character that XML cannot hold, or a reference
            leads to an element that stands in no file.
    """
    with collector_at_rest():
        if comments or names is not None:
            writer = XmiWriter(tuple(roots), registry, file, comments, names)
        else:
            writer = writer_for(tuple(roots), registry, file)
        return writer.document(schema_location or {}).encode()


def to_json(
    roots: Sequence[Element],
    registry: Registry,
    *,
    schema_location: Mapping[str, str] | None = None,
    file: Path | None = None,
    names: ReferenceNames | None = None,
) -> bytes:
    """Return the text of a model in our JSON form, in UTF-8; arguments and errors as in `to_xmi`."""
    with collector_at_rest():
        return JsonWriter(tuple(roots), registry, file, names).document(schema_location or {}).encode()


def write_model(
    roots: Sequence[Element],
    path: Path,
    registry: Registry,
    *,
    schema_location: Mapping[str, str] | None = None,
) -> None:
    """Write a model into a file, whole or not at all: as JSON if its name ends in ``.json``, else as XMI.

    Raises:
        ValueError: as `to_xmi`; nothing is written then.
        OSError: if the folder cannot be written to; the file is as it was before.
    """
    text = to_json if is_json(path.name) else to_xmi
    replace_file(path, text(roots, registry, schema_location=schema_location, file=path))


def replace_file(path: Path, data: bytes) -> None:
    """Put other content into a file, or make it, in one step that a crash cannot divide.

    Raises:
        OSError: if the folder cannot be written to; the file is as it was before.
    """
    part = part_of(path, data)
    try:
        part.replace(path.resolve())
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def part_of(path: Path, data: bytes) -> Path:
    """Return a file beside another with the content that is to replace it, which is on the disk.

    Raises:
        OSError: if the folder cannot be written to; there is no such file then.
    """
    real = path.resolve()  # a symbolic link stays one
    try:
        handle, name = tempfile.mkstemp(prefix=f".{real.name}.", suffix=".part", dir=real.parent)
    except OSError as fault:  # it names the part, of which nobody knows
        raise OSError(fault.errno, fault.strerror, str(path)) from None
    part = Path(name)
    try:
        with named(path), os.fdopen(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        part.chmod(real.stat().st_mode & 0o777 if real.exists() else 0o666 & ~_umask())
    except BaseException:
        part.unlink(missing_ok=True)
        raise
    return part


def _umask() -> int:
    mask = os.umask(0o077)
    os.umask(mask)
    return mask


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
