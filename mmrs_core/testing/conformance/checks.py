"""Conformance tests for checks of behaviours."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict
from mmrs_core.scene import Area, RobotType
from mmrs_core.testing.conformance.declared import Conformance, declared


@dataclass(frozen=True, slots=True)
class CheckCase:
    """Behaviours that show what a check is about.

    Attributes:
        violated: a behaviour that violates the property, best by as little as possible.
        safe: a behaviour that has it, best with as little margin as possible.
        types: robot types by name.
        areas: of the context, as drawn.
        environment: of the context, by attribute name.
    """

    violated: Program
    safe: Program
    types: Mapping[str, RobotType] = field(default_factory=dict)
    areas: tuple[Area, ...] = ()
    environment: Mapping[str, float] = field(default_factory=dict)


class CheckConformance(Conformance):
    """Every check of a plug-in finds the violation that it is for, and is never safe without a reason.

    Attributes:
        cases: by the check's name.
    """

    cases: ClassVar[Mapping[str, CheckCase]]

    def test_every_check_has_a_case(self) -> None:
        """No check goes untested, and no case is left over."""
        assert set(self.cases) == {each.name for each in declared(self.plugin, "checks")}

    def test_it_has_a_name_a_title_and_a_hint(self, check: Check) -> None:
        """The name is snake_case, the title a sentence; the hint describes the fix."""
        assert re.fullmatch(r"[a-z][a-z0-9_]*", check.name)
        assert check.title[0].isupper()
        assert check.hint

    def test_a_violation_is_found_and_located(self, check: Check) -> None:
        """A verdict is violated, with a negative margin where it has one, and names the robot."""
        case = self.cases[check.name]
        found = [each for each in self._verdicts(check, case.violated) if each.status is Status.VIOLATED]
        assert found
        robots = {robot.id for robot in case.violated.robots}
        for verdict in found:
            assert verdict.margin is None or verdict.margin < 0.0
            assert verdict.robot in robots | {""}
            assert verdict.message or verdict.margin is not None

    def test_a_behaviour_with_the_property_is_safe(self, check: Check) -> None:
        """Nothing is violated or unknown, and margins are not negative."""
        found = self._verdicts(check, self.cases[check.name].safe)
        assert any(verdict.status is Status.SAFE for verdict in found)
        for verdict in found:
            assert verdict.status in (Status.SAFE, Status.NOT_CHECKED)
            assert verdict.margin is None or verdict.margin >= 0.0

    def test_verdicts_name_their_check_and_are_lower_case(self, check: Check) -> None:
        """Messages are lower case, without a full stop; units go with margins."""
        case = self.cases[check.name]
        for verdict in (*self._verdicts(check, case.violated), *self._verdicts(check, case.safe)):
            assert verdict.property == check.name
            assert verdict.message[:1] == verdict.message[:1].lower()
            assert not verdict.message.endswith(".")

    def test_equal_behaviours_get_equal_verdicts(self, check: Check) -> None:
        """Verdicts depend on nothing but the input."""
        program = self.cases[check.name].violated
        assert self._verdicts(check, program) == self._verdicts(check, program)

    def test_missing_types_and_context_crash_no_check(self, check: Check) -> None:
        """Behaviours are checked without robot types or context, too."""
        known = self.with_core()
        for program in (self.cases[check.name].violated, self.cases[check.name].safe):
            tuple(check.run(CheckInput(program, {}, known.robot_kinds, known.move_kinds, None)))

    def _verdicts(self, check: Check, program: Program) -> tuple[Verdict, ...]:
        case, known = self.cases[check.name], self.with_core()
        given = CheckInput(
            program, case.types, known.robot_kinds, known.move_kinds, case.areas, case.environment
        )
        return tuple(check.run(given))
