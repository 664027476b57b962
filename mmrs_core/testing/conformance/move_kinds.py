"""Laws for kinds of moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import hypot, isfinite
from typing import ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.behaviour.program import Move, MoveTarget
from mmrs_core.contributions.rules import MoveKind
from mmrs_core.scene import Kinematics, Position
from mmrs_core.testing.conformance.declared import Conformance, declared, law
from mmrs_core.testing.scenes import FLYER

STATES = frozenset({"grounded", "airborne", "moving"})
MODES = ("SAFE", "NORMAL", "AGGRESSIVE")
SMALL = 1e-6
_METRES = st.integers(-5000, 5000).map(lambda tenths: tenths / 10)
POSITIONS = st.tuples(_METRES, _METRES, _METRES)


class MoveKindConformance(Conformance):
    """Conformance of move kinds: where a robot passes and how long that takes, and both agree.

    Attributes:
        moves: a move of each kind, by the name of its metaclass.
        kinematics: of the robot that makes them.
    """

    moves: ClassVar[Mapping[str, Move]]
    kinematics: ClassVar[Kinematics] = FLYER

    def test_every_kind_has_a_move(self) -> None:
        """No kind goes untested, and no move is left over."""
        assert set(self.moves) == {each.metaclass[1] for each in declared(self.plugin, "move_kinds")}

    def test_a_kind_knows_the_states_it_needs_and_leaves(self, move_kind: MoveKind) -> None:
        """Checks know no others."""
        assert move_kind.needs
        assert move_kind.needs <= STATES
        assert move_kind.leaves is None or move_kind.leaves in STATES

    def test_a_path_begins_where_the_robot_is(self, move_kind: MoveKind) -> None:
        """And it leads through places that exist, the same ones whenever it is asked for."""

        @law(examples=50)
        @given(POSITIONS, st.none() | POSITIONS)
        def holds(here: Position, home: Position | None) -> None:
            path = move_kind.path(self._move(move_kind), here, home)
            if path is None:
                return
            assert path[0] == here
            assert all(isfinite(each) for place in path for each in place)
            assert path == move_kind.path(self._move(move_kind), here, home)

        holds()

    def test_what_vehicles_make_of_it_is_known_without_a_home(self, move_kind: MoveKind) -> None:
        """Targets ask for a path at the origin, without a home: how high a take-off rises, how a GoTo bends.

        A take-off rises by as much wherever the robot stands.
        """
        origin, move = (0.0, 0.0, 0.0), self._move(move_kind)
        if move_kind.manoeuvre == "go_to":
            aimed = replace(move, target=MoveTarget((10.0, 10.0, 10.0)), distance=0.0)
            assert move_kind.path(aimed, origin, None) is not None, "path unknown without a home"
        if move_kind.manoeuvre == "take_off":
            path = move_kind.path(move, origin, None)
            assert path is not None, "path unknown without a home"
            assert path[-1][:2] == origin[:2]
            assert path[-1][2] > 0.0
            elsewhere = move_kind.path(move, (3.0, 4.0, 50.0), (7.0, 8.0, 9.0)) or path
            assert elsewhere[-1] == pytest.approx((3.0, 4.0, 50.0 + path[-1][2]), abs=SMALL)

    @pytest.mark.parametrize("mode", MODES)
    def test_a_move_takes_no_less_time_than_the_robot_needs_for_its_path(
        self, move_kind: MoveKind, mode: str
    ) -> None:
        """The bounds are in order, and no robot exceeds its largest speed."""

        @law(examples=50)
        @given(POSITIONS)
        def holds(here: Position) -> None:
            path = move_kind.path(self._move(move_kind), here, (0.0, 0.0, 0.0)) or (here,)
            seconds = move_kind.seconds(self._move(move_kind), path, self.kinematics, mode)
            shortest, expected, longest = seconds
            assert 0.0 <= shortest <= expected + SMALL
            assert expected <= longest + SMALL
            assert isfinite(longest)
            assert shortest >= _least(path, self.kinematics) - SMALL

        holds()

    def test_a_move_that_says_nothing_crashes_nothing(self, move_kind: MoveKind) -> None:
        """Models are looked at while they are half done."""
        bare = replace(self._move(move_kind), attributes={}, target=None, distance=0.0, speed=None)
        here = (1.0, 2.0, 3.0)
        path = move_kind.path(bare, here, None) or (here,)
        shortest, expected, longest = move_kind.seconds(bare, path, self.kinematics, "NORMAL")
        assert 0.0 <= shortest <= expected <= longest

    def _move(self, kind: MoveKind) -> Move:
        return self.moves[kind.metaclass[1]]


def _least(path: Sequence[Position], kinematics: Kinematics) -> float:
    """Return the seconds that a path takes at the largest speeds, without any stop."""
    return sum(_least_of_leg(start, end, kinematics) for start, end in pairwise(path))


def _least_of_leg(start: Position, end: Position, kinematics: Kinematics) -> float:
    rise = end[2] - start[2]
    level = hypot(end[0] - start[0], end[1] - start[1])
    return max(level / kinematics.fastest, rise / kinematics.climb, -rise / kinematics.descent)
