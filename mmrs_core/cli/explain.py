"""``mmrs explain`` and ``mmrs-gen explain``: from lines of generated files to moves, and back."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.completion import generated_robots, generated_tasks
from mmrs_core.cli.output import say_json, say_lines, table, tell
from mmrs_core.cli.settings import Json
from mmrs_core.errors import MmrsError
from mmrs_core.generation.explaining import Explanation, Found, places_of
from mmrs_core.generation.explaining import explain as explained

if TYPE_CHECKING:
    from mmrs_core.generation.manifest import Entry

CHANGED = "was changed after it was generated; lines may have moved"


def explain(
    where: Annotated[
        str,
        typer.Argument(
            metavar="FILE:LINE",
            help="Generated line; with --robot, --move or --task, the folder of generated files.",
        ),
    ] = ".",
    robot: Annotated[
        str,
        typer.Option(
            "--robot",
            metavar="ROBOT",
            help="List the lines generated for this robot.",
            autocompletion=generated_robots,
        ),
    ] = "",
    move: Annotated[
        str, typer.Option("--move", metavar="MOVE", help="List the lines generated for this move.")
    ] = "",
    task: Annotated[
        str,
        typer.Option(
            "--task",
            metavar="TASK",
            help="List the lines generated for this task.",
            autocompletion=generated_tasks,
        ),
    ] = "",
    json: Json = False,
) -> int:
    """Trace a generated line to its move.

    Prints the move's task and rule as well. With --robot, --move or --task, lists the lines generated for it.

    Examples: mmrs explain code/robot_d1.py:40; mmrs explain code --task survey
    """
    if robot or move or task:
        return _places(Path(where), robot, move, task, json)
    file, _, line = where.rpartition(":")
    if not (file and line.isdecimal() and len(line) < 10):
        raise typer.BadParameter(f"{where}: expected FILE:LINE; for a folder, add --robot, --move or --task")
    return _line(Path(file), int(line), json)


def _line(file: Path, line: int, json: bool) -> int:
    found = explained(file, line)
    if json:
        say_json(_explanation_json(found))
        return 0
    if found.changed:
        tell(f"mmrs: {file}: {'is yours since it was generated' if found.recorded.once else CHANGED}")
    say_lines(_words_of(found))
    return 0


def _words_of(found: Explanation) -> Iterator[str]:
    here = f"{found.file}:{found.line}"
    if not found.entries:
        yield f"{here}: serves no robot in particular"
    for entry in found.entries:
        yield f"{here}: {_subject(entry)}"
        yield from (f"  {words}" for words in _facts(entry))
    template = found.recorded.template
    own = " in place of the target's own" if found.overridden else ""
    yield f"  from {template or 'a template'} of target {found.target}{own}"


def _subject(entry: Entry) -> str:
    lines = f"lines {entry.first} to {entry.last}" if entry.last > entry.first else f"line {entry.first}"
    move = f", move '{entry.step.move}'" if entry.step.move else ""
    return f"{entry.step.step} of robot '{entry.step.robot}'{move} ({lines})"


def _facts(entry: Entry) -> Iterator[str]:
    step, facts = entry.step, entry.facts
    if facts.model:
        yield f"{'move' if step.move else 'robot'} in {facts.model}"
    if step.task:
        yield f"task '{step.task}'" + (f", by rule '{step.rule}'" if step.rule else "")
    if facts.sets:
        yield f"sets {', '.join(facts.sets)}"
    if facts.waits:
        yield f"waits afterwards for {', '.join(facts.waits)}"
    if facts.condition:
        yield f"then, if '{facts.condition}', '{facts.then[0]}', else '{facts.then[-1]}'"
    elif facts.then:
        yield f"then '{facts.then[0]}'"


def _places(folder: Path, robot: str, move: str, task: str, json: bool) -> int:
    found = places_of(folder, robot=robot, move=move, task=task)
    asked = " ".join(
        f"{name} '{value}'" for name, value in (("robot", robot), ("move", move), ("task", task)) if value
    )
    if not found:
        raise MmrsError(f"{folder}: no generated file has anything for {asked}")
    if json:
        say_json({"places": [_place_json(each) for each in found]})
        return 0
    _tell_changed(found)
    rows = [
        (_where(each), each.entry.step.robot, each.entry.step.move, each.entry.step.task) for each in found
    ]
    say_lines(table(("lines", "robot", "move", "task"), rows))
    return 0


def _tell_changed(found: Sequence[Found]) -> None:
    for file in dict.fromkeys(each.file for each in found if each.changed):
        tell(f"mmrs: {file}: {CHANGED}")


def _where(found: Found) -> str:
    entry = found.entry
    if not entry.first:
        return f"{found.file} ({entry.step.step})"
    return f"{found.file}:{entry.first}" + (f"-{entry.last}" if entry.last > entry.first else "")


def _explanation_json(found: Explanation) -> dict[str, object]:
    return {
        "file": str(found.file),
        "line": found.line,
        "target": found.target,
        "template": found.recorded.template,
        "overridden": found.overridden,
        "changed": found.changed,
        "serves": [_entry_json(entry) for entry in found.entries],
    }


def _place_json(found: Found) -> dict[str, object]:
    return {"file": str(found.file), "changed": found.changed, **_entry_json(found.entry)}


def _entry_json(entry: Entry) -> dict[str, object]:
    return {
        **asdict(entry.step),
        "lines": [entry.first, entry.last] if entry.first else None,
        **asdict(entry.facts),
    }
