"""The project that an import makes, or adds to: in memory, beside the texts of its files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.frame import frame_of, origin_of
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.modelset import project_files
from mmrs_core.languages.sources import Source
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_core.pipeline import check_models, read_models
from mmrs_core.projects.building import UniqueNames
from mmrs_core.projects.kinds import CONTEXT, MISSION
from mmrs_core.projects.texts import text_of, with_added

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.diagnostics import Diagnostic
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.modelset import ModelSet
    from mmrs_core.languages.registry import Registry


@dataclass(slots=True)
class ImportTarget:
    """A new project, or one with its files.

    Attributes:
        files: of its mission and context, by these words.
        robots: files of its robot types.
        types: its robot types, by name.
        texts: what files hold now, by file; none in a new project.
        known: the faults that it has already.
        restated: attributes of the mission that change.
    """

    mission: Element
    context: Element
    files: dict[str, Path]
    robots: tuple[Path, ...] = ()
    types: Mapping[str, Element] = field(default_factory=dict)
    texts: Mapping[Path, bytes] = field(default_factory=dict)
    known: frozenset[tuple[str, str]] = frozenset()
    restated: dict[str, str] = field(default_factory=dict)

    def texts_with(
        self, added: Mapping[str, Iterable[Element]], registry: Registry, comments: Mapping[Element, str]
    ) -> dict[Path, bytes]:
        """Return the texts of context and mission with elements that were added, by feature.

        The context comes first: written in this order, the files are a valid project after each, as a
        mission refers to its context and never the other way round.
        """
        texts: dict[Path, bytes] = {}
        for name, root in (("context", self.context), ("mission", self.mission)):
            file = self.files[name]
            own = {key: each for key, each in added.items() if key in metaclass_of(root).by_name}
            if name == "mission" and "robots" in added:
                own["robots"] = added["robots"]
            if file in self.texts:
                restated = self.restated if name == "mission" else {}
                texts[file] = with_added(self.texts[file], root, own, file, registry, comments, restated)
            elif name == "mission" or own or not self.texts:
                texts[file] = text_of(root, file, registry, comments)
        return texts

    def diagnosed(
        self, files: Mapping[Path, bytes], contributions: Contributions
    ) -> tuple[ModelSet | None, tuple[Diagnostic, ...]]:
        """Return the project as it will be with other contents of some files, and its faults."""
        robots = dict.fromkeys((*self.robots, *(file for file in files if file.parent.name == "robots")))
        context = self.files["context"]
        there = context in files or context in self.texts
        models, faults = read_models(
            self.files["mission"],
            contributions,
            context=context if there else None,
            robots=tuple(robots),
            unsaved={file.resolve(): data for file, data in files.items()},
        )
        return models, faults if models is None else (*faults, *check_models(models, contributions))


def blank(folder: Path, title: str, contributions: Contributions) -> ImportTarget:
    """Return a project without content, which is to be made."""
    create = contributions.languages.create
    name = UniqueNames(()).unique(title, "imported mission")
    mission = create(MISSION, "Mission", name=name, team=create(MISSION, "Team"))
    files = {each: folder / f"{each}.xmi" for each in ("mission", "context")}
    return ImportTarget(mission, _to_stand_in(files["context"], create(CONTEXT, "Context", name=name)), files)


def _to_stand_in(file: Path, root: Element) -> Element:
    """Return the root of a model that is to be written to a file, so that others can refer to it."""
    source = Source(str(file), file.resolve())
    source.roots = (root,)
    root._mmrs_source = source
    return root


def opened(folder: Path, contributions: Contributions) -> ImportTarget:
    """Return the project of a folder or mission file.

    Raises:
        InvalidModelError: if its mission cannot be read, or is a local one.
    """
    models, faults = read_models(folder, contributions)
    if models is None:
        raise InvalidModelError(f"{folder}: cannot be added to: its mission is not readable", faults)
    mission_file, context_file, robots = project_files(folder)
    beside = context_file or mission_file.with_name(f"context{mission_file.suffix}")
    if origin_of(models.mission) is not None and frame_of(models.mission, models.context).latitude is None:
        words = "has no place on the Earth: give it a geographic origin, or its first robot a geographic home"
        raise InvalidModelError(f"{mission_file}: {words}")
    context = models.context or _to_stand_in(beside, contributions.languages.create(CONTEXT, "Context"))
    texts = {file: read_bytes(file) for file in (mission_file, context_file) if file is not None}
    known = frozenset((each.code, each.message) for each in (*faults, *check_models(models, contributions)))
    files = {"mission": mission_file, "context": beside}
    return ImportTarget(models.mission, context, files, robots, models.robots, texts, known)
