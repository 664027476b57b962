"""Runs an example end to end, and summarises what it made."""

from __future__ import annotations

import shlex
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import ReplayResult, replay
from mmrs_core.cli.output import counted
from mmrs_core.cli.plan import require_sound, require_writable
from mmrs_core.cli.plan_words import plan_lines, plan_summary
from mmrs_core.cli.preview import drawn_on_failure, picture_of, write_pictures
from mmrs_core.cli.protection import ProtectedError, refuse_inputs
from mmrs_core.cli.replacing import replace_files
from mmrs_core.cli.session import Stages
from mmrs_core.cli.simulation import Chosen, fly, run_lines, succeeded, write_logs
from mmrs_core.cli.verdict_words import verdict_table
from mmrs_core.contributions.targets import GeneratedFile
from mmrs_core.errors import UnreadableError, UnsupportedError
from mmrs_core.generation.writing import write
from mmrs_core.pipeline import render, save
from mmrs_core.resources import new_folders
from mmrs_core.simulation.run import SimulatedRun

_MOST_REASONS = 3
MANNER = "demo.toml"
LOGS = "logs"


@dataclass(frozen=True, slots=True)
class Manner:
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


def manner_of(folder: Path) -> Manner:
    """Return how an example is shown, by default with a simulation. ``{folder}`` is its own folder.

    Raises:
        UnreadableError: if its file cannot be read.
    """
    file = folder / MANNER
    if not file.is_file():
        return Manner()
    try:
        found = tomllib.loads(file.read_text(encoding="utf-8"))
        options = {
            key: str(value).replace("{folder}", str(folder)) for key, value in found["options"].items()
        }
        targets = tuple(map(str, found.get("targets", ())))
        own = {robot: str(name) for robot, name in found.get("own", {}).items()}
        return Manner(str(found.get("also", "")), str(found["backend"]), options, targets, own)
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as error:
        raise UnreadableError(f"{file}: cannot be used: {error}") from error


@dataclass(frozen=True, slots=True)
class Demonstration:
    """What was done and made.

    Attributes:
        files: (description, path, number of files), in the order of their creation.
        left_out: by target, the elements that it does not support, as its manifest records.
        backend: of the robots.
    """

    stages: Stages
    run: SimulatedRun
    replayed: ReplayResult
    folder: Path
    files: tuple[tuple[str, Path, int], ...]
    left_out: Mapping[str, tuple[str, ...]]
    backend: str = "simulation"

    @property
    def _generated(self) -> frozenset[str]:
        return frozenset(path.name for _, path, _ in self.files if path.parent.name == "controllers")

    @property
    def succeeded(self) -> bool:
        """Return whether the run came to its end and its logs replay."""
        return succeeded(self.run) and self.replayed.accepted

    def lines(self) -> Iterator[str]:
        """Yield about a screenful: plan, safety, run and files."""
        yield from plan_lines(self.stages.scene, self.stages.plan)
        yield "Safety checks:"
        yield from verdict_table(self.stages.verdicts)
        outcome, *details = run_lines(self.run)
        judged = "logs verified" if self.replayed.accepted else "log check failed"
        backend = "" if self.backend == "simulation" else f" by {self.backend}"
        yield f"simulated{backend}: {outcome}; {judged}"
        if not succeeded(self.run):
            yield from details
        for target in sorted(set(self.left_out) - self._generated):
            yield f"not generated for {target}: {'; '.join(self.left_out[target][:_MOST_REASONS])}"
        yield f"Output in {self.folder}:"
        for what, path, count in self.files:
            more = f" ({counted(count, 'file')})" if count > 1 else ""
            yield f"  {path.relative_to(self.folder).as_posix():<30} {what}{more}"
        told = shlex.join(["mmrs", "report", str(self.folder), str(self.folder / LOGS)])
        yield f"Flight report: {told}"

    def summary(self) -> Mapping[str, object]:
        """Return the demonstration as JSON has it."""
        return {
            **plan_summary(self.stages.scene, self.stages.plan),
            "verdicts": self.stages.verdicts,
            "ending": self.run.ending,
            "replay": self.replayed,
            "left_out": self.left_out,
            "files": [{"what": what, "path": path} for what, path, _ in self.files],
        }


