"""Laws for constraints."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import pytest
from hypothesis import given, note
from hypothesis import strategies as st

from mmrs_core.contributions.constraints import Constraint
from mmrs_core.languages.element import Element
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.uris import BEHAVIOUR, CONTEXT, MISSION
from mmrs_core.testing.conformance.declared import Conformance, declared, law
from mmrs_core.testing.instances import drafts_of, instances_of, models_of
from mmrs_core.testing.models import breaches, findings

Roots = Callable[[Registry], Iterable[Element]]
WHOLE = ((MISSION, "Mission"), (CONTEXT, "Context"), (BEHAVIOUR, "Behaviour"))


@dataclass(frozen=True, slots=True)
class Case:
    """Models that show what a constraint is about.

    Attributes:
        broken: makes models that break it once.
        kept: makes models that keep it, best by as little as possible.
    """

    broken: Roots
    kept: Roots


class ConstraintConformance(Conformance):
    """Every constraint of a plug-in finds what it is for and nothing else, and says so in our words.

    Attributes:
        cases: by code.
    """

    cases: ClassVar[Mapping[str, Case]]

    def test_every_constraint_has_a_case(self) -> None:
        """No constraint goes untested, and no case is left over."""
        assert set(self.cases) == {each.code for each in declared(self.plugin, "constraints")}

    def test_a_breach_is_found_once_and_begins_with_its_culprit(
        self, constraint: Constraint, registry: Registry
    ) -> None:
        """Messages are lower case, without a full stop, the culprit first."""
        found = breaches(constraint, self.cases[constraint.code].broken(registry))
        assert len(found) == 1
        assert found[0][0].islower()
        assert not found[0].endswith(".")

    def test_a_model_that_keeps_the_constraint_passes(
        self, constraint: Constraint, registry: Registry
    ) -> None:
        """What is right is not reported."""
        assert breaches(constraint, self.cases[constraint.code].kept(registry)) == []

    def test_half_a_model_crashes_no_constraint(
        self, constraints: Sequence[Constraint], registry: Registry
    ) -> None:
        """Models are checked while they are being edited."""
        drafts = drafts_of(registry, *constraints[0].metaclass)
        _crashes_none_of(constraints, drafts.map(lambda root: (root,)))

    def test_random_models_crash_no_constraint(
        self, constraints: Sequence[Constraint], registry: Registry
    ) -> None:
        """Whatever a valid model holds; whole projects, where no element of the class can stand alone."""
        try:
            alone = instances_of(registry, *constraints[0].metaclass)
        except ValueError:
            _crashes_none_of(constraints, models_of(registry, *WHOLE))
        else:
            _crashes_none_of(constraints, alone.map(lambda root: (root,)))

    def test_the_documentation_tells_what_must_hold_and_how_to_mend_it(self, constraint: Constraint) -> None:
        """The title is a sentence without a full stop; the hint describes the fix."""
        assert constraint.title[0].isupper()
        assert not constraint.title.endswith(".")
        assert constraint.hint

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        """Run a test of `constraints` once for each metaclass, with all constraints on its elements."""
        super().pytest_generate_tests(metafunc)
        if "constraints" in metafunc.fixturenames:
            found: dict[tuple[str, str], list[Constraint]] = {}
            for each in declared(self.plugin, "constraints"):
                found.setdefault(each.metaclass, []).append(each)
            metafunc.parametrize("constraints", found.values(), ids=[name for _, name in found])


def _crashes_none_of(constraints: Sequence[Constraint], models: st.SearchStrategy[Sequence[Element]]) -> None:
    """Draw models; whatever constraints find in them has a place and a message."""

    @law(examples=15)
    @given(models)
    def holds(roots: Sequence[Element]) -> None:
        for constraint in constraints:
            note(f"constraint {constraint.code}")
            for finding in findings(constraint, roots):
                assert isinstance(finding.element, Element)
                assert finding.message

    holds()
