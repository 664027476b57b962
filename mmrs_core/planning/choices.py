"""A choice carried out by one robot: every arm planned, the longest one counted."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from mmrs_core.planning.jobs import Choice
from mmrs_core.planning.materials import Material
from mmrs_core.planning.runs import PortionRun
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import ApproachRoute, Ready, State
from mmrs_core.scene import Branch, Position
from mmrs_core.scene.timing import noticing

MaterialOf = Callable[[str], "Material | None"]
"""The material of a task for the robot; None if it cannot do the task."""

_NOTHING = Ready()


def carry_out(
    pilot: Pilot, choice: Choice, material_of: MaterialOf, state: State, ready: Ready, *, record: bool
) -> State | None:
    """Return the state after a choice: that of the longest arm; None if the robot cannot do every arm.

    The robot goes to where the longest arm begins, waits, and there tests the conditions; all arms end
    at one place.
    """
    begin = _begin(choice, material_of)
    if begin is None:
        return None
    there = pilot.reach(state, begin, pilot.exit_longest(begin.via[-1]), ready, choice.name)
    return None if there is None else _branched(pilot, choice, material_of, there, record)


def _begin(choice: Choice, material_of: MaterialOf) -> ApproachRoute | None:
    """Return the route to the first task of the longest arm; None if a task cannot be done."""
    best: tuple[float, ApproachRoute] | None = None
    for _, items in choice.arms:
        tasks = [task for item in items for task in _tasks(item)]
        materials = [material_of(task) for task in tasks]
        known = [material for material in materials if material is not None]
        if len(known) < len(materials):
            return None
        seconds = sum(material.seconds(0, len(material) - 1) for material in known)
        if known and (best is None or seconds > best[0]):
            first = known[0].approach(0)
            best = (seconds, ApproachRoute(first.via[:1], first.speed))
    return None if best is None else best[1]


def _tasks(item: str | Choice) -> list[str]:
    return list(item.tasks()) if isinstance(item, Choice) else [item]


def _branched(
    pilot: Pilot, choice: Choice, material_of: MaterialOf, state: State, record: bool
) -> State | None:
    ends = []
    for _, items in choice.arms:
        end = _arm(pilot, items, material_of, state._replace(trail=None), record)
        if end is None:
            return None
        ends.append(end)
    joined = [_joined(pilot, ends, place, choice.name) for place in dict.fromkeys(end.at for end in ends)]
    found = [each for each in joined if each is not None]
    if not found:
        return None
    best = min(found, key=lambda each: max(end.time for end in each))
    return _merged(pilot, choice, state, best)


def _arm(
    pilot: Pilot, items: Sequence[str | Choice], material_of: MaterialOf, state: State, record: bool
) -> State | None:
    """Return the state after an arm's tasks and inner choices; None if the robot cannot do them."""
    now: State | None = state
    for item in items:
        if now is None:
            return None
        if isinstance(item, Choice):
            empty = not list(item.tasks())
            now = now if empty else carry_out(pilot, item, material_of, now, _NOTHING, record=record)
            continue
        material = material_of(item)
        if material is None:
            return None
        run = PortionRun(pilot, material, now, 0, _NOTHING, record=record)
        now = run.state(len(material) - 1) if run.can_do(len(material) - 1) else None
    return now


def _joined(pilot: Pilot, ends: Sequence[State], place: Position, name: str) -> list[State] | None:
    """Return the arms' ends once all have come to one place; None if one cannot."""
    need = pilot.exit_longest(place)
    there = [pilot.reach(end, ApproachRoute((place,)), need, _NOTHING, name) for end in ends]
    found = [end for end in there if end is not None]
    return found if len(found) == len(ends) else None


def _merged(pilot: Pilot, choice: Choice, state: State, ends: Sequence[State]) -> State:
    """Return a state that is on the safe side of every arm's end.

    Between two tests, before the first or behind the last, the robot may have to stop.
    """
    arms = tuple((condition, end.steps()) for (condition, _), end in zip(choice.arms, ends, strict=True))
    time = max(end.time for end in ends)
    stops = len(arms) * noticing(pilot.kinematics.timing)
    branch = Branch(state.time, time, choice.name, arms, ends[0].at)
    return State(
        time=time,
        at=ends[0].at,
        away=True,
        used=max(end.used for end in ends) + stops,
        before=max(end.before for end in ends),
        since=min((end.since for end in ends if end.since is not None), default=None),
        early=min(end.early for end in ends),
        late=max(end.late for end in ends) + stops,
        length=max(end.length for end in ends),
        busy=max(end.busy for end in ends),
        sorties=max(end.sorties for end in ends),
        trail=(state.trail, branch),
    )
