"""Runs constraints over models."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from mmrs_core.analysis.constraints.sketch import remembering
from mmrs_core.analysis.constraints.unread import ReadNote, watching
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Diagnostic, in_order
from mmrs_core.errors import InternalError, PluginError
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import context, mission, robot
from mmrs_core.languages.element import Element, Unknown, descendants, metaclass_of, place_of
from mmrs_core.languages.model import Model
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import Registry


def check_constraints(
    models: ModelSet, constraints: Iterable[Constraint], registry: Registry
) -> tuple[Diagnostic, ...]:
    """Return every breach of every constraint by any element of the models, errors first.

    Models may be half done: what is missing breaks no constraint, it breaks the metamodel. Nothing follows
    from what could not be read, which reading has reported.

    Raises:
        PluginError: if a constraint is about a class that its installed metamodel does not have.
        InternalError: if a constraint fails; names it and the element.
    """
    roots = (models.mission, models.context, *models.robots.values(), models.behaviour)
    return _check([root for root in roots if root is not None], models, constraints, registry)


def check_behaviour(
    behaviour: bl.Behaviour,
    constraints: Iterable[Constraint],
    registry: Registry,
    *,
    robots: Mapping[str, robot.Robot] | None = None,
    place: context.Context | None = None,
    files: tuple[Model, ...] = (),
) -> tuple[Diagnostic, ...]:
    """Return every breach by a behaviour that stands for itself, without a mission, and what belongs to it.

    Args:
        behaviour: written by hand, perhaps.
        constraints: those on elements of missions do not apply.
        registry: the metamodels.
        robots: types by name; without any, what depends on them is not checked.
        place: the context.
        files: all files that were read.

    Raises:
        PluginError: as `check_constraints`.
        InternalError: as `check_constraints`.
    """
    models = _alone(behaviour, robots or {}, place, files)
    roots = [behaviour, *([place] if place is not None else []), *models.robots.values()]
    return _check(roots, models, constraints, registry)


def check_planned(
    behaviour: bl.Behaviour, models: ModelSet, constraints: Iterable[Constraint], registry: Registry
) -> tuple[Diagnostic, ...]:
    """Return every breach by a behaviour that was made of valid models, as if it stood for itself.

    Raises:
        PluginError: as `check_constraints`.
        InternalError: as `check_constraints`.
    """
    return _check([behaviour], _alone(behaviour, models.robots, models.context), constraints, registry)


def _alone(
    behaviour: bl.Behaviour,
    robots: Mapping[str, robot.Robot],
    place: context.Context | None,
    files: tuple[Model, ...] = (),
) -> ModelSet:
    return ModelSet(mission.Mission(), place, dict(robots), files, behaviour)


def _check(
    roots: Iterable[Element], models: ModelSet, constraints: Iterable[Constraint], registry: Registry
) -> tuple[Diagnostic, ...]:
    by_metaclass: dict[tuple[str, str], list[Constraint]] = {}
    for constraint in constraints:
        _refuse_misspelt(constraint, registry)
        by_metaclass.setdefault(constraint.metaclass, []).append(constraint)
    broken = [each for model in models.models for each in model.broken]
    with remembering(), watching(broken):
        found = [
            _diagnostic(constraint, breach)
            for root in roots
            for element in (root, *descendants(root))
            if not isinstance(element, Unknown)
            for name in metaclass_of(element).ancestry
            for constraint in by_metaclass.get(name, ())
            for breach in _breaches(constraint, element, models)
        ]
    return in_order(found)


def _refuse_misspelt(constraint: Constraint, registry: Registry) -> None:
    ns_uri, name = constraint.metaclass
    if not registry.has(ns_uri):
        return  # about a language of a plug-in that is not installed, of which there are no elements
    try:
        registry.metaclass(ns_uri, name)
    except ValueError as error:
        raise PluginError(f"constraint {constraint.code}: {error}") from error


def _breaches(constraint: Constraint, element: Element, models: ModelSet) -> Sequence[Finding]:
    """Return the breaches by an element; none where they would follow from what could not be read."""
    try:
        with ReadNote() as reading:
            found = tuple(constraint.check(element, models))
        return () if reading.is_unfounded else found
    except PluginError as error:
        raise PluginError(f"{error}, on {place_of(element).path} of {place_of(element)}") from error
    except Exception as error:
        place = place_of(element)
        raise InternalError(
            f"constraint {constraint.code}: fails on {place.path} of {place}: {error!r}"
        ) from error


def _diagnostic(constraint: Constraint, breach: Finding) -> Diagnostic:
    return Diagnostic(
        constraint.code,
        constraint.severity,
        breach.message,
        place_of(breach.element),
        breach.hint or constraint.hint,
        constraint.expected,
    )
