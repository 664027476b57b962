"""Models from XMI and JSON: all faults reported, nothing fetched, nothing opened outside the project."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.codes import explained
from mmrs_core.languages.collector import collector_at_rest
from mmrs_core.languages.element import Element, Unknown, root_of
from mmrs_core.languages.evolution.migration import may_be_old
from mmrs_core.languages.importers import foreign_file
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.metamodels.text import package_text
from mmrs_core.languages.model import Model
from mmrs_core.languages.references.documents import Draft
from mmrs_core.languages.references.hrefs import real_path
from mmrs_core.languages.references.project import files_beside
from mmrs_core.languages.references.resolution import resolve, resolve_names, tell_other_ends
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.sources import Source
from mmrs_core.languages.xmi.events import Document, read_bytes
from mmrs_core.languages.xmi.quick_reader import QuickReader

if TYPE_CHECKING:
    from mmrs_core.diagnostics import Diagnostic
    from mmrs_core.languages.importers import ForeignFile


class Reading:
    """Several files read together, so that references between them lead to the same elements."""

    def __init__(
        self,
        registry: Registry,
        root: Path | None,
        unsaved: Mapping[Path, bytes] | None = None,
        known: Sequence[Element] = (),
        *,
        complete: bool = False,
    ) -> None:
        """Take the metamodels, and the folder that references must not leave (None: no file at all).

        Texts that are not saved yet are read instead of what their files, by real path, hold. What was
        read before is known to importers, whose files may name robot types. Where the files that are opened
        are not complete, elements are looked for by name in the others of the project, too.
        """
        self._complete = complete
        self._registry = registry
        self._known = tuple(known)
        self._unsaved = unsaved or {}
        self._root = real_path(root) if root is not None else None
        self._drafts: dict[Path, Draft] = {}
        self._neighbours: dict[Path, dict[Path, Path]] = {}
        self._looked_through: dict[Path, Draft | None] = {}
        self._described: dict[str, Draft] = {}
        self._refused: dict[Path, tuple[str, str, str, int]] = {}
        self._unresolved: list[Draft] = []
        self._foreign: list[tuple[Draft, ForeignFile]] = []
        self._following = False

    def open(self, path: Path) -> Draft:
        """Read a file, unless it was read already, without following its references yet.

        Raises:
            UnreadableError: if it is missing, not well-formed, has a DOCTYPE, is too large or too deep.
        """
        real = real_path(path)
        if real in self._refused:
            raise UnreadableError.of(*self._refused[real])
        if real not in self._drafts:
            try:
                data = self._unsaved[real] if real in self._unsaved else read_bytes(path)
                self._drafts[real] = self.parse(data, Source(str(path), real))
            except UnreadableError as refusal:
                # a thousand references must not read it a thousand times
                self._refused[real] = refusal.code, refusal.reason, refusal.file or str(path), refusal.line
                raise
        return self._drafts[real]

    def described(self, ns_uri: str) -> Draft:
        """Return a metamodel of the registry as a model of Ecore, whose classes others may refer to."""
        if ns_uri not in self._described:
            text = package_text(
                self._registry.package(ns_uri), lambda other: f"{'' if other == ns_uri else other}#//"
            )
            source = Source(ns_uri, None)
            source.ns_uri = ns_uri
            self._described[ns_uri] = self.parse(text.encode(), source)
        return self._described[ns_uri]

    def parse(self, data: bytes, source: Source) -> Draft:
        """Read the text of a file; errors as in `open`. One that is imported is empty until `follow`."""
        try:
            draft, refusal = self._parsed(data, source), None
        except UnreadableError as error:
            draft, refusal = Draft(source), error
        if all(isinstance(root, Unknown) for root in draft.roots):
            foreign = foreign_file(data, source.file, self._registry, stored=source.path is not None)
            if foreign is not None:
                draft = Draft(Source(source.file, source.path), importer=foreign.importer)
                self._foreign.append((draft, foreign))
                if self._following:
                    self._import()  # what refers to it looks into it at once
            elif refusal is not None:
                raise refusal
        draft.number_roots()
        self._unresolved.append(draft)
        return draft

    def _parsed(self, data: bytes, source: Source) -> Draft:
        draft = Draft(source)
        with collector_at_rest():
            # most files are plain XMI, and importing the rest takes as long as reading one
            if is_json(source.file):
                from mmrs_core.languages.evolution.loading import read_json

                read_json(data, draft, self._registry)
            elif may_be_old(data, self._registry.chains):
                from mmrs_core.languages.evolution.loading import read_old_xmi

                read_old_xmi(data, draft, self._registry)
            else:
                document = Document(data, source.file)
                document.parse(QuickReader(document, draft, self._registry), counts_depth=True)
        return draft

    def follow(self) -> None:
        """Resolve the references of all files read so far, and of those that they lead to."""
        doubled = []
        waiting: list[Draft] = []
        self._following = True
        self._import()
        with collector_at_rest():
            while self._unresolved or waiting:
                if self._unresolved:
                    draft = self._unresolved.pop(0)
                    doubled.append((draft, resolve(draft, self, self._root, self._registry)))
                    waiting += [draft] if draft.late else []
                else:
                    draft = waiting.pop(0)
                    doubled.append((draft, resolve_names(draft, self, self._registry)))
            for draft, references in doubled:
                tell_other_ends(draft, references)

    def beside(self, draft: Draft) -> Iterator[Draft]:
        """Yield the files read with one, and those of its project that were only looked through."""
        yield from (other for other in self._models() if other is not draft)
        path = draft.source.path
        if path is None or self._root is None or self._complete:
            return
        if path not in self._neighbours:
            self._neighbours[path] = {real_path(file): file for file in files_beside(Path(draft.source.file))}
        for real, file in self._neighbours[path].items():
            if real in self._drafts or not real.is_relative_to(self._root):
                continue
            if real not in self._looked_through:
                self._looked_through[real] = self._look_through(file, real)
            if (found := self._looked_through[real]) is not None:
                yield found

    def _look_through(self, file: Path, real: Path) -> Draft | None:
        """Read a file without following its references; None if it cannot be read."""
        try:
            data = self._unsaved[real] if real in self._unsaved else read_bytes(file)
            draft = self._parsed(data, Source(str(file), real))
        except UnreadableError:
            return None
        draft.number_roots()
        return draft

    def opened(self, element: Element) -> Element:
        """Return an element of a file that was looked through as it is once that is read, or any as it is."""
        source = root_of(element)._mmrs_source
        if all(draft is None or draft.source is not source for draft in self._looked_through.values()):
            return element
        assert source is not None
        found = self.open(Path(source.file)).find(element.eURIFragment())
        assert found is not None  # the file was read a moment ago
        return found

    def _models(self) -> Iterator[Draft]:
        """Yield the files of models; metamodels that they refer to are read with them, and are none."""
        return (draft for path, draft in self._drafts.items() if path.suffix != ".ecore")

    def _import(self) -> None:
        """Fill the drafts of foreign files, those of one importer together."""
        foreign, self._foreign = self._foreign, []
        waiting = {id(draft) for draft, _ in foreign}
        read = [
            root for draft in self._drafts.values() if id(draft) not in waiting for root in draft.source.roots
        ]
        for importer in dict.fromkeys(each.importer for _, each in foreign):
            own = [(draft, each.candidate) for draft, each in foreign if each.importer is importer]
            known = (*self._known, *read)
            made = importer.convert([each for _, each in own], self._registry, known, importer.notes)
            for (draft, _), imported in zip(own, made, strict=True):
                draft.take(imported.roots, imported.diagnostics)

    def model(self, draft: Draft) -> Model:
        """Return what a file holds, with the other files read together with it."""
        others = (self._plain(other) for other in self._models() if other is not draft)
        plain = self._plain(draft)
        return replace(plain, linked=tuple(others))

    def _plain(self, draft: Draft) -> Model:
        file = Path(draft.source.file) if draft.source.path else draft.source.file
        return Model(file, draft.source.roots, _explained(draft), (), frozenset(draft.broken), draft.importer)


def _explained(draft: Draft) -> tuple[Diagnostic, ...]:
    if not draft.diagnostics:
        return ()
    return tuple(map(explained, draft.diagnostics))


def read_model(
    path: Path,
    registry: Registry,
    *,
    root: Path | None = None,
    unsaved: Mapping[Path, bytes] | None = None,
    known: Sequence[Element] = (),
) -> Model:
    """Return the model in a file, and every fault of it.

    Args:
        path: an XMI file, or one of JSON, whose name ends in .json.
        registry: the metamodels it may use.
        root: the folder that references to other files must not leave; by default the file's own.
        unsaved: texts to be read instead of what files hold, by real path.
        known: roots of files read before, such as robot types, that an imported model may name.

    Raises:
        UnreadableError: if the file is missing, not well-formed, has a DOCTYPE, is too large or too deep.
    """
    reading = Reading(registry, root if root is not None else path.parent, unsaved, known)
    draft = reading.open(path)
    reading.follow()
    return reading.model(draft)


def read_text(data: bytes, file: str, registry: Registry) -> Model:
    """Return the model in a text, which messages call ``file``; references to other files are refused.

    Raises:
        UnreadableError: if it is not well-formed XML or JSON, has a DOCTYPE, or nests too deeply.
    """
    if not isinstance(data, bytes):
        raise UnreadableError(f"{file}: expected bytes, not {type(data).__name__}")
    reading = Reading(registry, None)
    draft = reading.parse(data, Source(file, None))
    reading.follow()
    return reading.model(draft)
