"""``mmrs convert``: models from XMI to JSON and back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.any_model import Metamodels, faults_in, is_mistake, read_foreign
from mmrs_core.cli.conversion import (
    Converted,
    Form,
    SchemaLocation,
    comments_of,
    converted_together,
    form_of,
    is_followed,
    names_for,
    other_form,
    refuse_existing,
    refuse_imported,
    refuse_links_outside,
    targets_in,
    text_of,
)
from mmrs_core.cli.output import counted, report, say, say_file, say_json, tell
from mmrs_core.cli.protection import files_of, refuse_inputs
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.errors import InvalidModelError
from mmrs_core.languages.element import Unknown
from mmrs_core.languages.writing import replace_file, replace_files

if TYPE_CHECKING:
    from mmrs_core.languages.foreign import ForeignModel
    from mmrs_core.languages.references.by_name import ReferenceNames


def convert(
    call: typer.Context,
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="IN [OUT]",
            help="Model to convert, and the file to write. Default: standard output. With -o, any number of "
            "models and project folders.",
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="DIR|FILE",
            help="Output folder for several models, whose references are kept, or the file of one.",
        ),
    ] = None,
    to: Annotated[
        Form | None,
        typer.Option(
            "--to", help="Output format. Default: by the suffix of OUT, else the one IN does not have."
        ),
    ] = None,
    metamodel: Metamodels = None,
    schema_location: SchemaLocation = None,
    names: Annotated[
        bool,
        typer.Option(
            "--names", help="Write references as names where these are unambiguous. Eclipse reads paths only."
        ),
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite existing files.")] = False,
    json: Json = False,
) -> int:
    """Convert models between XMI and JSON.

    The conversion is lossless but for comments: JSON has none, and XMI keeps those on lines of their own
    before an element. Those left out are counted. Models converted together keep their references to each
    other; all of them are written, or none. References by name become paths, which Eclipse reads, unless
    --names is given.

    Examples: mmrs convert field/mission.xmi mission.json; mmrs convert field -o field-json
    """
    asked = _Asked(
        Session(settings_of(call)), to, tuple(metamodel or ()), schema_location, names, force, json
    )
    if output is not None and output.suffix.lower() in (".xmi", ".json") and not output.is_dir():
        if len(files) > 1 or files[0].is_dir():
            raise typer.BadParameter(f"-o {output}: one file for several models; name an output folder")
        return _alone(asked, files[0], output)
    if output is not None:
        return _together(asked, files, output)
    if len(files) > 2:
        raise typer.BadParameter("several files are converted together with -o DIR, the output folder")
    return _alone(asked, files[0], files[1] if len(files) == 2 else None)


@dataclass(frozen=True, slots=True)
class _Asked:
    """What holds for all files."""

    session: Session
    to: Form | None
    metamodels: tuple[Path, ...]
    exported: Path | None
    by_name: bool
    force: bool
    json: bool


def _together(asked: _Asked, given: Sequence[Path], directory: Path) -> int:
    targets = targets_in(directory, given, asked.to)
    made, faults = converted_together(asked.session, targets, asked.metamodels, asked.exported, asked.by_name)
    report(faults)
    refuse_existing(list(targets.values()), asked.force)
    replace_files({each.target: each.text for each in made})
    if asked.json:
        say_json({"files": [_as_json(each) for each in made], "diagnostics": faults})
        return 0
    for each in made:
        say(f"written: {each.target} ({counted(each.elements, 'element')})")
        _tell_of_names(each.names, each.target)
        _tell_of_comments(each.source, each.comments)
    for file in dict.fromkeys(file for each in made for file in each.beside):
        words = "referred to, and not converted: references lead to where it is"
        lost = (
            "" if is_followed(file, directory) else f", outside {directory}: only Eclipse follows them there"
        )
        tell(f"{file}: note: {words}{lost}")
    return 0


def _as_json(made: Converted) -> dict[str, object]:
    return {
        "source": made.source,
        "file": made.target,
        "form": made.form.value,
        "elements": made.elements,
        "refers_to": made.beside,
        "comments_left_out": made.comments,
        **_names_as_json(made.names),
    }


def _alone(asked: _Asked, source: Path, target: Path | None) -> int:
    found = read_foreign(asked.session, source, asked.metamodels)
    refuse_imported(found.model)
    faults = tuple(faults_in(found))
    if any(map(is_mistake, faults)):
        raise InvalidModelError(f"{source}: not converted, since something of it would be lost", faults)
    report(faults)
    form = asked.to or (form_of(target) if target is not None else other_form(source))
    if target is not None:
        refuse_inputs([target], files_of([found.model]))
        refuse_existing([target], asked.force)
        linked = [each.file for each in found.model.linked if isinstance(each.file, Path)]
        refuse_links_outside(source, target, linked)
    roots, registry, place = found.model.roots, found.registry, target or source
    linked_roots = [each.roots for each in found.model.linked]
    names = names_for(place, roots, [roots, *linked_roots], registry) if asked.by_name else None
    comments = comments_of(source, roots, form)
    text = text_of(roots, registry, source, place, form, asked.exported, names, comments.kept)
    count = sum(1 for _ in found.model.elements())
    if target is None:
        say_file(text)
        _tell_of_names(names, source)
        _tell_of_comments(source, comments.left)
        return 0
    replace_file(target, text)
    if asked.json:
        said = {"file": target, "form": form.value, "elements": count, **_names_as_json(names)}
        said["comments_left_out"] = comments.left
        say_json({**said, "diagnostics": faults})
    else:
        say(f"written: {target} ({counted(count, 'element')})")
        _tell_of_names(names, target)
        _tell_of_comments(source, comments.left)
    _tell_of_kept_links(found, source, target)
    return 0


def _tell_of_comments(file: Path, count: int) -> None:
    if count:
        tell(f"{file}: note: {counted(count, 'comment')} left out")


def _tell_of_names(names: ReferenceNames | None, file: Path) -> None:
    """Report how many references became names, and why others did not."""
    if names is None or not (names.named or names.left):
        return
    words = f"{file}: note: {counted(names.named, 'reference')} by name"
    if names.left:
        kinds = ", ".join(f"{kind} ({count})" for kind, count in sorted(names.left.items()))
        words += f", {names.left.total()} by path, to elements {kinds}"
    tell(words)


def _names_as_json(names: ReferenceNames | None) -> dict[str, object]:
    return {} if names is None else {"references": {"by_name": names.named, "by_path": dict(names.left)}}


def _tell_of_kept_links(found: ForeignModel, source: Path, target: Path) -> None:
    """Report that links in unconverted parts were not adjusted to another folder."""
    if source.resolve().parent == target.resolve().parent:
        return
    if any(isinstance(each, Unknown) for each in found.model.elements()):
        words = "elements of languages that are not installed are kept as they are, with their links to files"
        tell(f"{target}: note: {words}; such links still start from {source.parent}")
