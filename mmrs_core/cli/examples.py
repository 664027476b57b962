"""The shipped examples: their names, how each is shown, and copies of them."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mmrs_core.cli.protection import ProtectedError, refuse_inputs
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.writing import replace_files
from mmrs_core.resources import shipped

DEMO_FILE = "demo.toml"
_ON_TOP = ("mission.xmi", "context.xmi", "surroundings.json")
_ROBOTS = "robots"


def example_folder(name: str) -> Path:
    """Return the folder of a shipped example.

    Raises:
        UnreadableError: if there is none of that name.
    """
    known = examples()
    known |= {also: folder for folder in known.values() if (also := also_called(folder))}
    if name not in known:
        raise UnreadableError(f"{name}: unknown example; there are {', '.join(known)}")
    return known[name]


def examples() -> dict[str, Path]:
    """Return the folders of the shipped missions by name, sorted."""
    return {
        mission.parent.name: mission.parent for mission in sorted(shipped("examples").glob("*/mission.xmi"))
    }


def also_called(folder: Path) -> str:
    """Return a shorter name of an example; empty: it has none."""
    return demo_settings_of(folder).also


@dataclass(frozen=True, slots=True)
class DemoSettings:
    """How an example is shown, as the file demo.toml next to its mission states.

    Attributes:
        also: a shorter name; may be empty.
        backend: of the robots, in simulated time. own: by robot, the backends that differ.
        options: of the backends; ``ROBOT:KEY`` is for that of one robot.
        targets: what is generated.
    """

    also: str = ""
    backend: str = "simulation"
    options: Mapping[str, str] = field(default_factory=dict)
    targets: tuple[str, ...] = ()
    own: Mapping[str, str] = field(default_factory=dict)


def demo_settings_of(folder: Path) -> DemoSettings:
    """Return how an example is shown, by default with a simulation. ``{folder}`` is its own folder.

    Raises:
        UnreadableError: if its file cannot be read.
    """
    file = folder / DEMO_FILE
    if not file.is_file():
        return DemoSettings()
    try:
        found = tomllib.loads(file.read_text(encoding="utf-8"))
        options = {
            key: str(value).replace("{folder}", str(folder)) for key, value in found["options"].items()
        }
        targets = tuple(map(str, found.get("targets", ())))
        own = {robot: str(name) for robot, name in found.get("own", {}).items()}
        return DemoSettings(str(found.get("also", "")), str(found["backend"]), options, targets, own)
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as error:
        raise UnreadableError(f"{file}: cannot be used: {error}") from error


def require_copies(folder: Path, example: Path, others: Iterable[Path]) -> None:
    """Require that a copy of an example replaces only copies of examples.

    Raises:
        ProtectedError: if it is something else, or the example itself.
    """
    refuse_inputs((folder / name for name in _names_in(example)), _files_in(example))
    known = {file.read_bytes() for each in (example, *others) for file in _files_in(each)}
    for file in _replaced_in(folder):
        if file.read_bytes() not in known:
            raise ProtectedError(
                f"{file}: is not a copy of an example, and is not replaced; choose another folder"
            )


def copy_example(example: Path, folder: Path) -> int:
    """Put a copy of an example in a folder, in place of that of another; return how many files it has."""
    names = _names_in(example)
    for file in _replaced_in(folder):
        if file.relative_to(folder) not in names:
            file.unlink()
    replace_files({folder / name: (example / name).read_bytes() for name in names})
    return len(names)


def _names_in(example: Path) -> tuple[Path, ...]:
    """Return the files of an example that are copied, from its folder on."""
    return tuple(file.relative_to(example) for file in _files_in(example) if file.name != DEMO_FILE)


def _files_in(example: Path) -> Iterator[Path]:
    return (file for file in sorted(example.rglob("*")) if file.is_file())


def _replaced_in(folder: Path) -> list[Path]:
    found = (*(folder / name for name in _ON_TOP), *sorted((folder / _ROBOTS).glob("*")))
    return [file for file in found if file.is_file()]
