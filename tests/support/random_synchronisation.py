"""Random behaviours that synchronise, and an exploration of all their runs, step by step."""

from dataclasses import replace

from counts import many
from hypothesis import strategies as st

from mmrs_core.testing.small_programs import hold, notify, program, robot
from mmrs_runtime.semantics import apply, enabled, initial, is_deadlock

MOST_STATES = many(4_000, fast=1_500)
"""States of a behaviour that are looked at before it counts as too large."""

SILENT = {"begin", "end", "act"}


@st.composite
def behaviours(draw, choices=True, loops=False, resets=False, single=False, most=2):
    """Draw a behaviour of two to four robots with up to five slots.

    With `single`, each slot is activated in one place only. A notify sets `most` slots at most.
    """
    names = [f"r{number}" for number in range(draw(st.integers(2, 4)))]
    slots = [f"{draw(st.sampled_from(names))}.s{number}" for number in range(draw(st.integers(1, 5)))]
    made = [draw(_robots(name, slots, choices, loops, resets, most)) for name in names]
    return program(*(_once(made) if single else made))


def _once(robots):
    """Return the robots with only the first activation of each slot left."""
    seen = set()

    def first(action):
        left = tuple(slot for slot in action.sets if slot not in seen)
        seen.update(left)
        return replace(action, sets=left)

    def pruned(move):
        before = tuple(first(action) for action in move.before)
        return replace(move, before=before, after=tuple(first(action) for action in move.after))

    return [replace(robot, moves=tuple(pruned(move) for move in robot.moves)) for robot in robots]


@st.composite
def _robots(draw, name, slots, choices, loops, resets, most):
    moves = [f"m{number}" for number in range(draw(st.integers(1, many(5, fast=4))))]
    own = [slot.partition(".")[2] for slot in slots if slot.startswith(f"{name}.")]
    made = [
        hold(move, before=_actions(draw, slots, resets, most), after=_actions(draw, slots, resets, most))
        for move in moves
    ]
    waits, ways = {}, {}
    for number, move in enumerate(("start", *moves)):
        if own and draw(st.booleans()):
            waits[move] = draw(st.lists(st.sampled_from(own), min_size=1, max_size=2, unique=True))
        if choices and draw(st.integers(0, 3)) == 0:
            least = 0 if loops else number
            after = [*moves[least:], "stop"]
            ways[move] = ("c", draw(st.sampled_from(after)), draw(st.sampled_from(after)))
    return robot(name, made, waits=waits, choices=ways, slots=own)


def _actions(draw, slots, resets, most):
    kind = draw(st.integers(0, 5))
    if kind > 2:
        return ()
    chosen = draw(st.lists(st.sampled_from(slots), min_size=1, max_size=most, unique=True))
    return (notify(*chosen, active=not (resets and kind == 0)),)


def deadlocks(behaviour):
    """Return whether some run of the behaviour ends with a robot waiting; None: too many states."""
    behaviour = behaviour.executable
    first = _settled(behaviour, initial(behaviour))
    seen = {first}
    pending = [first]
    while pending:
        state = pending.pop()
        if is_deadlock(behaviour, state):
            return True
        for step in enabled(behaviour, state):
            after = _settled(behaviour, apply(behaviour, state, step))
            if after not in seen:
                if len(seen) >= MOST_STATES:
                    return None
                seen.add(after)
                pending.append(after)
    return False


def _settled(behaviour, state):
    """Make all steps that touch nothing of other robots: their order does not matter."""
    while True:
        step = next((step for step in enabled(behaviour, state) if step.label in SILENT), None)
        if step is None:
            return state
        state = apply(behaviour, state, step)
