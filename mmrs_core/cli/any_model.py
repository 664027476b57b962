"""Reads a model of any language for the commands that take any."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import tell
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.foreign import ForeignModel, missing_from, read_any
from mmrs_core.languages.importers import is_importable
from mmrs_core.languages.missing import is_own
from mmrs_core.languages.registry import core_registry
from mmrs_core.languages.schema_location import first_kind

if TYPE_CHECKING:
    from mmrs_core.cli.session import Session
    from mmrs_core.diagnostics import Diagnostic

NOT_INSTALLED = "XMI001"
_ENDINGS = (".xmi", ".json")

Metamodels = Annotated[
    list[Path] | None,
    typer.Option(
        "--metamodel",
        metavar="FILE",
        help="Metamodel of the input. Default: the .ecore file that xsi:schemaLocation names, or one next to "
        "the input. Repeatable.",
    ),
]


def read_foreign(
    session: Session,
    file: Path,
    metamodels: Sequence[Path] | None,
    unsaved: Mapping[Path, bytes] | None = None,
) -> ForeignModel:
    """Return a model of any language; report metamodels that were found for it, and those not used.

    Nothing is reported of a file that might be one, whose text is in `unsaved`.

    Raises:
        UnreadableError: if the file or a metamodel that was named cannot be read.
        PluginError: if a metamodel is broken.
    """
    refuse_metamodel(file)
    given = tuple(metamodels or ())
    found = read_any(file, session.contributions.languages, given, unsaved)
    if unsaved:
        return found
    used = {each.resolve() for each in found.found}
    for each in given:
        if each.resolve() not in used:
            tell(f"{each}: note: installed already; the installed metamodel is used")
    for ns_uri in sorted(_strange(found)):
        tell(f"{file}: note: if you have the .ecore file of {ns_uri}, give it by --metamodel")
    return found


def models_in(folder: Path) -> list[Path]:
    """Return the files of a project's models, sorted.

    Raises:
        UnreadableError: if the folder has none.
    """
    files = sorted([*folder.glob("*.*"), *(folder / "robots").glob("*.*")])
    models = [file for file in files if file.suffix.lower() in _ENDINGS and not file.name.startswith(".")]
    if not models:
        raise UnreadableError(f"{folder}: no model (*.xmi, *.json) in this folder")
    return models


def is_metamodel(file: Path) -> bool:
    """Return whether a file is called a metamodel."""
    return file.suffix.lower() == ".ecore"


def refuse_metamodel(file: Path) -> None:
    """Refuse a file that is a metamodel.

    Raises:
        UnreadableError: if it is, with what can be done with one.
    """
    if is_metamodel(file):
        ways = "'mmrs show' prints it, 'mmrs diff' compares it, 'mmrs metamodel' does more"
        raise UnreadableError(f"{file}: a metamodel, not a model; {ways}, and --metamodel reads models by it")


def _strange(found: ForeignModel) -> frozenset[str]:
    """Return the languages that no installed plug-in provides."""
    missing = missing_from(found.model, found.registry, certainly=True)
    return frozenset(ns_uri for ns_uri in missing if not is_own(ns_uri))


def is_foreign(session: Session, file: Path) -> bool:
    """Return whether a file holds a model, and its first element is of no language of MMRS's own.

    A model that is imported is none: it becomes one of MMRS's own while it is read.

    Raises:
        UnreadableError: if it is missing or no model at all.
    """
    if file.is_dir():
        return False
    refuse_metamodel(file)
    ns_uri, name = first_kind(file)
    registry = session.contributions.languages
    if not ns_uri or ns_uri in registry.chains:
        return False
    own = {package.ns_uri for package in core_registry().packages}
    if not registry.has(ns_uri) and is_importable(file, registry):
        return False
    kinds = registry.package(ns_uri).metaclasses if registry.has(ns_uri) else ()
    ancestry = next((kind.ancestry for kind in kinds if kind.name == name), ((ns_uri, name),))
    return not any(above in own for above, _ in ancestry)


def is_mistake(fault: Diagnostic) -> bool:
    """Return whether a fault is one of the model, not of a plug-in that is missing here."""
    return fault.severity.value == "error" and fault.code != NOT_INSTALLED


def faults_in(found: ForeignModel) -> Iterable[Diagnostic]:
    """Yield what reading found wrong, in the file and in those that it refers to."""
    yield from found.model.diagnostics
    for other in found.model.linked:
        yield from other.diagnostics
