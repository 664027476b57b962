"""Conformance tests for checks of behaviours."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import pytest

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict, message_of
from mmrs_core.contributions.rules import most_specific, robot_kind_of
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
        every = self._verdicts(check, case.violated)
        found = [each for each in every if each.status is Status.VIOLATED]
        if not found:
            pytest.fail(f"no violation was found:{self._shown(check, every, case.violated)}", pytrace=False)
        robots = {robot.id for robot in case.violated.robots}
        for verdict in found:
            assert verdict.margin is None or verdict.margin < 0.0
            assert verdict.robot in robots | {""}
            assert verdict.message or verdict.margin is not None

    def test_a_behaviour_with_the_property_is_safe(self, check: Check) -> None:
        """Nothing is violated or unknown, and margins are not negative."""
        safe = self.cases[check.name].safe
        found = self._verdicts(check, safe)
        others = {verdict.status for verdict in found} - {Status.SAFE, Status.NOT_CHECKED}
        if others or not any(verdict.status is Status.SAFE for verdict in found):
            pytest.fail(
                f"the behaviour was not found to be safe:{self._shown(check, found, safe)}", pytrace=False
            )
        for verdict in found:
            assert verdict.margin is None or verdict.margin >= 0.0

    def test_verdicts_name_their_check_and_are_lower_case(self, check: Check) -> None:
        """Messages are lower case but for names, as of robots and moves, without a full stop."""
        case = self.cases[check.name]
        for program in (case.violated, case.safe):
            names = tuple(name for robot in program.robots for name in (robot.id, *_names(robot)))
            for verdict in self._verdicts(check, program):
                assert verdict.property == check.name
                words = message_of(verdict).removeprefix(f"{verdict.robot}: ")
                assert words[:1] == words[:1].lower() or words.startswith(names)
                assert not words.endswith(".")

    def test_equal_behaviours_get_equal_verdicts(self, check: Check) -> None:
        """Verdicts depend on nothing but the input."""
        program = self.cases[check.name].violated
        assert self._verdicts(check, program) == self._verdicts(check, program)

    def test_missing_types_and_context_crash_no_check(self, check: Check) -> None:
        """Behaviours are checked without robot types or context, too."""
        known = self.with_core()
        for program in (self.cases[check.name].violated, self.cases[check.name].safe):
            tuple(check.run(CheckInput(program, {}, known.robot_kinds, known.move_kinds, None)))

    def _shown(self, check: Check, verdicts: Iterable[Verdict], program: Program) -> str:
        """Return what a check found, line by line, and what it lacks, since it is not loaded or given."""
        lines = [
            f"{each.status.value}: {message_of(each) or each.robot or 'no message'}"
            f"{'' if each.margin is None else f', margin {each.margin:g} {each.unit}'}"
            for each in verdicts
        ]
        return "\n  ".join(("", *(lines or ["no verdict"]), *self._unknown(check, program)))

    def _unknown(self, check: Check, program: Program) -> Iterator[str]:
        known, types = self.with_core(), self.cases[check.name].types
        moves = (move.metaclasses for robot in program.robots for move in robot.moves)
        strange = sorted({names[0] for names in moves if most_specific(names, known.move_kinds) is None})
        for uri, name in strange:
            yield f"not loaded: the kind of move {name} of {uri}; name its plug-in in more_plugins"
        for type_name in sorted({robot.type_name for robot in program.robots}):
            type = types.get(type_name)
            if type is None:
                yield f"not given: robot type '{type_name}'; add it to the types of the case"
            elif robot_kind_of(type, known.robot_kinds) is None:
                yield f"not loaded: a robot kind for type '{type_name}'; name its plug-in in more_plugins"

    def _verdicts(self, check: Check, program: Program) -> tuple[Verdict, ...]:
        case, known = self.cases[check.name], self.with_core()
        given = CheckInput(
            program, case.types, known.robot_kinds, known.move_kinds, case.areas, case.environment
        )
        return tuple(check.run(given))


def _names(robot: RobotProgram) -> Iterator[str]:
    """Yield the names of the classes of a robot's moves."""
    yield from {move.kind for move in robot.moves}
