"""Whether robots keep apart, in motion and where they stand, from the first moment to the last.

Two occupations are apart if at every time the parts of the paths on which the robots may then be are far
enough from each other (see `nearness`), or if one is over before the other begins because robots wait for
each other. What then is left is
violated where both are certainly there at one time, however uncertain times are, or cannot pass each
other (see `passing`), and otherwise undecided.
Times are those of the kinds of moves: where these reckon without wind and accelerations, so does this
check, and only waits for each other are proof. Robots at homes that are nearer than that are excused as
`Column` has it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from math import dist, inf

from mmrs_core.analysis.encounters import Encounter, ProvenOrder, apart, certain_encounter, nearest_encounter
from mmrs_core.analysis.figures import MissingFigureError
from mmrs_core.analysis.motion import motions
from mmrs_core.analysis.nearness import legs_of, near_pairs
from mmrs_core.analysis.occupations import HOME_SPOT, Occupation, occupations_of
from mmrs_core.analysis.passing import in_sequence, must_meet
from mmrs_core.analysis.verdicts import TOLERANCE, UnknownMove, unknown, unknown_moves
from mmrs_core.behaviour.program import BEHAVIOUR, Move, Program, RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict
from mmrs_core.diagnostics import lengths

NAME = "separation"


def _run(input: CheckInput) -> Iterator[Verdict]:
    least = input.program.minimum_separation
    if least is None:
        yield Verdict(NAME, Status.NOT_CHECKED, message="the mission sets no minimum separation")
        return
    if input.program.idle:
        everybody = (*input.program.robots, *input.program.idle)
        input = replace(input, program=replace(input.program, robots=everybody, idle=()), shared={})
    occupations: list[Occupation] = []
    undecided = False
    for robot in input.program.robots:
        try:
            occupations += occupations_of(input, robot)
        except MissingFigureError as missing:
            undecided = True
            yield unknown(NAME, robot, str(missing))
            continue
        for gaps in _gaps(input, robot):
            undecided = True
            yield unknown_moves(NAME, robot, gaps)
    needed = least + 2.0 * input.program.position_error
    excused: dict[tuple[str, str], float] = {}
    encounters = list(_encounters(input, occupations, needed, excused))
    proper = _by_robot(each for each in occupations if not each.overshot)
    met = _by_robots(encounters)
    worst = [_judged(input, each, met, proper) for each in _worst(encounters)]
    yield from (_verdict(input, encounter) for encounter in worst)
    if not worst and not undecided:
        words = f"robots keep {needed:.2f} m apart wherever they may be at once"
        caveat = "; ".join(filter(None, (_excuses(excused), _while_charging(input.program))))
        yield Verdict(NAME, Status.SAFE, message=words, caveat=caveat)


def _excuses(excused: Mapping[tuple[str, str], float]) -> str:
    if not excused:
        return ""
    pairs = ", ".join(f"{one} and {other} ({apart:.2f} m)" for (one, other), apart in excused.items())
    return (
        f"excused, since their homes are nearer: {pairs},"
        " while one stands at its home and the other does, too, or is straight above its own,"
        " and their distance is at least that of their homes"
    )


def _while_charging(program: Program) -> str:
    """Return what is taken for granted of robots that charge; empty where none does."""
    charging = [robot.id for robot in program.robots if any(map(_charges, robot.moves))]
    if not charging or len(program.robots) < 2:
        return ""
    return (
        f"provided that {', '.join(charging)} charge{'s' * (len(charging) == 1)} for no longer than checks"
        " count: the log of a run reports it when a robot does"
    )


def _charges(move: Move) -> bool:
    return move.is_a((BEHAVIOUR, "Recharge"))


def _gaps(input: CheckInput, robot: RobotProgram) -> Iterator[list[UnknownMove]]:
    gaps = motions(input)[robot.id].gaps
    if gaps:
        yield gaps


def _encounters(
    input: CheckInput, occupations: list[Occupation], needed: float, excused: dict[tuple[str, str], float]
) -> Iterator[Encounter]:
    """Yield the encounters; add the robots that are excused, and how near their homes are, to `excused`."""
    order: ProvenOrder | None = None
    for i, j in near_pairs(legs_of(occupations), needed).tolist():
        one, other = occupations[i], occupations[j]
        if _excused(one, other, needed):
            excused[one.robot, other.robot] = _between_homes(one, other)
            continue
        order = order or ProvenOrder(input)
        if not order.keeps_apart(one, other):
            found = certain_encounter(one, other, needed, order) or nearest_encounter(one, other, needed)
            yield from [found] if found is not None else []


def _excused(one: Occupation, other: Occupation, needed: float) -> bool:
    """Return whether two robots, whose homes are too near, are only where their homes keep them."""
    homes = _between_homes(one, other)
    if one.radius or other.radius or not homes < needed - TOLERANCE:
        return False
    if apart(one.points, other.points) < max(homes - HOME_SPOT, HOME_SPOT):
        return False
    return (_at_home(one) and _over_home(other, one, needed)) or (
        _at_home(other) and _over_home(one, other, needed)
    )


def _between_homes(one: Occupation, other: Occupation) -> float:
    if one.column is None or other.column is None:
        return inf
    return dist(one.column.home, other.column.home)


def _at_home(occupation: Occupation) -> bool:
    column = occupation.column
    return occupation.stands and column is not None and column.at_foot(occupation.points[0])


def _over_home(occupation: Occupation, neighbour: Occupation, needed: float) -> bool:
    """Return whether a robot is at its home, or in its column wherever it is too near to a neighbour."""
    column = occupation.column
    if column is None or _at_home(occupation):
        return column is not None
    if not column.contains(occupation.points):
        return False
    if occupation.stands:
        return occupation.points[0][2] < column.ceiling
    above = column.above_ceiling(occupation.points)
    return not above or apart(above, neighbour.points) >= needed - TOLERANCE


def _worst(encounters: Iterable[Encounter]) -> list[Encounter]:
    worst: dict[tuple[str, str], Encounter] = {}
    for encounter in encounters:
        pair = (encounter.one.robot, encounter.other.robot)
        known = worst.get(pair)
        if known is None or (not encounter.decided, encounter.apart) < (not known.decided, known.apart):
            worst[pair] = encounter
    return list(worst.values())


def _by_robot(occupations: Iterable[Occupation]) -> dict[str, list[Occupation]]:
    found: dict[str, list[Occupation]] = defaultdict(list)
    for each in occupations:
        found[each.robot].append(each)
    return found


def _by_robots(encounters: Iterable[Encounter]) -> dict[tuple[str, str], list[tuple[Occupation, Occupation]]]:
    """Return, by robots, the occupations that meet, but for those beyond the ends of moves."""
    found: dict[tuple[str, str], list[tuple[Occupation, Occupation]]] = defaultdict(list)
    for each in encounters:
        if not (each.one.overshot or each.other.overshot):
            found[each.one.robot, each.other.robot].append((each.one, each.other))
    return found


def _judged(
    input: CheckInput,
    worst: Encounter,
    met: Mapping[tuple[str, str], Collection[tuple[Occupation, Occupation]]],
    proper: Mapping[str, Collection[Occupation]],
) -> Encounter:
    """Return the worst encounter of two robots, decided if they cannot but come too near somewhere."""
    if worst.decided:
        return worst
    names = worst.one.robot, worst.other.robot
    one, other = (
        in_sequence(input.program.robot(name), motions(input)[name], proper[name]) for name in names
    )
    if one is None or other is None or not must_meet(one, other, met[names], worst.needed):
        return worst
    return replace(worst, decided=True, anyhow=True)


def _verdict(input: CheckInput, encounter: Encounter) -> Verdict:
    one, other = encounter.one, encounter.other
    move = input.program.robot(one.robot).moves[one.move]
    meeting = input.program.robot(other.robot).moves[other.move]
    exact = encounter.anyhow or one.radius + other.radius == 0.0
    most = "at most " if encounter.decided and not exact else ""
    apart, needed = lengths(max(0.0, encounter.apart), encounter.needed)
    words = (
        f"{one.robot}: {_words(one)} '{move.id}' is {most}{apart} from"
        f" {other.robot} {_words(other)} '{meeting.id}' at {encounter.time:.1f} s,"
        f" {needed} are required"
    )
    status = Status.VIOLATED if encounter.decided else Status.UNKNOWN
    if status is Status.UNKNOWN:
        words += "; times are not certain enough: let one wait for the other, or lead them apart"
    if encounter.anyhow:
        words += "; however long their moves take, they cannot pass each other without coming too near"
    margin = encounter.apart - encounter.needed
    return Verdict(NAME, status, one.robot, margin, "m", move.id, message=words, place=move.place)


def _words(occupation: Occupation) -> str:
    return "after" if occupation.waiting else "beyond the end of" if occupation.overshot else "on"


SEPARATION = Check(
    name=NAME,
    title="Robots keep the minimum separation, in motion and where they stand.",
    run=_run,
    hint="let one task wait for the other, move the homes apart, or lower minimumSeparation",
)
