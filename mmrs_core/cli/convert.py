"""``mmrs convert``: a model from XMI to JSON and back."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.any_model import Metamodels, is_mistake
from mmrs_core.cli.output import counted, report, say, say_file, say_json, tell
from mmrs_core.cli.schema_places import SchemaLocation, places_in
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.errors import InvalidModelError, UnsupportedError

if TYPE_CHECKING:
    from mmrs_core.languages.foreign import ForeignModel


class Form(StrEnum):
    """How a model is written down."""

    XMI = "xmi"
    JSON = "json"


def convert(
    call: typer.Context,
    source: Annotated[Path, typer.Argument(metavar="IN", help="A model, XMI or JSON, of any language.")],
    target: Annotated[
        Path | None, typer.Argument(metavar="OUT", help="The file to write; else it is printed.")
    ] = None,
    to: Annotated[
        Form | None, typer.Option("--to", help="The form to write; else by OUT's ending, or the other one.")
    ] = None,
    metamodel: Metamodels = None,
    schema_location: SchemaLocation = None,
    force: Annotated[bool, typer.Option("--force", help="Replace OUT where it exists.")] = False,
    json: Json = False,
) -> int:
    """Write a model in its other form: XMI as JSON, JSON as XMI. Nothing is lost on the way.

    Example: mmrs convert field/mission.xmi field-json/mission.json
    """
    from mmrs_core.cli.any_model import faults_in, read_foreign
    from mmrs_core.cli.journey import Workshop
    from mmrs_core.cli.protection import ProtectedError, files_of, refuse_inputs

    found = read_foreign(Workshop(settings_of(call)), source, metamodel)
    faults = tuple(faults_in(found))
    if any(map(is_mistake, faults)):
        raise InvalidModelError(f"{source}: not converted, since something of it would be lost", faults)
    report(faults)
    form = to or _form_of(source, target)
    if target is not None:
        refuse_inputs([target], files_of([found.model]))
        if target.exists() and not force:
            raise ProtectedError(f"{target}: exists, and is not replaced; --force replaces it")
    text = _text(found, source, target, form, schema_location)
    count = sum(1 for _ in found.model.elements())
    if target is None:
        say_file(text)
        return 0
    from mmrs_core.languages.writing import replace_file

    replace_file(target, text)
    if json:
        say_json({"file": target, "form": form.value, "elements": count, "diagnostics": faults})
    else:
        say(f"written: {target} ({counted(count, 'element')})")
    _tell_of_kept_links(found, source, target)
    return 0


def _tell_of_kept_links(found: ForeignModel, source: Path, target: Path) -> None:
    """Say that links in what is kept as it is were not adjusted to another folder."""
    from mmrs_core.languages.element import Unknown

    if source.resolve().parent == target.resolve().parent:
        return
    if any(isinstance(each, Unknown) for each in found.model.elements()):
        words = "elements of languages that are not installed are kept as they are, with their links to files"
        tell(f"{target}: note: {words}; such links still start from {source.parent}")


def _form_of(source: Path, target: Path | None) -> Form:
    if target is not None:
        return Form.JSON if target.suffix.lower() == ".json" else Form.XMI
    return Form.XMI if source.suffix.lower() == ".json" else Form.JSON


def _text(found: ForeignModel, source: Path, target: Path | None, form: Form, exported: Path | None) -> bytes:
    from mmrs_core.languages.foreign import kept_places
    from mmrs_core.languages.writing import to_json, to_xmi

    file = target if target is not None else source
    places = {**kept_places(source, file), **places_in(exported, found.registry, file)}
    write = to_json if form is Form.JSON else to_xmi
    try:
        return write(found.model.roots, found.registry, schema_location=places, file=file)
    except ValueError as fault:
        raise UnsupportedError(f"{source}: {fault}") from None
