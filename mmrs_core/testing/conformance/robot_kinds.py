"""Conformance of robot kinds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from math import inf
from typing import ClassVar, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import MoveSpec, RobotKind
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Kinematics, PolicyEvent, PolicyResponse, Position, Robot, Scene, TravelMode
from mmrs_core.testing.conformance.declared import Conformance, declared, law, made_by
from mmrs_core.testing.scenes import sample_scene

SMALL = 1e-6
_METRES = st.integers(-500, 500).map(float)
_STEPS = st.tuples(st.sampled_from(("east", "north", "up", "all")), _METRES, _METRES, _METRES)


class RobotKindConformance(Conformance):
    """Conformance of robot kinds: plausible figures, and moves that arrive where they should.

    Attributes:
        robots: a robot of each kind, by the kind's name; its kinematics do not matter.
        scene: that they are in, with the context elements that a kind reads.
    """

    robots: ClassVar[Mapping[str, Robot]]
    scene: ClassVar[Scene] = sample_scene()

    def test_every_kind_has_a_robot(self) -> None:
        """No kind goes untested, and no robot is left over."""
        assert set(self.robots) == {each.name for each in declared(self.plugin, "robot_kinds")}

    def test_figures_are_in_order(self, robot_kind: RobotKind) -> None:
        """Limits do not cross, and nothing that is divided by is zero."""
        found = self._kinematics(robot_kind)
        assert 0.0 <= found.slowest <= found.cruise <= found.fastest
        assert found.floor <= found.ceiling
        assert min(found.cruise, found.climb, found.descent, found.turn_rate) > 0.0
        assert min(found.timing.acceleration, found.timing.braking, found.timing.jerk) > 0.0
        assert min(found.endurance, found.energy) > 0.0
        assert min(found.launch, found.recovery, found.power) >= 0.0
        assert found.draw >= 1.0

    def test_figures_are_the_same_in_plans_and_checks(self, robot_kind: RobotKind) -> None:
        """They depend on nothing that a check of the behaviour does not know: tasks and the other robots."""
        robot = self.robots[robot_kind.name]
        alone = replace(self.scene, tasks=(), dependencies=(), robots=(robot,), transit_altitude=None)
        assert robot_kind.kinematics(robot, alone) == robot_kind.kinematics(robot, self.scene)

    def test_bolder_travel_is_no_slower(self, robot_kind: RobotKind) -> None:
        """SAFE, NORMAL, AGGRESSIVE is the order of cruise speeds."""
        modes: tuple[TravelMode, ...] = ("SAFE", "NORMAL", "AGGRESSIVE")
        speeds = [self._kinematics(robot_kind, travel_mode=mode).cruise for mode in modes]
        assert speeds == sorted(speeds)

    def test_a_larger_reserve_leaves_no_more_time_or_energy(self, robot_kind: RobotKind) -> None:
        """The reserve is taken off both."""
        robot = self.robots[robot_kind.name]
        found = [robot_kind.kinematics(robot, replace(self.scene, reserve=each)) for each in (0.0, 0.2, 0.5)]
        for more, less in pairwise(found):
            assert less.endurance <= more.endurance
            assert less.energy <= more.energy
            assert less.endurance < more.endurance or less.endurance == inf

    def test_a_type_that_says_nothing_is_served_or_refused(self, robot_kind: RobotKind) -> None:
        """A type whose figures are missing is refused for a reason, or has figures all the same."""
        robot = self.robots[robot_kind.name]
        bare = replace(robot.type, part=replace(robot.type.part, attributes={}))
        with suppress(InfeasibleError):
            found = robot_kind.kinematics(replace(robot, type=bare), self.scene)
            assert found.floor <= found.ceiling

    @pytest.mark.parametrize("height", [5.0, 25.0, 80.0])
    def test_launching_takes_the_robot_to_the_height_asked_for(
        self, robot_kind: RobotKind, height: float, alone: Contributions
    ) -> None:
        """Who does not launch makes no move for it."""
        east, north, up = home = self.robots[robot_kind.name].home
        if not self._kinematics(robot_kind).launches:
            assert robot_kind.launch(height) == robot_kind.recover() == ()
            return
        passed = _passed(robot_kind.launch(height), home, home, alone)
        assert passed[-1] == pytest.approx((east, north, up + height), abs=SMALL)

    def test_recovering_takes_the_robot_home_from_above(
        self, robot_kind: RobotKind, alone: Contributions
    ) -> None:
        """It ends where it began."""
        east, north, up = home = self.robots[robot_kind.name].home
        if self._kinematics(robot_kind).launches:
            passed = _passed(robot_kind.recover(), (east, north, up + 30.0), home, alone)
            assert passed[-1] == pytest.approx(home, abs=SMALL)

    def test_travel_passes_every_place_of_its_route_and_ends_there(
        self, robot_kind: RobotKind, alone: Contributions
    ) -> None:
        """Moves may join legs, but leave out no place and add none."""
        robot = self.robots[robot_kind.name]

        @law(examples=50)
        @given(st.lists(_STEPS, max_size=6))
        def holds(steps: list[tuple[str, float, float, float]]) -> None:
            route = _route(robot.home, steps)
            wanted = [route[0], *(after for before, after in pairwise(route) if before != after)]
            passed = _passed(robot_kind.travel(route), robot.home, robot.home, alone)
            assert [passed[0], *(after for before, after in pairwise(passed) if before != after)] == wanted

        holds()

    def test_every_fault_has_an_answer(self, robot_kind: RobotKind) -> None:
        """A robot without orders does something that its kind knows to be safe."""
        assert set(robot_kind.policies) == set(get_args(PolicyEvent))
        assert set(robot_kind.policies.values()) <= set(get_args(PolicyResponse))

    def _kinematics(self, kind: RobotKind, travel_mode: TravelMode | None = None) -> Kinematics:
        robot = self.robots[kind.name]
        return kind.kinematics(replace(robot, travel_mode=travel_mode or robot.travel_mode), self.scene)


def _route(home: Position, steps: Sequence[tuple[str, float, float, float]]) -> tuple[Position, ...]:
    """Return a route of level, upright and sloped legs."""
    route = [home]
    for way, east, north, up in steps:
        last = route[-1]
        route.append(
            (
                east if way in ("east", "all") else last[0],
                north if way in ("north", "all") else last[1],
                up if way in ("up", "all") else last[2],
            )
        )
    return tuple(route)


def _passed(
    specs: Sequence[MoveSpec], here: Position, home: Position, known: Contributions
) -> list[Position]:
    """Return the places that a robot passes that makes some moves, where it is first."""
    passed = [here]
    for _, _, path in made_by(specs, here, home, known):
        assert path is not None
        passed += path[1:]
    return passed
