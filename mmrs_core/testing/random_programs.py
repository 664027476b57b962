"""Random small behaviours, for hypothesis."""

from __future__ import annotations

from collections.abc import Mapping

from hypothesis import strategies as st

from mmrs_core.behaviour.program import Action, Move, Program, RobotProgram
from mmrs_core.testing.small_programs import go, hold, notify, program, robot

SLOTS = ("s0", "s1")
CONDITIONS = ("c0", "c1")


@st.composite
def programs(
    draw: st.DrawFn,
    *,
    robots: tuple[int, int] = (2, 4),
    moves: tuple[int, int] = (0, 3),
    resets: bool = True,
    choices: bool = True,
    loops: bool = False,
) -> Program:
    """Draw a behaviour that keeps W1 to W7, though it may get stuck.

    Args:
        draw: given by hypothesis.
        robots, moves: how many, at least and at most.
        resets: whether notifies may make slots inactive.
        choices: whether moves may be followed by a Choice; its conditions are among `CONDITIONS`.
        loops: whether a Choice may lead back.
    """
    ids = [f"r{index}" for index in range(draw(st.integers(*robots)))]
    actions = st.lists(_notifies(ids, resets), max_size=2).map(tuple)
    return program(*(_robot(draw, id, draw(st.integers(*moves)), actions, choices, loops) for id in ids))


def answers() -> st.SearchStrategy[Mapping[str, bool]]:
    """Draw what every condition says."""
    return st.fixed_dictionaries({condition: st.booleans() for condition in CONDITIONS})


def _notifies(ids: list[str], resets: bool) -> st.SearchStrategy[Action]:
    slots = st.tuples(st.sampled_from(ids), st.sampled_from(SLOTS)).map(".".join)
    chosen = st.lists(slots, min_size=1, max_size=2, unique=True)
    active = st.sampled_from((True, True, False)) if resets else st.just(True)
    return st.tuples(chosen, active).map(lambda drawn: notify(*drawn[0], active=drawn[1]))


def _robot(
    draw: st.DrawFn,
    id: str,
    count: int,
    actions: st.SearchStrategy[tuple[Action, ...]],
    choices: bool,
    loops: bool,
) -> RobotProgram:
    moves = [_move(draw, f"m{index}", actions) for index in range(count)]
    names = [move.id for move in moves] + ["stop"]
    waits = st.lists(st.sampled_from(SLOTS), max_size=2, unique=True)
    decided = {
        move.id: _choice(draw, index, names, loops)
        for index, move in enumerate(moves)
        if choices and draw(st.booleans())
    }
    return robot(
        id,
        moves,
        waits={name: draw(waits) for name in ("start", *names[:-1])},
        choices=decided,
        fluid=[name for name in names if draw(st.booleans())],
        slots=SLOTS,
    )


def _choice(draw: st.DrawFn, index: int, names: list[str], loops: bool) -> tuple[str, str, str]:
    following = st.sampled_from(names if loops else names[index + 1 :])
    return draw(st.sampled_from(CONDITIONS)), draw(following), draw(following)


def _move(draw: st.DrawFn, name: str, actions: st.SearchStrategy[tuple[Action, ...]]) -> Move:
    before, after = draw(actions), draw(actions)
    if draw(st.booleans()):
        return hold(name, draw(st.integers(0, 4)) / 2.0, before=before, after=after)
    place = st.integers(-20, 20)
    return go(name, (float(draw(place)), float(draw(place)), 0.0), before=before, after=after)
