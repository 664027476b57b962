"""Finds every fault of a mission or behaviour, as its files are or as they might be."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from mmrs_core.analysis.fixes.repair import Diagnosis
from mmrs_core.cli.any_model import faults_in, is_foreign, read_foreign
from mmrs_core.cli.behaviours import faults_of, read_behaviour_files
from mmrs_core.cli.session import Session
from mmrs_core.diagnostics import Diagnostic, Severity, in_order
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.languages import behaviour, context, mission, robot
from mmrs_core.languages.codes import explained, refusal
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.model import Model
from mmrs_core.languages.modelset import ModelSet, types_by_name
from mmrs_core.languages.reading import read_model
from mmrs_core.pipeline import check_models, read_models

_NOT_FINITE = "ECO009"
_FOREIGN, _BEHAVIOUR, _PARTS, _MISSION = "foreign", "behaviour", "parts", "mission"


@dataclass(frozen=True, slots=True)
class Subject:
    """What is examined: a mission with what belongs to it, a behaviour, a part of either, or any model."""

    session: Session
    file: Path
    context: Path | None = None
    robots: tuple[Path, ...] = ()
    metamodels: tuple[Path, ...] = ()

    def examined(self) -> Diagnosis:
        """Return all faults, and let observers know; errors as in `diagnose`."""
        doing = "checking the behaviour" if self._sort() is _BEHAVIOUR else "checking the models"
        found: list[Diagnosis] = []

        def check() -> tuple[Diagnostic, ...]:
            found.append(self.diagnose({}))
            return found[0].faults

        self.session.stage("check", doing, check)
        if (project := found[0].project) is not None:
            self.session.have_read(found[0].models, project.context)
        return found[0]

    def diagnose(self, unsaved: Mapping[Path, bytes]) -> Diagnosis:
        """Return all problems, with other texts for some files; an unreadable file is one of them.

        Raises:
            UnreadableError: if a file other than a model's is missing, or not a model at all.
            InvalidModelError: if the behaviour's file, as it is, contains no behaviour.
        """
        ways = {
            _FOREIGN: self._alone,
            _BEHAVIOUR: self._behaviour,
            _PARTS: self._parts,
            _MISSION: self._mission,
        }
        try:
            return ways[self._sort()](unsaved)
        except UnreadableError as error:
            faults = refusal(error)
            if not faults:
                raise
            return Diagnosis(False, in_order(faults), ())

    def _sort(self) -> str:
        """Return what the file is; one that cannot be read is what its name says."""
        try:
            if self.metamodels or is_foreign(self.session, self.file):
                return _FOREIGN
            registry = self.session.contributions.languages
            roots = () if self.file.is_dir() else read_model(self.file, registry).roots
        except UnreadableError:
            return {"mission": _MISSION, "behaviour": _BEHAVIOUR}.get(self.file.stem, _FOREIGN)
        if any(isinstance(root, behaviour.Behaviour) for root in roots):
            return _BEHAVIOUR
        is_part = [isinstance(root, robot.Robot | context.Context) for root in roots]
        return _PARTS if is_part and all(is_part) else _MISSION

    def _alone(self, unsaved: Mapping[Path, bytes]) -> Diagnosis:
        """Return the problems of a model by its metamodels only: its other files are unknown."""
        found = read_foreign(self.session, self.file, self.metamodels, unsaved)
        models = (found.model, *found.model.linked)
        breaches = (fault for each in models for fault in check_conformance(each, found.registry))
        faults = (*faults_in(found), *(_as_emf_takes_it(fault) for fault in breaches))
        return Diagnosis(True, in_order(faults), models)

    def _parts(self, unsaved: Mapping[Path, bytes]) -> Diagnosis:
        files = (self.file, *([self.context] if self.context else []), *self.robots)
        return diagnosed_parts(self.session, files, unsaved)

    def _mission(self, unsaved: Mapping[Path, bytes]) -> Diagnosis:
        contributions = self.session.contributions
        models, faults = read_models(
            self.file, contributions, context=self.context, robots=self.robots, unsaved=unsaved
        )
        if models is None:
            return Diagnosis(False, in_order(faults), self._files(faults, unsaved))
        checked = check_models(models, contributions)
        robots = tuple(models.robots.values())
        return Diagnosis(True, in_order((*faults, *checked)), models.models, models, robots)

    def _files(self, faults: tuple[Diagnostic, ...], unsaved: Mapping[Path, bytes]) -> tuple[Model, ...]:
        """Return the files that faults are in, where there is no mission to hold them together."""
        names = dict.fromkeys(fault.place.file for fault in faults if fault.place.file)
        registry = self.session.contributions.languages
        found = []
        for name in names:
            with suppress(UnreadableError):  # that is among the faults
                found.append(read_model(Path(name), registry, unsaved=unsaved))
        return tuple(found)

    def _behaviour(self, unsaved: Mapping[Path, bytes]) -> Diagnosis:
        files = read_behaviour_files(
            self.session, self.file, context=self.context, robots=self.robots, unsaved=unsaved
        )
        robots = tuple(files.types.values())
        try:
            return Diagnosis(True, faults_of(self.session, files), files.models, None, robots)
        except InvalidModelError as error:
            if not unsaved:
                raise
            return Diagnosis(False, error.diagnostics, files.models, None, robots)


def diagnosed_parts(session: Session, files: Iterable[Path], unsaved: Mapping[Path, bytes]) -> Diagnosis:
    """Return the faults of robot types and of a context that no mission holds together.

    Args:
        unsaved: texts to be read instead of what files hold, by real path.
    """
    from mmrs_core.analysis.constraints import check_constraints

    contributions = session.contributions
    registry = contributions.languages
    models = tuple(read_model(file, registry, unsaved=unsaved) for file in files)
    faults = [fault for model in models for fault in model.diagnostics]
    faults += [fault for model in models for fault in check_conformance(model, registry)]
    roots = [root for model in models for root in model.roots]
    place = next((root for root in roots if isinstance(root, context.Context)), None)
    types = types_by_name((root for root in roots if isinstance(root, robot.Robot)), faults)
    # a blank mission carries the rest; its own faults do not count
    carried = ModelSet(mission.Mission(), place, types, models)
    checked = check_constraints(carried, contributions.constraints, registry)
    faults += [fault for fault in checked if fault.place.file]
    return Diagnosis(True, in_order(map(explained, faults)), models, None, tuple(types.values()))


def _as_emf_takes_it(fault: Diagnostic) -> Diagnostic:
    """Return the fault; as a warning, if it is a number without end, which only missions cannot do with."""
    return replace(fault, severity=Severity.WARNING) if fault.code == _NOT_FINITE else fault
