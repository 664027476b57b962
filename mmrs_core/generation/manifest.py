"""What a folder of generated files says about itself."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from mmrs_core.contributions.targets import GeneratedFile, TracedStep
from mmrs_core.errors import UnreadableError
from mmrs_core.generation.tracing import Served

FORMAT = "mmrs-manifest-2"
FORMERLY = "mmrs-manifest-1"
"""Without lines, facts, templates and overrides; a folder that was generated then is rewritten."""

ENDING = ".manifest.json"


@dataclass(frozen=True, slots=True)
class Recorded:
    """A manifest's entry of a file; `template`: what it was made from."""

    path: str
    sha256: str
    once: bool
    template: str = ""


@dataclass(frozen=True, slots=True)
class Facts:
    """Facts about a step's move, or its robot, from the behaviour, as far as they concern others.

    Attributes:
        model: file (without its folder) and line where it stands, such as ``behaviour.xmi:12``; may be
            empty.
        then: moves that may follow.
        waits: own slots that must be active before. condition: of a choice; may be empty.
        sets: slots of robots that it sets, such as ``beta.go``.
    """

    model: str = ""
    then: tuple[str, ...] = ()
    waits: tuple[str, ...] = ()
    condition: str = ""
    sets: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Entry:
    """Which step a place in a file serves; `first` and `last` line are 0 where they are not known."""

    file: str
    step: TracedStep
    first: int
    last: int
    facts: Facts = Facts()


@dataclass(frozen=True, slots=True)
class Manifest:
    """The content of a manifest.

    Attributes:
        target: that the files were rendered for.
        versions: of the distributions that rendered them, by name.
        losses: elements of the behaviour that the files leave out.
        overrides: SHA-256 of the templates that replaced the target's own, by name.
        files: all but the manifest itself.
        trace: which step each place in them serves.
    """

    target: str
    versions: Mapping[str, str]
    losses: tuple[str, ...] = ()
    overrides: Mapping[str, str] = field(default_factory=dict)
    files: tuple[Recorded, ...] = ()
    trace: tuple[Entry, ...] = ()


def manifest_path(target: str) -> str:
    """Return where the manifest of a target lies in the folder of its output."""
    return f"{target}{ENDING}"


def versions_of(provider: str) -> dict[str, str]:
    """Return the versions of this distribution and of the one that contributed a target."""
    return {name: _version(name) for name in sorted({"mmrs-core", provider})}


def recorded(file: GeneratedFile, template: str = "") -> Recorded:
    """Return the manifest's entry of a file."""
    return Recorded(file.path, sha256(file.content).hexdigest(), file.once, template)


def entries_of(
    path: str, served: Iterable[Served], facts: Mapping[tuple[str, str], Facts]
) -> tuple[Entry, ...]:
    """Return the trace of a file; `facts` by robot and move."""
    return tuple(
        Entry(path, each.step, each.first, each.last, facts.get((each.step.robot, each.step.move), Facts()))
        for each in served
    )


def written(manifest: Manifest) -> GeneratedFile:
    """Return the manifest as a file."""
    content = {
        "format": FORMAT,
        "target": manifest.target,
        "versions": dict(manifest.versions),
        "losses": list(manifest.losses),
        "overrides": dict(manifest.overrides),
        "files": [asdict(file) for file in manifest.files],
        "trace": [_entry_json(entry) for entry in manifest.trace],
    }
    text = json.dumps(content, indent=2, ensure_ascii=True) + "\n"
    return GeneratedFile(manifest_path(manifest.target), text.encode("ascii"))


def read_manifest(path: Path) -> Manifest | None:
    """Return a manifest; None where there is none.

    Raises:
        UnreadableError: the file is there and is not a manifest.
    """
    if not path.exists():
        return None
    try:
        return manifest_in(path.read_bytes())
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise UnreadableError(f"{path}: is not a manifest of generated files ({error})") from error


def manifest_in(text: bytes) -> Manifest:
    """Return the manifest that a file holds.

    Raises:
        ValueError, KeyError, TypeError: it holds none.
    """
    content = json.loads(text)
    if content["format"] not in (FORMAT, FORMERLY):
        raise ValueError(f"format {content['format']!r}, expected {FORMAT!r}")
    return Manifest(
        str(content.get("target", "")),
        content.get("versions", {}),
        tuple(map(str, content.get("losses", ()))),
        content.get("overrides", {}),
        tuple(Recorded(**each) for each in content["files"]),
        tuple(_entry(each) for each in content.get("trace", ())),
    )


def _entry_json(entry: Entry) -> dict[str, object]:
    lines = [entry.first, entry.last] if entry.first else None
    facts = {name: value for name, value in asdict(entry.facts).items() if value}
    return {"file": entry.file, **asdict(entry.step), "lines": lines, **facts}


def _entry(content: Mapping[str, object]) -> Entry:
    rest = dict(content)
    file, lines = str(rest.pop("file")), rest.pop("lines", None)
    step = TracedStep(*(str(rest.pop(name)) for name in ("step", "robot", "move", "task", "rule")))
    first, last = (int(each) for each in lines) if isinstance(lines, list) else (0, 0)
    facts = {name: tuple(value) if isinstance(value, list) else str(value) for name, value in rest.items()}
    return Entry(file, step, first, last, Facts(**facts))  # type: ignore[arg-type]


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "unknown"
