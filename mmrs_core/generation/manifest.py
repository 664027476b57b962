"""What a folder of generated files says about itself."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from mmrs_core.contributions.targets import GeneratedFile, Target, TracedStep
from mmrs_core.errors import UnreadableError

FORMAT = "mmrs-manifest-1"
ENDING = ".manifest.json"


@dataclass(frozen=True, slots=True)
class Recorded:
    """What a manifest says of a file."""

    path: str
    sha256: str
    once: bool


def manifest_path(target: str) -> str:
    """Return where the manifest of a target lies in the folder of its output."""
    return f"{target}{ENDING}"


def manifest_of(
    target: Target,
    provider: str,
    files: Sequence[GeneratedFile],
    losses: Sequence[str],
    trace: Iterable[tuple[str, TracedStep]],
) -> GeneratedFile:
    """Return the manifest of rendered files: hashes, versions, losses, and which step serves what.

    Args:
        target: what the files were rendered for.
        provider: the distribution that contributed the target.
        files: all but the manifest itself.
        losses: what the behaviour says and the files do not.
        trace: (path, step) pairs.
    """
    content = {
        "format": FORMAT,
        "target": target.name,
        "versions": {name: _version(name) for name in sorted({"mmrs-core", provider})},
        "losses": list(losses),
        "files": [asdict(recorded(file)) for file in files],
        "trace": [{"file": path, **asdict(step)} for path, step in trace],
    }
    text = json.dumps(content, indent=2, ensure_ascii=True) + "\n"
    return GeneratedFile(manifest_path(target.name), text.encode("ascii"))


def recorded(file: GeneratedFile) -> Recorded:
    """Return what the manifest says of a file."""
    return Recorded(file.path, sha256(file.content).hexdigest(), file.once)


def read_manifest(path: Path) -> tuple[Recorded, ...]:
    """Return the files that a manifest lists; none where there is no manifest.

    Raises:
        UnreadableError: the file is there and is no manifest.
    """
    if not path.exists():
        return ()
    try:
        content = json.loads(path.read_bytes())
        if content["format"] != FORMAT:
            raise ValueError(f"format {content['format']!r}")
        return tuple(Recorded(str(f["path"]), str(f["sha256"]), bool(f["once"])) for f in content["files"])
    except (ValueError, KeyError, TypeError) as error:
        raise UnreadableError(f"{path}: is no manifest of generated files ({error})") from error


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "unknown"
