"""The files of a new plug-in."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import Literal, TypeAlias, get_args

from mmrs_core.generation.environment import environment_in, rendered
from mmrs_core.generation.scaffolding.names import PluginNames
from mmrs_core.resources import shipped

TaskKind: TypeAlias = Literal["polygon", "line", "point"]
TASK_KINDS: tuple[TaskKind, ...] = get_args(TaskKind)

_PLAIN = re.compile(r"[A-Za-z0-9 .,:;=#'/()_-]*")
_ENDING = ".jinja"


def plugin_files(names: PluginNames, kind: TaskKind) -> dict[str, bytes]:
    """Return the content of each file by its path in the plug-in's folder, with forward slashes.

    The types of the metamodel are not among them; they are made of the metamodel itself.
    """
    folder = shipped("codegen_templates") / "plugin"
    filters: dict[str, Callable[..., str]] = {"plain": plain}
    environment = environment_in(folder, filters)
    view = {each.name: getattr(names, each.name) for each in fields(names)}
    view |= {"title": names.title, "kind": kind}
    environment.globals.update(view)  # what templates import sees globals only
    return {
        path: rendered(environment, template, view).encode()
        for path, template in sorted(_paths(folder, names, kind))
    }


def plain(value: object) -> str:
    """Return a text that means nothing but itself in any of the files.

    Raises:
        ValueError: if it has a character that may mean something else.
    """
    text = str(value)
    if not _PLAIN.fullmatch(text):
        raise ValueError(f"{text!r} is not plain")
    return text


def metamodel_path(names: PluginNames) -> str:
    """Return where the plug-in's metamodel lies in its folder."""
    return f"{names.package}/metamodels/{names.language}.ecore"


def _paths(folder: Path, names: PluginNames, kind: TaskKind) -> Iterator[tuple[str, str]]:
    """Yield the path of each file with its template's name."""
    common = folder / "common"
    for file in common.rglob(f"*{_ENDING}"):
        inside = file.relative_to(common).as_posix()
        path = re.sub("^package/", f"{names.package}/", inside.removesuffix(_ENDING))
        yield path, f"common/{inside}"
    yield metamodel_path(names), f"{kind}/metamodel.ecore{_ENDING}"
    for module in ("rule.py", "constraints.py"):
        yield f"{names.package}/{module}", f"{kind}/{module}{_ENDING}"
