"""Renders a target: refusals first, then every file, then the manifest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath, PurePosixPath

from jinja2 import Environment, TemplateError, nodes

from mmrs_core.behaviour.program import Move, Program, RobotProgram
from mmrs_core.contributions.targets import FileSpec, GeneratedFile, Target, TargetInput
from mmrs_core.diagnostics import Place
from mmrs_core.errors import InternalError, MmrsError, UnsupportedError
from mmrs_core.generation.environment import environment_of, rendered_with_lines
from mmrs_core.generation.manifest import (
    Entry,
    Facts,
    Manifest,
    entries_of,
    manifest_path,
    recorded,
    versions_of,
    written,
)
from mmrs_core.generation.overrides import Overrides, check_known
from mmrs_core.generation.tracing import Served, with_lines

RENDERED = ".jinja"


def render(
    target: Target,
    input: TargetInput,
    *,
    allow_lossy: bool = False,
    provider: str = "mmrs-core",
    overrides: Overrides | None = None,
) -> tuple[GeneratedFile, ...]:
    """Return the files of a target for a behaviour, the manifest last.

    Args:
        target: to render.
        input: the behaviour and what belongs to it.
        allow_lossy: leave out what the target cannot express; the manifest lists it.
        provider: the distribution that contributed the target, for the manifest.
        overrides: templates and other files that replace the target's own.

    Raises:
        UnsupportedError: the target cannot express all of the behaviour; lists everything.
        InternalError: the target's templates are broken, or its paths collide or leave the folder.
        MmrsError: a file that is to replace another is broken, or there is no such other.
    """
    losses = tuple(dict.fromkeys(target.refusals(input)))
    if losses and not allow_lossy:
        raise UnsupportedError(_refused(target.name, losses), losses)
    specs = tuple(target.files(input))
    _check_paths(target, specs)
    if overrides is not None:
        check_known(overrides, target, specs)
        check_blocks(environment_of(target, overrides), overrides)
    press = Press(target, environment_of(target, overrides), overrides)
    facts = _facts_of(input.program)
    files: list[GeneratedFile] = []
    entries: list[Entry] = []
    for spec in specs:
        content, served = press.content(spec)
        files.append(GeneratedFile(spec.path, content, spec.once, spec.asks, spec.note))
        entries += entries_of(spec.path, with_lines(spec.trace, served), facts)
    replaced = overrides.hashes if overrides is not None else {}
    records = tuple(recorded(file, spec.template) for file, spec in zip(files, specs, strict=True))
    versions = versions_of(provider)
    manifest = Manifest(target.name, versions, losses, replaced, records, tuple(entries))
    return (*files, written(manifest))


@dataclass(frozen=True, slots=True)
class Press:
    """What makes files of a target's templates."""

    target: Target
    environment: Environment
    overrides: Overrides | None = None

    def content(self, spec: FileSpec) -> tuple[bytes, tuple[Served, ...]]:
        """Return what a file holds, and which of its lines serve which steps."""
        if spec.data is not None:
            return spec.data, ()
        if spec.source is not None:
            return (self._instead_of(spec.path) or spec.source).read_bytes(), ()
        if not spec.template.endswith(RENDERED):
            path = self._instead_of(spec.template) or self.target.templates / spec.template
            return path.read_bytes(), ()
        text, served = rendered_with_lines(self.environment, spec.template, spec.view, self.overrides)
        return text.encode("utf-8"), served

    def _instead_of(self, name: str) -> Path | None:
        return self.overrides.path(name) if self.overrides is not None else None


def _refused(target: str, losses: Sequence[str]) -> str:
    count = "one thing" if len(losses) == 1 else f"{len(losses)} things"
    return f"target {target} cannot express {count} of the behaviour: {'; '.join(losses[:3])}" + (
        " ..." if len(losses) > 3 else ""
    )


def _check_paths(target: Target, specs: Sequence[FileSpec]) -> None:
    taken = {manifest_path(target.name)}
    for spec in specs:
        path = PurePosixPath(spec.path)
        if not spec.path.isascii() or path.is_absolute() or ".." in path.parts or "\\" in spec.path:
            raise InternalError(f"target {target.name}: path {spec.path!r} leaves the folder of the output")
        if spec.path.casefold() in taken:
            raise InternalError(f"target {target.name}: path {spec.path!r} is written twice")
        taken.add(spec.path.casefold())


def _facts_of(program: Program) -> dict[tuple[str, str], Facts]:
    """Return the facts of each move, and of each robot: by robot and move, or no move."""
    of_moves = {
        (robot.id, move.id): _facts(robot, index, move)
        for robot in program.robots
        for index, move in enumerate(robot.moves)
    }
    return of_moves | {(robot.id, ""): Facts(_model(robot.place)) for robot in program.robots}


def _model(place: Place) -> str:
    line = f":{place.line}" if place.line else ""
    return f"{PurePath(place.file).name}{line}" if place.file else ""


def _facts(robot: RobotProgram, index: int, move: Move) -> Facts:
    model = _model(move.place)
    sets = (f"{owner}.{slot}" for action in (*move.before, *move.after) for owner, slot in action.sets)
    transition = robot.transitions.get(index)
    if transition is None:
        return Facts(model, sets=tuple(dict.fromkeys(sets)))
    then = tuple(robot.moves[way].id for way in transition.next_moves)
    return Facts(model, then, transition.waits, transition.condition or "", tuple(dict.fromkeys(sets)))


def check_blocks(environment: Environment, overrides: Overrides) -> None:
    """Require that each block of a template that extends another replaces one there.

    Raises:
        MmrsError: if one does not; names the blocks that there are.
    """
    for name in overrides.hashes:
        if not name.endswith(".jinja"):
            continue
        try:
            tree, above = _parsed(environment, name), _blocks_above(environment, name)
        except (TemplateError, UnicodeDecodeError):
            continue  # what cannot be read is told, with its line, when it is rendered
        if above is None:
            continue
        for block in (node for node in tree.body if isinstance(node, nodes.Block)):
            if block.name not in above:
                there = f"there are {', '.join(sorted(above))}" if above else "there is none"
                raise MmrsError(
                    f"{overrides.folder / name}, line {block.lineno}: what it extends has no block"
                    f" '{block.name}'; {there}"
                )


def _blocks_above(environment: Environment, name: str) -> set[str] | None:
    """Return the blocks of all that a template extends; None where it extends nothing that is known."""
    parent = _parent(_parsed(environment, name))
    if parent is None:
        return None
    own = {block.name for block in _parsed(environment, parent).find_all(nodes.Block)}
    return own | (_blocks_above(environment, parent) or set())


def _parent(tree: nodes.Template) -> str | None:
    extends = tree.find(nodes.Extends)
    found = (
        extends.template.value if extends is not None and isinstance(extends.template, nodes.Const) else None
    )
    return found if isinstance(found, str) else None


def _parsed(environment: Environment, name: str) -> nodes.Template:
    assert environment.loader is not None
    source, _, _ = environment.loader.get_source(environment, name)
    return environment.parse(source, name)
