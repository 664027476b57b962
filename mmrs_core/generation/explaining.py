"""Finds the step of a robot that a line of a generated file serves, and the lines of a step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.generation.manifest import ENDING, Entry, Manifest, Recorded, read_manifest

LEVELS = 8
"""How many folders above a file its manifest is looked for."""


@dataclass(frozen=True, slots=True)
class Explanation:
    """Facts about a line.

    Attributes:
        file: as it was asked for; line: counted from 1.
        target: that the file was generated for.
        recorded: the manifest's entry of the file.
        changed: whether the file is no longer as it was generated, so that lines may have moved.
        entries: steps that the line serves, the narrowest first; empty where it serves no robot in
            particular.
        overridden: whether its template is not the target's own.
    """

    file: Path
    line: int
    target: str
    recorded: Recorded
    changed: bool
    entries: tuple[Entry, ...]
    overridden: bool


@dataclass(frozen=True, slots=True)
class Found:
    """Lines that serve what was asked for; `changed` as in `Explanation`."""

    file: Path
    entry: Entry
    changed: bool


def explain(file: Path, line: int) -> Explanation:
    """Return what a line of a generated file serves.

    Raises:
        UnreadableError: there is no such file or line, or no manifest that lists the file.
    """
    if not file.is_file():
        raise UnreadableError(f"{file}: no such file")
    lines = len(file.read_bytes().splitlines())
    if not 1 <= line <= lines:
        raise UnreadableError(f"{file}: has no line {line}; it has {lines}")
    folder, manifest, recorded = _listing(file)
    serving = [e for e in manifest.trace if e.file == recorded.path and e.first <= line <= e.last]
    return Explanation(
        file,
        line,
        manifest.target,
        recorded,
        _changed(folder, recorded),
        tuple(sorted(serving, key=lambda entry: entry.last - entry.first)),
        bool({recorded.template, recorded.path} & set(manifest.overrides)),
    )


def places_of(folder: Path, *, robot: str = "", move: str = "", task: str = "") -> tuple[Found, ...]:
    """Return the lines in a folder's generated files that serve a robot, a move, a task, or all of these.

    Raises:
        UnreadableError: the folder has no manifest.
    """
    wanted = {"robot": robot, "move": move, "task": task}
    given = {name: value for name, value in wanted.items() if value}
    found = []
    for manifest in _manifests_in(folder):
        changed = {each.path: _changed(folder, each) for each in manifest.files}
        found += [
            Found(folder / entry.file, entry, changed.get(entry.file, True))
            for entry in manifest.trace
            if all(getattr(entry.step, name) == value for name, value in given.items())
        ]
    return tuple(found)


def _listing(file: Path) -> tuple[Path, Manifest, Recorded]:
    """Return the folder, the manifest that lists a file, and its entry."""
    absolute = file.resolve()
    for folder in absolute.parents[:LEVELS]:
        for path in sorted(folder.glob(f"*{ENDING}")):
            manifest = read_manifest(path)
            name = absolute.relative_to(folder).as_posix()
            for recorded in manifest.files if manifest is not None else ():
                if recorded.path == name and manifest is not None:
                    return folder, manifest, recorded
    raise UnreadableError(f"{file}: no manifest (*{ENDING}) beside it or above it lists it")


def _manifests_in(folder: Path) -> Iterator[Manifest]:
    paths = sorted(folder.glob(f"*{ENDING}"))
    if not paths:
        raise UnreadableError(f"{folder}: has no manifest of generated files (*{ENDING})")
    for path in paths:
        manifest = read_manifest(path)
        if manifest is not None:
            yield manifest


def _changed(folder: Path, recorded: Recorded) -> bool:
    file = folder / recorded.path
    return not file.is_file() or sha256(file.read_bytes()).hexdigest() != recorded.sha256