def demonstrate(
    stages: Stages,
    example: Path,
    folder: Path,
    manner: Manner = Manner(),
    others: Iterable[Path] = (),
) -> Demonstration:
    """Take an example through all stages, and write it and their results to a folder.

    Args:
        stages: of its mission.
        example: its folder.
        folder: of what is made; what is there of other examples is replaced.
        manner: how it is shown.
        others: the folders of other examples.

    Raises:
        MmrsError: as the stages raise it; until the behaviour is known to be safe, nothing is written but a
            picture of the problems.
    """
    session = stages.session
    with drawn_on_failure(stages, folder):
        place, program = stages.place, stages.program
    behaviour = folder / "behaviour.xmi"
    require_writable(stages, behaviour, "choose another folder")
    require_copies(folder, example, others)
    require_sound(stages, stages.scene.name or "mission")
    with new_folders() as make:
        make(folder)
        save(stages.transformed[0], behaviour, session.contributions)
    copied = copy_example(example, folder)
    files: list[tuple[str, Path, int]] = [
        ("mission, context and robot types", folder / "mission.xmi", copied),
        ("moves of each robot", behaviour, 1),
    ]
    left_out: dict[str, tuple[str, ...]] = {}
    for target in manner.targets:
        rendered, left_out[target] = _rendered(stages, target)
        if not rendered:
            continue
        write(rendered, folder / "controllers" / target)
        lossy = (
            f", without {counted(len(left_out[target]), 'element')} it does not support"
            if left_out[target]
            else ""
        )
        files.append((f"code for {target}{lossy}", folder / "controllers" / target, len(rendered)))
    run = fly(session, program, place, {}, Chosen(manner.backend, manner.options, manner.own))
    logs = write_logs(run, program, folder / LOGS, place.types, session.contributions.robot_kinds)
    files.append(("steps of each robot in the simulation", folder / LOGS, len(logs)))
    pictures = write_pictures(picture_of(stages), folder)
    files += [("map, timeline and altitude profile", pictures[0], 1), ("map", pictures[1], 1)]
    replayed = replay(program, read_logs([folder / LOGS]))
    backends = " and ".join(dict.fromkeys((manner.backend, *manner.own.values())))
    return Demonstration(stages, run, replayed, folder, tuple(files), left_out, backends)


def _rendered(stages: Stages, target: str) -> tuple[tuple[GeneratedFile, ...], tuple[str, ...]]:
    """Return the files of a target, and what had to be left out; no files where nothing is left."""
    contributions = stages.session.contributions

    def rendered(lossy: bool) -> tuple[GeneratedFile, ...]:
        return stages.session.stage(
            "render",
            f"generating for {target}",
            lambda: render(stages.program, stages.place, target, contributions, allow_lossy=lossy),
        )

    try:
        return rendered(False), ()
    except UnsupportedError as error:
        losses = error.elements or (str(error),)
    try:
        return rendered(True), losses
    except UnsupportedError:
        return (), losses


NOT_COPIED = frozenset({"demo.toml"})
ON_TOP = ("mission.xmi", "context.xmi", "surroundings.json")
ROBOTS = "robots"


def require_copies(folder: Path, example: Path, others: Iterable[Path]) -> None:
    """Require that a copy of an example replaces only copies of examples.

    Raises:
        ProtectedError: if it is something else, or the example itself.
    """
    refuse_inputs((folder / name for name in names_in(example)), _files_in(example))
    known = {file.read_bytes() for each in (example, *others) for file in _files_in(each)}
    for file in _replaced_in(folder):
        if file.read_bytes() not in known:
            raise ProtectedError(
                f"{file}: is not a copy of an example, and is not replaced; choose another folder"
            )


def copy_example(example: Path, folder: Path) -> int:
    """Put a copy of an example in a folder, in place of that of another; return how many files it has."""
    names = names_in(example)
    for file in _replaced_in(folder):
        if file.relative_to(folder) not in names:
            file.unlink()
    replace_files({folder / name: (example / name).read_bytes() for name in names})
    return len(names)


def names_in(example: Path) -> tuple[Path, ...]:
    """Return the files of an example that are copied, from its folder on."""
    return tuple(file.relative_to(example) for file in _files_in(example) if file.name not in NOT_COPIED)


def _files_in(example: Path) -> Iterator[Path]:
    return (file for file in sorted(example.rglob("*")) if file.is_file())


def _replaced_in(folder: Path) -> list[Path]:
    found = (*(folder / name for name in ON_TOP), *sorted((folder / ROBOTS).glob("*")))
    return [file for file in found if file.is_file()]
