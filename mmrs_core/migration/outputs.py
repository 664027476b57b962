"""The files of a migrated project: which model goes where, and none twice."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from mmrs_core.languages.element import Element, is_kind
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.writing import to_xmi
from mmrs_core.migration.findings import Category
from mmrs_core.migration.nodes import Node
from mmrs_core.migration.recording import Record

ROBOT_TYPE = ("urn:mmrs:robot:1.0", "Robot")
_ROLES = {
    "mission": ("urn:mmrs:mission:1.0", "Mission"),
    "context": ("urn:mmrs:context:1.0", "Context"),
    "behaviour": ("urn:mmrs:behaviour:1.0", "Behaviour"),
}
_UNFIT = re.compile(r"[^\w.-]+")


@dataclass(frozen=True, slots=True)
class Made:
    """A model of ours and the node it was made of."""

    element: Element
    node: Node


@dataclass(frozen=True, slots=True)
class Output:
    """A file to write.

    Attributes:
        path: within the project's folder.
        sources: the files it was made of; several where they say the same.
    """

    path: PurePosixPath
    element: Element
    sources: tuple[str, ...]


def outputs_of(made: Sequence[Made], registry: Registry, record: Record) -> tuple[Output, ...]:
    """Return the files of a project; models that say the same become one."""
    types = [each for each in made if is_kind(each.element, *ROBOT_TYPE)]
    outputs = list(_robot_types(_merged(types, registry), record))
    for role, key in _ROLES.items():
        outputs += _in_role(
            role, _merged([each for each in made if is_kind(each.element, *key)], registry), record
        )
    placed = {id(output.element) for output in outputs}
    rest = [
        each
        for each in made
        if not any(is_kind(each.element, *key) for key in (ROBOT_TYPE, *_ROLES.values()))
    ]
    outputs += [
        _named(each, sources) for each, sources in _merged(rest, registry) if id(each.element) not in placed
    ]
    return tuple(outputs)


_Same = list[tuple[Made, tuple[str, ...]]]


def _merged(made: Iterable[Made], registry: Registry) -> _Same:
    """Return the models that differ, each with the files of all that say the same."""
    found: dict[bytes, tuple[Made, list[str]]] = {}
    for each in made:
        first = found.setdefault(to_xmi((each.element,), registry), (each, []))
        if each.node.file not in first[1]:
            first[1].append(each.node.file)
    return [(each, tuple(files)) for each, files in found.values()]


def _in_role(role: str, models: _Same, record: Record) -> list[Output]:
    if len(models) == 1:
        return [Output(PurePosixPath(f"{role}.xmi"), models[0][0].element, models[0][1])]
    for each, _ in models:
        reason = f"a project has one {role}, so each of the {len(models)} is named after its file"
        record.element(Category.DOUBTFUL, reason, each.node)
    return [_named(each, sources) for each, sources in models]


def _named(made: Made, sources: tuple[str, ...]) -> Output:
    return Output(PurePosixPath(f"{_fit(Path(made.node.file).stem)}.xmi"), made.element, sources)


def _robot_types(models: _Same, record: Record) -> Iterable[Output]:
    """Yield the robot types, each under a name of its own."""
    taken: dict[str, str] = {}
    for each, sources in models:
        name = str(getattr(each.element, "name", None) or "robot")
        found, number = name, 2
        while found.casefold() in taken:
            found, number = f"{name}-{number}", number + 1
        if found != name:
            reason = f"{taken[name.casefold()]} has another {name!r}, so this one is called {found!r}"
            record.element(Category.DOUBTFUL, reason, each.node)
            setattr(each.element, "name", found)  # noqa: B010  # a feature, which no class here declares
        taken[found.casefold()] = sources[0]
        yield Output(PurePosixPath(f"robots/{_fit(found)}.xmi"), each.element, sources)


def _fit(name: str) -> str:
    """Return a name that every file system takes."""
    return _UNFIT.sub("_", name).strip(".") or "model"
