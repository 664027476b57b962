"""Wheels of installed distributions, for generated folders that run where no checkout is.

No build backend takes part: a wheel holds the files that are installed and the metadata that was written when
they were. The same files give the same bytes, wherever they lie and whenever they were written.
"""

from __future__ import annotations

import csv
import io
import json
import re
import tomllib
from base64 import urlsafe_b64encode
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path, PurePosixPath
from stat import S_IFREG
from urllib.parse import urlsplit
from urllib.request import url2pathname
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from mmrs_core.errors import MmrsError

EPOCH = (1980, 1, 1, 0, 0, 0)
"""When every file of a wheel was written: the earliest that archives can say."""

OF_THE_INSTALLATION = {"INSTALLER", "REQUESTED", "RECORD", "WHEEL", "direct_url.json", "uv_cache.json"}
"""Metadata of this installation rather than of the distribution."""

BACKEND = "hatchling.build"
UNDERSTOOD = {"packages", "only-include", "sources"}

WHEEL = "Wheel-Version: 1.0\nGenerator: mmrs\nRoot-Is-Purelib: true\nTag: py3-none-any\n"


@dataclass(frozen=True, slots=True)
class Wheel:
    """A wheel: the name of its file, and what that holds."""

    name: str
    content: bytes


@cache
def wheel_of(name: str) -> Wheel:
    """Return the wheel of an installed distribution, whether it was installed as a copy or in place.

    Raises:
        MmrsError: it is not installed, lacks files, has compiled parts, or was installed in place and says in
            an unknown manner what belongs to it.
    """
    try:
        found = distribution(name)
    except PackageNotFoundError as error:
        raise MmrsError(f"distribution {name}: is not installed, and its wheel is needed") from error
    if "Root-Is-Purelib: true" not in (found.read_text("WHEEL") or ""):
        raise MmrsError(
            f"distribution {name}: has compiled parts; its wheel must come from where it was built"
        )
    stem = f"{_normal(found.name)}-{found.version}"
    folder = _project_of(found)
    packages = _recorded(found) if folder is None else _in_place(folder, found)
    files = [*sorted(packages), *sorted(_metadata(found, f"{stem}.dist-info"))]
    return Wheel(f"{stem}-py3-none-any.whl", _archive(files, f"{stem}.dist-info/RECORD"))


def _project_of(found: Distribution) -> Path | None:
    """Return the folder in which a distribution is developed; None where a copy is installed."""
    origin = json.loads(found.read_text("direct_url.json") or "{}")
    if not origin.get("dir_info", {}).get("editable"):
        return None
    return Path(url2pathname(urlsplit(origin["url"]).path))


def _recorded(found: Distribution) -> Iterator[tuple[str, bytes]]:
    """Yield the files of an installed copy, without commands and compiled modules, which installing makes."""
    if found.files is None:
        raise MmrsError(f"distribution {found.name}: its installation has no record of its files")
    for file in found.files:
        made = not {"..", "__pycache__"}.isdisjoint(file.parts)
        if not made and not file.parts[0].endswith(".dist-info"):
            yield file.as_posix(), _read(Path(str(found.locate_file(file))), found)


def _in_place(folder: Path, found: Distribution) -> Iterator[tuple[str, bytes]]:
    """Yield the files that a build of a project would put into its wheel."""
    try:
        project = tomllib.loads(_read(folder / "pyproject.toml", found).decode())
    except ValueError as error:
        raise MmrsError(f"{folder / 'pyproject.toml'}: {error}") from error
    table = project.get("tool", {}).get("hatch", {}).get("build", {}).get("targets", {}).get("wheel", {})
    backend = project.get("build-system", {}).get("build-backend")
    if backend != BACKEND or not table or set(table) - UNDERSTOOD:
        raise MmrsError(
            f"{folder / 'pyproject.toml'}: does not say by packages or only-include of {BACKEND} what belongs"
            f" to the wheel of {found.name}; install it without --editable"
        )
    sources = {part: PurePosixPath(part).name for part in table.get("packages", ())}
    sources |= {part: table.get("sources", {}).get(part, part) for part in table.get("only-include", ())}
    for part, inside in sources.items():
        if not (folder / part).is_dir():
            raise MmrsError(f"distribution {found.name}: {folder / part} is missing")
        for path in (folder / part).rglob("*"):
            if path.is_file() and "__pycache__" not in path.parts:
                yield f"{inside}/{path.relative_to(folder / part).as_posix()}", _read(path, found)


def _metadata(found: Distribution, folder: str) -> Iterator[tuple[str, bytes]]:
    yield f"{folder}/WHEEL", WHEEL.encode()
    for file in found.files or ():
        if file.parts[0].endswith(".dist-info") and file.name not in OF_THE_INSTALLATION:
            inside = PurePosixPath(folder, *file.parts[1:])
            yield str(inside), _read(Path(str(found.locate_file(file))), found)


def _read(path: Path, found: Distribution) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise MmrsError(f"distribution {found.name}: {path} cannot be read: {error.strerror}") from error


def _archive(files: Iterable[tuple[str, bytes]], record: str) -> bytes:
    """Return the archive of files, their record last."""
    lines, packed = io.StringIO(), io.BytesIO()
    table = csv.writer(lines, lineterminator="\n")
    with ZipFile(packed, "w") as archive:
        for path, content in files:
            digest = urlsafe_b64encode(sha256(content).digest()).rstrip(b"=").decode()
            table.writerow((path, f"sha256={digest}", len(content)))
            archive.writestr(_entry(path), content)
        table.writerow((record, "", ""))
        archive.writestr(_entry(record), lines.getvalue())
    return packed.getvalue()


def _entry(path: str) -> ZipInfo:
    entry = ZipInfo(path, EPOCH)
    entry.compress_type, entry.create_system = ZIP_DEFLATED, 3
    entry.external_attr = (S_IFREG | 0o644) << 16
    return entry


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "_", name).lower()
