"""Converts models to their other format: one, or several that refer to each other and still do afterwards."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated
from xml.parsers import expat

import typer

from mmrs_core.cli.any_model import is_mistake, models_in, read_foreign
from mmrs_core.cli.protection import ProtectedError, refuse_inputs
from mmrs_core.diagnostics import Diagnostic, in_order
from mmrs_core.errors import InvalidModelError, UnreadableError, UnsupportedError
from mmrs_core.languages.element import descendants, path_of
from mmrs_core.languages.foreign import kept_places
from mmrs_core.languages.metamodels.export import exported_names, schema_locations
from mmrs_core.languages.metamodels.gathering import gathered
from mmrs_core.languages.reading import Reading, read_model
from mmrs_core.languages.references.by_name import ReferenceNames
from mmrs_core.languages.references.hrefs import real_path
from mmrs_core.languages.references.project import files_beside, is_beside
from mmrs_core.languages.writing import to_json, to_xmi
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_core.languages.xmi.markup import Markup

if TYPE_CHECKING:
    from mmrs_core.cli.session import Session
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.model import Model
    from mmrs_core.languages.registry import Registry


_INDENT = 1000
"""Bytes of white space at most between a comment and its element."""


class Form(StrEnum):
    """How a model is written down."""

    XMI = "xmi"
    JSON = "json"


@dataclass(frozen=True, slots=True)
class Converted:
    """A model in its new form.

    Attributes:
        target: the file that is to hold it.
        elements: how many it has.
        beside: files that it refers to and that are not converted with it.
        names: what its references became, where they were to become names.
        comments: how many of its source are left out.
    """

    source: Path
    target: Path
    form: Form
    text: bytes
    elements: int
    beside: tuple[Path, ...] = ()
    names: ReferenceNames | None = None
    comments: int = 0


def form_of(file: Path) -> Form:
    """Return the form that the name of a file tells."""
    return Form.JSON if file.suffix.lower() == ".json" else Form.XMI


def other_form(file: Path) -> Form:
    """Return the form that a file has not."""
    return Form.XMI if form_of(file) is Form.JSON else Form.JSON


def targets_in(directory: Path, given: Sequence[Path], form: Form | None) -> dict[Path, Path]:
    """Return the file that each model is to go to, by the file that holds it.

    They lie to each other as before. Without a form all are written in the form that the first has not, the
    others too if they have it already.

    Args:
        directory: where to write.
        given: files, and folders of projects, whose models are meant.
        form: of all of them.

    Raises:
        UnreadableError: if a folder has no model, or two models would go to one file.
    """
    files = list(
        dict.fromkeys(file for each in given for file in (models_in(each) if each.is_dir() else [each]))
    )
    wanted = form or other_form(files[0])
    base = Path(os.path.commonpath([file.resolve().parent for file in files]))
    targets: dict[Path, Path] = {}
    for file in files:
        target = directory / (file.resolve().parent.relative_to(base) / file.name).with_suffix(f".{wanted}")
        twin = next((one for one, other in targets.items() if other == target), None)
        if twin is not None:
            raise UnreadableError(f"{file}: would be written to {target}, and so would {twin}")
        targets[file] = target
    return targets


@dataclass(frozen=True, slots=True)
class KeptComments:
    """The comments of a model in XMI.

    Attributes:
        kept: those on lines of their own before an element.
        left: how many stand elsewhere, or are not kept.
    """

    kept: Mapping[Element, str] = field(default_factory=dict)
    left: int = 0


def comments_of(source: Path, roots: Sequence[Element], form: Form) -> KeptComments:
    """Return the comments of a model that it has in a form; JSON has none."""
    data = read_bytes(source)
    if form_of(source) is Form.JSON or b"<!--" not in data:
        return KeptComments()
    count: list[str] = []
    parser = expat.ParserCreate()
    parser.CommentHandler = count.append
    parser.Parse(data, True)
    found: dict[Element, list[str]] = {}
    if form is Form.XMI and len(roots) == 1:
        lines: dict[int, list[Element]] = {}
        for each in (*roots, *descendants(roots[0])):
            lines.setdefault(each._mmrs_line, []).append(each)
        with suppress(UnreadableError):  # not in UTF-8
            markup = Markup(data, str(source))
            for tag in markup.root.everything():
                if words := list(_comments_before(data, tag.begin)):
                    beside = lines.get(tag.line, ())
                    here = [each for each in beside if markup.at(path_of(each), tag.line) is tag]
                    found |= dict.fromkeys(here[:1], words[::-1])
    kept = {each: "\n".join(words) for each, words in found.items()}
    return KeptComments(kept, len(count) - sum(map(len, found.values())))


def _comments_before(data: bytes, at: int) -> Iterator[str]:
    """Yield the comments on lines of their own before a place, the nearest first."""
    while data[max(at - _INDENT, 0) : at].rstrip()[-3:] == b"-->":
        begin = data.rfind(b"<!--", 0, at)
        if data[data.rfind(b"\n", 0, begin) + 1 : begin].strip():
            return
        words = data[begin + 4 : data.index(b"-->", begin)].decode()
        yield "\n".join(line.strip() for line in words.strip().splitlines())
        at = begin


def refuse_existing(targets: Sequence[Path], force: bool) -> None:
    """Refuse files that exist, unless they may be replaced.

    Raises:
        ProtectedError: if one does.
    """
    for target in targets:
        if target.exists() and not force:
            raise ProtectedError(f"{target}: already exists; use --force to overwrite")


def refuse_imported(model: Model) -> None:
    """Refuse a model that was imported from another tool's file: it differs from that file.

    Raises:
        UnsupportedError: if it was.
    """
    if model.importer:
        ways = f"{model.importer.advice}, and --metamodel converts it as it is"
        raise UnsupportedError(f"{model.file}: a model of {model.importer.name}, not converted; {ways}")


def refuse_links_outside(source: Path, target: Path, linked: Sequence[Path]) -> None:
    """Refuse to write a model where its references would lead outside its new folder.

    Args:
        source: the model.
        target: the file that it is to go to.
        linked: files that it refers to, directly or through others.

    Raises:
        UnsupportedError: if it would, with the command that converts all of them together.
    """
    outside = [file for file in linked if not is_followed(file, target.parent)]
    if outside:
        named = ", ".join(map(str, outside))
        together = shlex.join(["mmrs", "convert", *map(str, (source, *linked)), "-o", str(target.parent)])
        message = f"{target}: would refer to {named}, outside its folder, where references are not followed"
        raise UnsupportedError(f"{message}; write it beside {source}, or all together: {together}")


def is_followed(file: Path, directory: Path) -> bool:
    """Return whether references to a file are followed from models in a folder."""
    return file.resolve().is_relative_to(directory.resolve())


def converted_together(
    session: Session,
    targets: dict[Path, Path],
    metamodels: Sequence[Path],
    exported: Path | None,
    by_name: bool = False,
) -> tuple[tuple[Converted, ...], tuple[Diagnostic, ...]]:
    """Return models in their new form, which refer to each other where they will be, and what is wrong.

    With ``by_name``, references become names where these lead to their elements.

    Raises:
        UnreadableError: if a file cannot be read as a model.
        InvalidModelError: if something of one would be lost.
        ProtectedError: if a target is one of the models, or a file that one refers to.
        UnsupportedError: if one cannot be written.
    """
    registry = _registry_for(session, tuple(targets), metamodels)
    base = Path(os.path.commonpath([file.resolve().parent for file in targets]))
    reading = Reading(registry, base)
    drafts = {file: reading.open(file) for file in targets}
    reading.follow()
    models = {file: reading.model(draft) for file, draft in drafts.items()}
    faults = in_order(fault for model in models.values() for fault in model.diagnostics)
    everything = next(iter(models.values()))
    faults = in_order((*faults, *(fault for other in everything.linked for fault in other.diagnostics)))
    if any(map(is_mistake, faults)):
        listed = ", ".join(str(file) for file in targets)
        raise InvalidModelError(f"{listed}: not converted, since something would be lost", faults)
    known = {file.resolve() for file in targets}
    linked = [each.file for each in everything.linked if isinstance(each.file, Path)]
    beside = [file for file in linked if file.resolve() not in known]
    refuse_inputs(targets.values(), [*targets, *beside])
    for file, target in targets.items():
        drafts[file].source.path = target.resolve()  # what refers to it says from now on where it will be
    made = []
    everywhere = [models[file].roots for file in targets]
    everywhere += [each.roots for each in everything.linked if each.file in beside]
    for file, target in targets.items():
        roots, form = models[file].roots, form_of(target)
        names = names_for(target, roots, everywhere, registry) if by_name else None
        comments = comments_of(file, roots, form)
        text = text_of(roots, registry, file, target, form, exported, names, comments.kept)
        count = sum(1 for _ in models[file].elements())
        made.append(Converted(file, target, form, text, count, tuple(beside), names, comments.left))
    return tuple(made), faults


def names_for(
    file: Path, roots: tuple[Element, ...], known: Sequence[tuple[Element, ...]], registry: Registry
) -> ReferenceNames:
    """Return the names by which a model may refer to elements once it stands in a file.

    Args:
        file: where it will be.
        roots: its own.
        known: the roots of all models that were read, which know where their files will be.
        registry: the metamodels.
    """
    place = real_path(file)
    sources = [root._mmrs_source for each in (roots, *known) for root in each]
    read = {place, *(source.path for source in sources if source is not None)}
    others = [each for each in known if each is not roots]
    for other in files_beside(file):
        if real_path(other) not in read:
            with suppress(UnreadableError):  # then no name leads into it
                others.append(read_model(other, registry).roots)
    return ReferenceNames(roots, others, lambda other: is_beside(other, place))


def _registry_for(session: Session, files: Sequence[Path], metamodels: Sequence[Path]) -> Registry:
    """Return the metamodels that are installed, and those that were found for some files."""
    installed = session.contributions.languages
    read = [read_foreign(session, file, metamodels) for file in files]
    for each in read:
        refuse_imported(each.model)
    found = dict.fromkeys(file for each in read for file in each.found)
    return installed.extended(list(gathered(found, installed)))


def text_of(
    roots: Sequence[Element],
    registry: Registry,
    source: Path,
    target: Path,
    form: Form,
    exported: Path | None,
    names: ReferenceNames | None = None,
    comments: Mapping[Element, str] = MappingProxyType({}),
) -> bytes:
    """Return a model in a form, as it is to stand in a file.

    Args:
        roots: what it holds.
        registry: its metamodels.
        source: the file it was read from.
        target: the file it is for.
        form: of the text.
        exported: the folder of metamodels that it is to point Eclipse to.
        names: what its references become.
        comments: on its elements, in XMI.

    Raises:
        UnsupportedError: if it cannot be written in that form.
    """
    places = {**kept_places(source, target), **places_in(exported, registry, target)}
    try:
        if form is Form.JSON:
            return to_json(roots, registry, schema_location=places, file=target, names=names)
        return to_xmi(roots, registry, schema_location=places, file=target, names=names, comments=comments)
    except ValueError as fault:
        raise UnsupportedError(f"{source}: {fault}") from None


SchemaLocation = Annotated[
    Path | None,
    typer.Option(
        "--schema-location",
        metavar="DIR",
        help="Folder written by 'mmrs metamodel export', recorded as xsi:schemaLocation for Eclipse.",
    ),
]


def places_in(directory: Path | None, registry: Registry, file: Path) -> Mapping[str, str]:
    """Return where a model in a file finds the metamodels of a folder, by nsURI; nothing without a folder.

    Raises:
        UnreadableError: if not all metamodels were exported to that folder.
    """
    if directory is None:
        return {}
    for name in exported_names(registry).values():
        if not (directory / name).is_file():
            message = f"{directory}: no {name} in this folder; 'mmrs metamodel export {directory}' writes it"
            raise UnreadableError(message)
    return schema_locations(registry, directory, file)
