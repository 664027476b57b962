"""The files of a migrated project: which model goes where, and none twice."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from mmrs_core.grounding.features import text
from mmrs_core.languages.element import Element, descendants, held, is_kind, label_of, metaclass_of
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.uris import BEHAVIOUR, CONTEXT, MISSION
from mmrs_core.languages.writing import to_xmi
from mmrs_flyaq.findings import Category, Record
from mmrs_flyaq.rules.rules_file import ROBOT_TYPE
from mmrs_flyaq.sources.nodes import SourceNode


def says_no_more(element: Element, other: Element) -> bool:
    """Return whether every value of an element is that of another, which may have further ones.

    So may its lists of elements, in between and at their ends.

    References are not looked at. Robot types have none.
    """
    if metaclass_of(element) is not metaclass_of(other):
        return False
    for feature in metaclass_of(element).features:
        own, others = held(element, feature), held(other, feature)
        if own and not feature.is_reference and list(map(_plain, own)) != list(map(_plain, others)):
            return False
        if own and feature.containment and not _all_among(own, others):
            return False
    return True


def _plain(value: object) -> object:
    """Return a value; a number for a text that is one, which may be written in several ways."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def _all_among(own: Iterable[object], others: Iterable[object]) -> bool:
    """Return whether elements say no more than some of others do, in the same order."""
    rest = iter(others)
    return all(any(_pair(one, other) for other in rest) for one in own)


def _pair(one: object, other: object) -> bool:
    return isinstance(one, Element) and isinstance(other, Element) and says_no_more(one, other)


_ROLES = {
    "mission": (MISSION, "Mission"),
    "context": (CONTEXT, "Context"),
    "behaviour": (BEHAVIOUR, "Behaviour"),
}
_UNFIT = re.compile(r"[^\w.-]+")


@dataclass(frozen=True, slots=True)
class Made:
    """A model of ours, the node it was made of, and all files that say the same."""

    element: Element
    node: SourceNode
    sources: tuple[str, ...]


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
    """Return the files of a project; models that say the same become one.

    Where there are several models of a kind that a project has one of, each goes into a folder of its own,
    with the robot types that it names.
    """
    types = _types(_poorer_left_out([each for each in made if is_kind(each.element, *ROBOT_TYPE)]), record)
    outputs = list(types)
    for role, key in _ROLES.items():
        models = _merged([each for each in made if is_kind(each.element, *key)], registry)
        outputs += _in_role(role, models, types, record)
    placed = {id(output.element) for output in outputs} | {
        id(each.element) for each in made if _has_role(each)
    }
    rest = [each for each in made if id(each.element) not in placed]
    outputs += [Output(PurePosixPath(f"{_stem(each)}.xmi"), each.element, each.sources) for each in rest]
    return tuple(outputs)


def _has_role(made: Made) -> bool:
    return any(is_kind(made.element, *key) for key in (ROBOT_TYPE, *_ROLES.values()))


def _merged(made: Iterable[Made], registry: Registry) -> list[Made]:
    """Return the models that differ, each with the files of all that say the same."""
    found: dict[bytes, Made] = {}
    for each in made:
        data = to_xmi((each.element,), registry)
        known = found.get(data)
        found[data] = _with(known, each.sources) if known is not None else each
    return list(found.values())


def _with(made: Made, sources: tuple[str, ...]) -> Made:
    return Made(made.element, made.node, tuple(dict.fromkeys((*made.sources, *sources))))


def _poorer_left_out(types: Sequence[Made]) -> list[Made]:
    """Return robot types without those of which another of the same name says as much or more."""
    kept: list[Made] = []
    for each in types:
        richer = next((other for other in kept if says_no_more(each.element, other.element)), None)
        if richer is not None:
            kept[kept.index(richer)] = _with(richer, each.sources)
            continue
        poorer = [other for other in kept if says_no_more(other.element, each.element)]
        kept = [other for other in kept if other not in poorer]
        kept.append(_with(each, tuple(file for other in poorer for file in other.sources)))
    return kept


def _types(types: Sequence[Made], record: Record) -> list[Output]:
    """Return the robot types, each under a name of its own."""
    taken: dict[str, str] = {}
    outputs = []
    for each in types:
        name = label_of(each.element) or "robot"
        found, number = name, 2
        while found.casefold() in taken:
            found, number = f"{name}-{number}", number + 1
        if found != name:
            reason = f"{taken[name.casefold()]} has another {name!r}, so this one is called {found!r}"
            record.element(Category.DOUBTFUL, reason, each.node)
            setattr(each.element, "name", found)  # noqa: B010  # a feature, which no class here declares
        taken[found.casefold()] = each.node.file
        outputs.append(Output(PurePosixPath(f"robots/{_fit(found)}.xmi"), each.element, each.sources))
    return outputs


def _in_role(role: str, models: list[Made], types: Sequence[Output], record: Record) -> Iterator[Output]:
    folders = [""] if len(models) == 1 else [f"{folder}/" for folder in _folders(models)]
    for each, folder in zip(models, folders, strict=False):
        yield Output(PurePosixPath(f"{folder}{role}.xmi"), each.element, each.sources)
        if folder:
            reason = f"a project has one {role}, so each of the {len(models)} has a folder of its own"
            record.element(Category.DOUBTFUL, reason, each.node)
            yield from _named_types(each.element, folder, types)


def _folders(models: Sequence[Made]) -> list[str]:
    """Return the names of the files that the models come from, with numbers where they are the same."""
    names: list[str] = []
    for each in models:
        name, number = _stem(each), 2
        while name in names:
            name, number = f"{_stem(each)}-{number}", number + 1
        names.append(name)
    return names


def _named_types(model: Element, folder: str, types: Sequence[Output]) -> Iterator[Output]:
    """Yield the robot types that a model names, within its folder."""
    named = {text(each, feature) for each in descendants(model) for feature in ("type", "typeName")}
    for output in types:
        if label_of(output.element) in named:
            yield Output(PurePosixPath(f"{folder}{output.path}"), output.element, output.sources)


def _stem(made: Made) -> str:
    return _fit(Path(made.node.file).stem)


def _fit(name: str) -> str:
    """Return a name that every file system takes."""
    return _UNFIT.sub("_", name).strip(".") or "model"
