"""Renders a target: refusals first, then every file, then the manifest."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from jinja2 import Environment

from mmrs_core.contributions.targets import FileSpec, GeneratedFile, Target, TargetInput
from mmrs_core.errors import InternalError, UnsupportedError
from mmrs_core.generation.environment import environment_of, rendered
from mmrs_core.generation.manifest import manifest_of, manifest_path

RENDERED = ".jinja"


def render(
    target: Target, input: TargetInput, *, allow_lossy: bool = False, provider: str = "mmrs-core"
) -> tuple[GeneratedFile, ...]:
    """Return the files of a target for a behaviour, the manifest last.

    Args:
        target: what to render.
        input: the behaviour and what goes with it.
        allow_lossy: leave out what the target cannot express; the manifest lists it.
        provider: the distribution that contributed the target, for the manifest.

    Raises:
        UnsupportedError: the target cannot express all of the behaviour; lists everything.
        InternalError: the target's templates are broken, or its paths collide or leave the folder.
    """
    losses = tuple(dict.fromkeys(target.refusals(input)))
    if losses and not allow_lossy:
        raise UnsupportedError(_refused(target.name, losses), losses)
    specs = tuple(target.files(input))
    _check_paths(target, specs)
    environment = environment_of(target)
    files = tuple(GeneratedFile(spec.path, _content(environment, target, spec), spec.once) for spec in specs)
    trace = ((spec.path, step) for spec in specs for step in spec.trace)
    return (*files, manifest_of(target, provider, files, losses, trace))


def _refused(target: str, losses: Sequence[str]) -> str:
    count = "one thing" if len(losses) == 1 else f"{len(losses)} things"
    return f"target {target} cannot express {count} of the behaviour: {'; '.join(losses[:3])}" + (
        " ..." if len(losses) > 3 else ""
    )


def _content(environment: Environment, target: Target, spec: FileSpec) -> bytes:
    if spec.source is not None:
        return spec.source.read_bytes()
    if spec.template.endswith(RENDERED):
        return rendered(environment, spec.template, spec.view).encode("utf-8")
    return (target.templates / spec.template).read_bytes()


def _check_paths(target: Target, specs: Sequence[FileSpec]) -> None:
    taken = {manifest_path(target.name)}
    for spec in specs:
        path = PurePosixPath(spec.path)
        if not spec.path.isascii() or path.is_absolute() or ".." in path.parts or "\\" in spec.path:
            raise InternalError(f"target {target.name}: path {spec.path!r} leaves the folder of the output")
        if spec.path.casefold() in taken:
            raise InternalError(f"target {target.name}: path {spec.path!r} is written twice")
        taken.add(spec.path.casefold())
