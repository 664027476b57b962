"""A folder in which people keep their own versions of a target's templates and other files."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from mmrs_core.contributions.targets import FileSpec, Target
from mmrs_core.errors import MmrsError, UnreadableError

PART = "_"
"""What the names of files begin with that other templates of the folder include or extend."""

HIDDEN = "."
"""What the names of files and folders begin with that are left alone, such as ``.git``."""


@dataclass(frozen=True, slots=True)
class Overrides:
    """The files that replace a target's own.

    Attributes:
        folder: of the target, in the folder that was given.
        hashes: SHA-256 of each file, by its name with forward slashes.
    """

    folder: Path
    hashes: Mapping[str, str]

    def path(self, name: str) -> Path | None:
        """Return the file that replaces that one; None if none does."""
        return self.folder / name if name in self.hashes else None


def overrides_in(folder: Path, target: Target, others: Collection[str] = ()) -> Overrides:
    """Return a folder's files for a target: those in ``<folder>/<target>``.

    Args:
        folder: with one folder for each target.
        target: that is rendered.
        others: names of the other targets, whose folders are left alone.

    Raises:
        UnreadableError: there is no such folder.
        MmrsError: it contains something that is not a target's folder.
    """
    if not folder.is_dir():
        raise UnreadableError(f"{folder}: there is no such folder of templates")
    names = (each.name for each in folder.iterdir() if not each.name.startswith(HIDDEN))
    strange = sorted(name for name in names if name not in {target.name, *others})
    if strange:
        known = ", ".join(sorted({target.name, *others}))
        raise MmrsError(f"{folder / strange[0]}: no target is called so; known are {known}")
    own = folder / target.name
    files = sorted(path for path in own.rglob("*") if path.is_file() and not _is_hidden(path, own))
    return Overrides(
        own, {path.relative_to(own).as_posix(): sha256(path.read_bytes()).hexdigest() for path in files}
    )


def _is_hidden(path: Path, folder: Path) -> bool:
    return any(part.startswith(HIDDEN) for part in path.relative_to(folder).parts)


def check_known(overrides: Overrides, target: Target, specs: Iterable[FileSpec]) -> None:
    """Require that each file replaces one that the target has.

    Raises:
        MmrsError: if one does not; names what the target has.
    """
    templates = {
        path.relative_to(target.templates).as_posix()
        for path in target.templates.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    templates |= {spec.template for spec in specs if spec.source is None and spec.template}
    copied = {spec.path for spec in specs if spec.source is not None}
    for name in overrides.hashes:
        if name not in templates | copied and not name.rpartition("/")[2].startswith(PART):
            raise MmrsError(
                f"{overrides.folder / name}: target {target.name} has no such file;"
                f" {_has(templates, copied)}; files of your own begin with '{PART}'"
            )


def _has(templates: Collection[str], copied: Collection[str]) -> str:
    folders = sorted({f"those in {path.partition('/')[0]}/" for path in copied})
    return f"it has {', '.join([*sorted(templates), *folders])}"
