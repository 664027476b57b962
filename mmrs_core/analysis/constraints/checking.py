"""Runs constraints over models."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from mmrs_core.analysis.constraints.sketch import remembering
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Diagnostic, in_order
from mmrs_core.errors import InternalError, PluginError
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import context, mission, robot
from mmrs_core.languages.element import Element, Unknown, descendants, metaclass_of, place_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import Registry


def check_constraints(
    models: ModelSet, constraints: Iterable[Constraint], registry: Registry
) -> tuple[Diagnostic, ...]:
    """Return every breach of every constraint by any element of the models, errors first.

    Models may be half done: what is missing breaks no constraint, it breaks the metamodel.

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
) -> tuple[Diagnostic, ...]:
    """Return every breach by a behaviour that stands for itself, without a mission.

    Args:
        behaviour: written by hand, perhaps.
        constraints: those on other models' elements do not apply.
        registry: the metamodels.
        robots: types by name; without any, what depends on them is not checked.
        place: the context that constraints may look at; it is not checked itself.

    Raises:
        PluginError: as `check_constraints`.
        InternalError: as `check_constraints`.
    """
    models = ModelSet(mission.Mission(), place, dict(robots or {}), (), behaviour)
    return _check([behaviour], models, constraints, registry)


def _check(
    roots: Iterable[Element], models: ModelSet, constraints: Iterable[Constraint], registry: Registry
) -> tuple[Diagnostic, ...]:
    by_metaclass: dict[tuple[str, str], list[Constraint]] = {}
    for constraint in constraints:
        _refuse_misspelt(constraint, registry)
        by_metaclass.setdefault(constraint.metaclass, []).append(constraint)
    with remembering():
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


def _breaches(constraint: Constraint, element: Element, models: ModelSet) -> Iterator[Finding]:
    try:
        yield from constraint.check(element, models)
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
