"""Runs an example end to end, and summarises what it made."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import ReplayResult, replay
from mmrs_core.cli.examples import DemoSettings, copy_example, require_copies
from mmrs_core.cli.output import counted
from mmrs_core.cli.plan import require_sound, require_writable
from mmrs_core.cli.plan_words import plan_lines, plan_summary
from mmrs_core.cli.preview import drawn_on_failure, picture_of, write_pictures
from mmrs_core.cli.session import CommandStages
from mmrs_core.cli.simulation import Chosen, fly, run_lines, succeeded, write_logs
from mmrs_core.cli.verdict_words import verdict_table
from mmrs_core.contributions.targets import GeneratedFile
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.writing import write
from mmrs_core.pipeline import render, save
from mmrs_core.resources import new_folders
from mmrs_core.simulation.run import SimulatedRun

_MOST_REASONS = 3
LOGS = "logs"


@dataclass(frozen=True, slots=True)
class Demonstration:
    """What was done and made.

    Attributes:
        files: (description, path, number of files), in the order of their creation.
        left_out: by target, the elements that it does not support, as its manifest records.
        backend: of the robots.
    """

    stages: CommandStages
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
        yield from plan_lines(self.stages.scene, self.stages.timed)
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
        reported = shlex.join(["mmrs", "report", str(self.folder), str(self.folder / LOGS)])
        yield f"Flight report: {reported}"

    def summary(self) -> Mapping[str, object]:
        """Return the demonstration as JSON has it."""
        return {
            **plan_summary(self.stages.scene, self.stages.timed),
            "verdicts": self.stages.verdicts,
            "ending": self.run.ending,
            "replay": self.replayed,
            "left_out": self.left_out,
            "files": [{"what": what, "path": path} for what, path, _ in self.files],
        }


def demonstrate(
    stages: CommandStages, example: Path, folder: Path, settings: DemoSettings, others: Iterable[Path]
) -> Demonstration:
    """Take an example through all stages, and write it and their results to a folder.

    Args:
        stages: of its mission.
        example: its folder.
        folder: of what is made; what is there of other examples is replaced.
        settings: how it is settings.
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
    for target in settings.targets:
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
    run = fly(session, program, place, {}, Chosen(settings.backend, settings.options, settings.own))
    logs = write_logs(run, program, folder / LOGS, place.types, session.contributions)
    files.append(("steps of each robot in the simulation", folder / LOGS, len(logs)))
    pictures = write_pictures(picture_of(stages), folder)
    files += [("map, timeline and altitude profile", pictures[0], 1), ("map", pictures[1], 1)]
    replayed = replay(program, read_logs([folder / LOGS]))
    backends = " and ".join(dict.fromkeys((settings.backend, *settings.own.values())))
    return Demonstration(stages, run, replayed, folder, tuple(files), left_out, backends)


def _rendered(stages: CommandStages, target: str) -> tuple[tuple[GeneratedFile, ...], tuple[str, ...]]:
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
