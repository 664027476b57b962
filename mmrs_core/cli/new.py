"""``mmrs new``: a new mission of a place, robots and tasks, which can be planned at once."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.asking import ask, is_terminal
from mmrs_core.cli.output import counted, progress, report, say, say_json, say_lines, table, tell
from mmrs_core.cli.protection import ProtectedError
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.diagnostics import has_errors
from mmrs_core.errors import InvalidModelError, UsageError
from mmrs_core.languages.writing import make_folder

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.projects.beginning import Beginning, TaskWanted
    from mmrs_core.projects.importing import ImportResult
    from mmrs_core.projects.team import RobotWanted

MOST_ROBOTS = 20
_SEVERAL = re.compile(r"(\d{1,3})\s*[x×]\s*(\S.*)")
_Robots = Annotated[
    list[str] | None,
    typer.Option(
        "--robot",
        metavar="[NAME=|Nx]TYPE",
        help="Robot of the team, or N of them, of a type, see --list. Without a NAME they are called Alpha, "
        "Bravo, … Repeatable.",
    ),
]
_Tasks = Annotated[
    list[str] | None,
    typer.Option(
        "--task",
        metavar="TYPE[:NAME=VALUE,...]",
        help="Task beside the homes, with attributes, see --list. Repeatable.",
    ),
]


def new(
    call: typer.Context,
    folder: Annotated[
        Path | None, typer.Argument(metavar="FOLDER", help="New project folder.", show_default=False)
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            "--at",
            metavar="LAT,LON",
            help="Home of the first robot: decimal degrees, degrees and minutes, a geo: address or a link "
            "of a map program.",
        ),
    ] = None,
    robot: _Robots = None,
    task: _Tasks = None,
    listed: Annotated[
        bool,
        typer.Option(
            "--list", help="List the robot types, and the task types with the robot types that can do them."
        ),
    ] = False,
    empty: Annotated[
        bool, typer.Option("--empty", help="Write a skeleton with comments, without robots and tasks.")
    ] = False,
    json: Json = False,
) -> int:
    """Make a new mission that is ready to plan.

    Asks for what the options leave open, if it runs in a terminal. Robots begin in a row to the east, with
    tasks of a sensible size beside them; move these in the files, or draw your own areas and add them with
    mmrs import --into. Nothing is written before the project is known to be valid.

    Example: mmrs new field --at 43.77,11.25 --robot '2xFreefly Astro LR1' --task PhotoGridTask
    """
    session = Session(settings_of(call))
    contributions = session.contributions
    if listed:
        return _list(contributions, json)
    if folder is None:
        raise typer.BadParameter("name the FOLDER of the new project")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ProtectedError(f"{folder}: exists and is not empty; choose another folder")
    title = folder.resolve().name
    if empty:
        if at or robot or task:
            raise typer.BadParameter("--empty goes without --at, --robot and --task")
        from mmrs_core.projects.notes import empty_project

        made = empty_project(folder, title, contributions)
    else:
        made = _begun(folder, title, at, _given(robot or ()), task or (), contributions)
        if has_errors(made.diagnostics):
            raise InvalidModelError("nothing written: the project would not be valid", made.diagnostics)
        report(made.diagnostics)
    make_folder(folder, made.files)
    if json:
        say_json({"files": sorted(made.files)})
        return 0
    _tell_next(folder, made, empty)
    return 0


def _begun(
    folder: Path,
    title: str,
    at: str | None,
    robots: Sequence[RobotWanted],
    tasks: Sequence[str],
    contributions: Contributions,
) -> ImportResult:
    """Return the project; what the options leave open is asked for at a terminal."""
    from mmrs_core.projects.beginning import Beginning
    from mmrs_core.projects.positions import FORMS, position_of

    missing = [name for name, there in (("--at", at), ("--robot", robots), ("--task", tasks)) if not there]
    if missing and not is_terminal():
        hint = "'mmrs new --list' lists robot and task types, --empty makes a skeleton"
        raise typer.BadParameter(f"{', '.join(missing)}: missing, and only a terminal can be asked; {hint}")
    if missing:
        tell(f"New mission in {folder}. Ctrl-C ends; nothing is written before the end.")
    asked = 0

    def step() -> str:
        nonlocal asked
        asked += 1
        return f"{asked}/{len(missing)}"

    def begin(text: str) -> Beginning:
        return Beginning(position_of(text, "--at" if at is not None else "position"), contributions)

    if at is not None:
        beginning = begin(at)
    else:
        tell(f"{step()} Where does the first robot start? A position {FORMS}")
        beginning = ask("Position", begin)
    if not robots:
        tell(f"{step()} Which robots?")
        robots = _asked_robots(contributions)
    _known_types(robots, contributions)
    if tasks:
        wanted = [_task(text, f"--task '{text}'") for text in tasks]
    else:
        tell(f"{step()} What are they to do?")
        wanted = _asked_tasks(beginning, robots)
    with progress("planning the mission"):
        return beginning.project(folder, title, robots, wanted)


def _given(stated: Iterable[str]) -> tuple[RobotWanted, ...]:
    """Return the robots of the options, those with names first: others are not called like them."""
    found: list[RobotWanted] = []
    for text in sorted(stated, key=lambda each: "=" not in each):
        found += _robots_of(text, f"--robot '{text}'", found)
    return tuple(found)


def _robots_of(text: str, source: str, before: Sequence[RobotWanted]) -> list[RobotWanted]:
    """Return the robots that a text states: NAME=TYPE, NUMBERxTYPE or TYPE."""
    from mmrs_core.projects.beginning import names_for
    from mmrs_core.projects.team import RobotWanted

    name, equals, kind = text.partition("=")
    several = _SEVERAL.fullmatch(text.strip())
    taken = [each.name for each in before]
    if equals:
        if not name.strip() or not kind.strip():
            raise UsageError(f"{source}: expected NAME=TYPE")
        if name.strip().casefold() in (each.casefold() for each in taken):
            raise UsageError(f"{source}: another robot is called {name.strip()} already")
        return [RobotWanted(name.strip(), kind.strip())]
    count = int(several[1]) if several else 1
    if not 1 <= count <= MOST_ROBOTS - len(taken):
        raise UsageError(f"{source}: a new mission has 1 to {MOST_ROBOTS} robots")
    kind = (several[2] if several else text).strip()
    return [RobotWanted(each, kind) for each in names_for(count, taken)]


def _known_types(robots: Iterable[RobotWanted], contributions: Contributions) -> None:
    from mmrs_core.languages.naming import nearest

    known = contributions.robot_types
    for each in robots:
        if each.type not in known:
            words = nearest(each.type, known) or f"there are {', '.join(known) or 'none'}"
            raise UsageError(
                f"robot {each.name!r}: no robot type {each.type!r}; {words}", _type_lines(contributions)
            )


def _task(text: str, source: str) -> TaskWanted:
    from mmrs_core.projects.beginning import TaskWanted
    from mmrs_core.projects.choosing import assignment_of

    found = assignment_of(f"*={text}", source)
    return TaskWanted(found.kind, found.attributes, source)


def _asked_robots(contributions: Contributions) -> tuple[RobotWanted, ...]:
    types = list(contributions.robot_types)
    if not types:
        raise UsageError("no robot type is installed; --empty makes a skeleton for types of your own")
    rows = [
        (str(number), name, contributions.robot_types[name].description)
        for number, name in enumerate(types, 1)
    ]
    for line in table(("no.", "type", "machine"), rows):
        tell(line)

    def understood(answer: str) -> tuple[RobotWanted, ...]:
        found: list[RobotWanted] = []
        for part in filter(None, map(str.strip, answer.split(","))):
            found += _robots_of(_numbered(part, types), part, found)
        if not found:
            raise UsageError("a mission has one robot at least")
        _known_types(found, contributions)
        return tuple(found)

    return ask(
        "Numbers or types with commas, such as 1, 2x3 or Hawk=1", understood, _usual(types, contributions)
    )


def _usual(types: Sequence[str], contributions: Contributions) -> str:
    """Return the number of the first type that flies, else of the first one."""
    from mmrs_core.projects.team import RobotWanted, medium_of, types_for

    for number, name in enumerate(types, 1):
        element = types_for([RobotWanted("", name)], (), contributions)[name].element
        if medium_of(element, contributions) == "air":
            return str(number)
    return "1"


def _asked_tasks(beginning: Beginning, robots: Sequence[RobotWanted]) -> list[TaskWanted]:
    from mmrs_core.projects.beginning import TaskWanted

    types = tuple(dict.fromkeys(each.type for each in robots))
    with progress("trying which tasks they can do"):
        found = [(name, beginning.doers(TaskWanted(name), types)[0]) for name in beginning.task_types()]
    possible = {name: able for name, able in found if able}
    rows = [
        (str(number), name, beginning.label_of(name), ", ".join(able))
        for number, (name, able) in enumerate(possible.items(), 1)
    ]
    for line in table(("no.", "task", "what", "by"), rows):
        tell(line)
    names = list(possible)

    def understood(answer: str) -> list[TaskWanted]:
        wanted = [
            _task(_numbered(part, names), part) for part in filter(None, map(str.strip, answer.split(",")))
        ]
        if not wanted:
            raise UsageError("a new mission has one task at least")
        for each in wanted:
            beginning.require(each, types)
        return wanted

    usual = next((name for name in names if beginning.is_usual(name)), names[0] if names else "")
    return ask("Numbers or names with commas", understood, usual and str(names.index(usual) + 1))


def _numbered(part: str, names: Sequence[str]) -> str:
    """Return an answer with the name instead of its number, which ``2``, ``3x2`` and ``Hawk=2`` have."""
    found = re.fullmatch(r"(.*?=\s*|\d{1,3}\s*[x×]\s*)?(\d{1,3})", part)
    if found is None:
        return part
    number = int(found[2])
    if not 1 <= number <= len(names):
        raise UsageError(f"{part}: the numbers go from 1 to {len(names)}")
    return f"{found[1] or ''}{names[number - 1]}"


def _type_lines(contributions: Contributions) -> tuple[str, ...]:
    return tuple(f"{each.name}: {each.description}" for each in contributions.robot_types.values())


def _list(contributions: Contributions, json: bool) -> int:
    """List the robot types, and which of them can do which tasks."""
    from mmrs_core.projects.beginning import Beginning, TaskWanted

    beginning = Beginning((0.0, 0.0), contributions)
    types = contributions.robot_types
    with progress("trying which tasks they can do"):
        tasks = {name: beginning.doers(TaskWanted(name), types)[0] for name in beginning.task_types()}
    if json:
        say_json({"robots": {name: each.description for name, each in types.items()}, "tasks": tasks})
        return 0
    say_lines(table(("robot type", "machine"), [(name, each.description) for name, each in types.items()]))
    say()
    doers = [(name, beginning.label_of(name), ", ".join(able) or "none") for name, able in tasks.items()]
    say_lines(table(("task type", "what", "by"), doers))
    return 0


def _tell_next(folder: Path, made: ImportResult, empty: bool) -> None:
    for file in [*made.files][::-1]:
        say(f"written: {file}")
    where = quote(str(folder))
    if empty:
        say(f"next: copy robot types to {where}/robots, write the mission, then: mmrs validate {where}")
        return
    tasks = sum(each.became.endswith("Task") for each in made.outcomes)
    them = "it" if tasks == 1 else "them"
    say(f"{counted(tasks, 'task')} laid beside the homes: move {them}, and read the comments in mission.xmi")
    say(f"next: mmrs plan {where}; mmrs preview {where}; mmrs simulate {where} -o {where}/logs")
