"""``mmrs show``: a model as a tree, or what a path leads to in it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.any_model import Metamodels, faults_in, is_metamodel, is_mistake, read_foreign
from mmrs_core.cli.encoding import value_of
from mmrs_core.cli.metamodel_tree import show_metamodel
from mmrs_core.cli.output import report, say, say_json, tell
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.tree_words import tree, value_words, words_for
from mmrs_core.languages.element import Element
from mmrs_core.languages.query.search import Match, NothingFoundError, find

_USAGE = 2


def show(
    call: typer.Context,
    model: Annotated[
        Path,
        typer.Argument(metavar="MODEL", help="Model in XMI or JSON, of any language, or an .ecore file."),
    ],
    path: Annotated[
        str, typer.Option("--path", metavar="PATH", help="Element to show, e.g. 'tasks[2].shell'.")
    ] = "",
    metamodel: Metamodels = None,
    depth: Annotated[
        int, typer.Option("--depth", metavar="N", min=0, help="Maximum depth; 0 is unlimited.")
    ] = 0,
    json: Json = False,
) -> int:
    """Print a model, or one element, as a tree.

    Prints the classes of an .ecore file. Elements of a plug-in that is not installed are shown as unknown.

    Examples of paths: 'tasks[2].shell', 'team.robots[name=Hawk].home', '//GoTo[speed>3]', '//@tasks.0'; '/1'
    is the second root of a file.
    """
    if is_metamodel(model):
        if path:
            raise typer.BadParameter(f"--path leads into models, and {model} is a metamodel")
        return show_metamodel(call, model, depth, json)
    found = read_foreign(Session(settings_of(call)), model, metamodel)
    faults = tuple(faults_in(found))
    report(faults)
    try:
        matches = find(found.model.roots, path)
    except NothingFoundError as nothing:
        tell(f"mmrs: {model}: {nothing}")
        matches = ()
    except ValueError as fault:
        tell(f"mmrs: {model}: {fault}")
        return _USAGE
    if json:
        _say_as_json(model, found.model.roots, matches if path else None)
    else:
        _say(matches, depth, with_paths=bool(path) or len(matches) > 1)
    return 1 if not matches or any(map(is_mistake, faults)) else 0


def _say_as_json(file: Path, roots: Sequence[Element], matches: Sequence[Match] | None) -> None:
    if matches is None:
        say_json({"file": file, "roots": roots})
        return

    found = [
        {
            "path": each.path,
            "line": each.owner._mmrs_line,
            "value": value_of(each.feature, each.value) if each.feature else each.value,
        }
        for each in matches
    ]
    say_json({"file": file, "found": found})


def _say(matches: Sequence[Match], depth: int, with_paths: bool) -> None:
    for match in matches:
        lead = f"{match.path}: " if with_paths else ""
        if isinstance(match.value, Element):
            first, *rest = tree(match.value, depth)
            say(f"{lead}{first}")
            for line in rest:
                say(line)
        else:
            words = words_for(match.feature, match.value) if match.feature else value_words(match.value)
            say(f"{lead}{words}")
