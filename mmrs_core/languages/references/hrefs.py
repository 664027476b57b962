"""Which file a reference to another file means, and whether it may be opened."""

from __future__ import annotations

import re
from os.path import realpath, relpath
from pathlib import Path
from urllib.parse import unquote

_WORKSPACE = re.compile(r"platform:/(?:resource|plugin)/([^/]+)/(.+)", re.DOTALL)
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")


def real_path(path: Path) -> Path:
    """Return where a path leads, also one that leads in a circle, of which `Path.resolve` makes an error."""
    return Path(realpath(path))


def linked_file(document: str, base: Path, root: Path) -> Path:
    """Return the real path of a document that a file in the folder ``base`` refers to.

    Eclipse may have written ``platform:/resource/NAME/...``: then NAME is the folder ``root``, or one that
    lies in it, or above ``base``.

    Args:
        document: the part of the href before the hash, percent escapes allowed.
        base: the folder of the referring file.
        root: the folder, as a real path, that must contain the document once symbolic links are followed.

    Raises:
        ValueError: if it is absolute, has a scheme such as ``file:`` or ``http:``, or leaves the root.
    """
    path = unquote(document.partition("?")[0])  # EMF's URIs may have a query, which says nothing of the file
    project = _WORKSPACE.fullmatch(path)
    if project is not None:
        base, path = _project_folder(project[1], base, root), project[2]
    if _SCHEME.match(path) or path.startswith(("/", "\\")):
        raise ValueError(f"{document}: not a relative path; only files of the project are opened")
    if not path or "\0" in path or "\\" in path:
        raise ValueError(f"{document!r}: not a path")
    try:
        real = (base / path).resolve()
    except (OSError, RuntimeError):
        raise ValueError(f"{document}: leads in a circle") from None
    if not real.is_relative_to(root):
        raise ValueError(f"{document}: outside the project folder {root.name}")
    return real


def _project_folder(name: str, base: Path, root: Path) -> Path:
    """Return the folder of an Eclipse project: its name is what Eclipse calls it, wherever it lies."""
    above = [folder for folder in (base, *base.parents) if folder == root or folder.is_relative_to(root)]
    for folder in (*above, *(each / name for each in above)):
        if folder.name == name and folder.is_dir():
            return folder
    raise ValueError(f"platform:/resource/{name}: no folder {name} in the project folder {root.name}")


def relative_href(target: Path, base: Path) -> str:
    """Return the reference to a file as it is written in a file of the folder ``base``."""
    steps = Path(relpath(target, base)).as_posix()
    return re.sub(r"[\x00-\x20%#?]", lambda match: f"%{ord(match.group()):02X}", steps)
