"""Whether robots come to their tasks, and go back home, through corridors where there are some.

A sortie begins at Start, or at a Recharge. From there to the first move that works on a task, some part of
the path must follow the line of a corridor from its one end to the other; from the last such move back home,
that of a corridor in the other direction. All along, the robot keeps half its diagonal, the position error
and the room that it needs to turn from both sides, and from the corridor's heights; where it cuts a corner or
stops late, so much more. Between tasks, in a diversion, and where it does not come out of the field after its
last task, it goes where it likes; in the field is where it works, and where the nearest end of all corridors
out is an inner one. A sortie on a branch without work follows one line in, and out if it leaves the field.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import dist, inf

from mmrs_core.analysis.clearance import cuts, stops
from mmrs_core.analysis.figures import half_diagonal_of, home_of, kinematics_of, type_of
from mmrs_core.analysis.following import Piece, Tube
from mmrs_core.analysis.motion import Motion, MovePath, motions
from mmrs_core.analysis.sorties import RECHARGE
from mmrs_core.analysis.verdicts import (
    TOLERANCE,
    Margin,
    UnknownMove,
    for_each_robot,
    judged,
    not_checked,
    safe,
)
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.behaviour.walk import reachable_moves
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict
from mmrs_core.diagnostics import lengths
from mmrs_core.scene import Corridor, Point, Position

NAME = "corridors"

_HOME = 1.0
"""Metres from home within which a path ends at home."""

_SAME = 1e-6
"""Metres within which one path begins where another ends."""

_CLOSE = 1e-6
"""Metres within which the spare room of a path is found."""

_MOST = 256
"""Paths that are looked at from one move on; there are more only where many choices follow each other."""


@dataclass(frozen=True, slots=True)
class _Way:
    """A path from home to a task, or from a task back home.

    Attributes:
        words: what it is.
        inwards: whether it leads to a task.
        parts: pieces of it, in runs of which everything is known.
        gaps: moves on it of which something is not known.
        last: the move that it ends with, or ends at.
    """

    words: str
    inwards: bool
    parts: tuple[tuple[Piece, ...], ...]
    gaps: tuple[UnknownMove, ...]
    last: int


def _judge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    if input.areas is None:
        yield not_checked(NAME, robot, "no context was given")
        return
    if not input.corridors:
        return
    mine = [each for each in input.corridors if each.concerns(robot.type_name)]
    if not mine:
        yield not_checked(NAME, robot, "no corridor of the context is for its type")
        return
    own = input.program.position_error + half_diagonal_of(type_of(input, robot))
    own += kinematics_of(input, robot).turning_radius
    tubes = {
        True: [(each.name, _tube(each, each.way_in, own)) for each in mine if each.way_in],
        False: [(each.name, _tube(each, each.way_out, own)) for each in mine if each.way_out],
    }
    walk = _Walk(input, robot, [each.way_out for each in mine if each.way_out])
    margins, gaps = list[Margin](), [*walk.gaps]
    for way in walk.ways:
        if not tubes[way.inwards]:
            continue
        margin = _margin(robot, way, tubes[way.inwards], min((each.value for each in margins), default=inf))
        if margin is not None and (margin.value >= 0.0 or not way.gaps):
            margins.append(margin)
        elif margin is not None:
            gaps += way.gaps
    for there, back in walk.round_trips:
        trip = (there, replace(back, parts=_beyond(there, tubes[True])))
        both = [_margin(robot, each, tubes[each.inwards], inf) for each in trip if tubes[each.inwards]]
        known = [each for each in both if each is not None and each.value >= 0.0]
        if walk.works and len(known) == len(both):
            margins += known
        else:
            gaps.append(UnknownMove(there.last, "no move before it names the task that it serves"))
    found = list(judged(NAME, robot, "m", margins, gaps)) or [_nothing(robot, walk)]
    for each in found:
        yield replace(each, caveat=walk.caveat) if each.status is Status.SAFE else each


def _nothing(robot: RobotProgram, walk: _Walk) -> Verdict:
    if walk.caveat:
        return safe(NAME, robot, "it goes where no corridor is asked for")
    return not_checked(NAME, robot, "it leaves home for no task")


def _beyond(way: _Way, tubes: Sequence[tuple[str, Tube]]) -> tuple[tuple[Piece, ...], ...]:
    """Return what of a path comes after it has led through a corridor; all of it where there is none."""
    for number, part in enumerate(way.parts if tubes else ()):
        ends = [piece for follows, piece in (tube.follows(part) for _, tube in tubes) if follows]
        if ends:
            return (part[min(ends) :], *way.parts[number + 1 :])
    return () if tubes else way.parts


def _tube(corridor: Corridor, line: tuple[Point, ...], own: float) -> Tube:
    return Tube(line, corridor.width / 2.0 - own, corridor.low + own, corridor.high - own)


def _margin(robot: RobotProgram, way: _Way, tubes: Iterable[tuple[str, Tube]], least: float) -> Margin | None:
    """Return the spare room of a path in the corridor where it has most; None: more than the least so far."""
    found = []
    for name, tube in tubes:
        for part in way.parts:
            if part and 0.0 <= least <= tube.widest and tube.follows(part, least)[0]:
                return None
            found.append((*_spare(tube, part), name))
    if not found:
        return Margin(-inf, way.last, f"{way.words} is not known")
    spare, piece, name = max(found, key=lambda each: each[0])
    kind = f"{robot.moves[piece.move].kind} '{robot.moves[piece.move].id}'"
    if spare >= 0.0:
        (left,) = lengths(spare)
        words = f"{way.words} leads through '{name}' and leaves {left} to its sides and heights, at {kind}"
    else:
        (short,) = lengths(-spare)
        east, north, up = piece.end
        at = f"after {kind} at ({east:.1f}, {north:.1f}, {up:.1f})"
        words = f"{way.words} leads through no corridor: it is outside of '{name}' by {short}, {at}"
    return Margin(spare, piece.move, words, name)


def _spare(tube: Tube, part: Sequence[Piece]) -> tuple[float, Piece]:
    """Return the largest spare with which a path follows a line, and the piece that allows no more."""
    far = max(dist(place, end[:2]) for place in tube.line for each in part for end in (each.begin, each.end))
    off = max(max(tube.low - z, z - tube.high, 0.0) for each in part for z in (each.begin[2], each.end[2]))
    spread = max(each.spread for each in part)
    low, high = min(0.0, tube.widest) - far - off - spread - 2.0 * _length(tube.line), tube.widest
    if tube.follows(part, high)[0]:
        return high, part[-1]
    while high - low > _CLOSE:
        middle = (low + high) / 2.0
        low, high = (middle, high) if tube.follows(part, middle)[0] else (low, middle)
    kept = 0.0 if -TOLERANCE <= low < 0.0 else low
    return kept, part[tube.follows(part, high)[1]]


def _length(line: Sequence[Point]) -> float:
    return sum(dist(one, two) for one, two in pairwise(line))


class _Walk:
    """The paths of a robot between home and tasks.

    Attributes:
        ways: to each first and from each last move that works on a task of a sortie.
        round_trips: whole paths of sorties that leave home without work, each as a path in and as one out.
        works: whether any move works, so that a sortie without such a move is known to be without work.
        gaps: sorties of which it is not known whether they lead to a task.
        caveat: where the robot ends without an exit; empty: nowhere.
    """

    def __init__(
        self, input: CheckInput, robot: RobotProgram, lines_out: Sequence[tuple[Point, ...]]
    ) -> None:
        """Walk the moves of a robot; `lines_out`: of the corridors out, from their inner ends on."""
        self._robot, self._home, self._lines_out = robot, home_of(robot), lines_out
        motion = motions(input)[robot.id]
        self._paths: dict[int, list[MovePath]] = {}
        for path in motion.paths:
            self._paths.setdefault(path.move, []).append(path)
        self._unknown = {gap.move: gap for gap in motion.gaps}
        self._spreads = _spreads(input, robot, motion)
        self.ways, self.gaps, self.caveat = list[_Way](), list[UnknownMove](), ""
        self.round_trips = list[tuple[_Way, _Way]]()
        reachable = sorted(reachable_moves(robot))
        works = [move for move in reachable if self._works(move)]
        self.works = bool(works)
        self._worked = {move: [path.points[-1] for path in self._paths.get(move, ())] for move in works}
        for move in reachable:
            if move == robot.start or robot.moves[move].is_a(RECHARGE):
                self._from_home(move)
            elif self._works(move):
                self._from_work(move)

    def _from_home(self, start: int) -> None:
        for chain, end in self._chains(start):
            if end is None:
                self.gaps.append(UnknownMove(chain[-1], "its path goes round, or divides too often"))
                continue
            begins = [path.points[0] for path in self._paths.get(start, ())]
            parts, gaps = self._pieces(chain, begins or [self._home])
            words = f"the path to {self._named(end)}"
            if self._works(end):
                self.ways.append(_Way(words, True, parts, gaps, end))
            elif self.works and parts and not gaps and self._is_in_field(last := parts[-1][-1].end):
                self.ways.append(_Way(words, True, parts, gaps, end))
                self._ends_at(last)
            elif any(self._is_away(each.end) for part in parts for each in part):
                there, back = (_Way(words, inwards, parts, gaps, end) for inwards in (True, False))
                self.round_trips.append((there, back))

    def _from_work(self, work: int) -> None:
        ends = [path.points[-1] for path in self._paths.get(work, ())]
        for chain, end in self._chains(work):
            if end is None:
                self.gaps.append(UnknownMove(chain[-1], "its path goes round, or divides too often"))
                continue
            if self._works(end):
                continue
            parts, gaps = self._pieces([*chain[1:], end], ends)
            last = next((part[-1].end for part in reversed(parts) if part), None)
            where = last if parts and last is not None else (ends[-1] if ends else None)
            if where is not None and not gaps and self._is_away(where) and self._stays(work, where):
                self._ends_at(where)
                continue
            self.ways.append(_Way(f"the path home from {self._named(work)}", False, parts, gaps, end))

    def _works(self, move: int) -> bool:
        """Return whether a move is work: on a task, or of a device away from home."""
        found = self._robot.moves[move]
        if found.works:
            return True
        used = [end for end, each in ((0, found.before), (-1, found.after)) for act in each if act.device]
        paths = self._paths.get(move, ())
        return bool(used) and (
            not paths or any(self._is_away(each.points[i]) for each in paths for i in used)
        )

    def _is_away(self, place: Position) -> bool:
        return dist(place[:2], self._home[:2]) > _HOME

    def _ends_at(self, where: Position) -> None:
        away = dist(where[:2], self._home[:2])
        self.caveat = f"it ends {away:.0f} m from its home, so that no exit is asked for"

    def _stays(self, work: int, where: Position) -> bool:
        """Return whether a robot that ends somewhere has not come out of the field after its last task."""
        return self._is_in_field(where) or any(not self._is_inside(each) for each in self._worked[work][-1:])

    def _is_in_field(self, where: Position) -> bool:
        worked = any(dist(at[:2], where[:2]) <= _HOME for ends in self._worked.values() for at in ends)
        return self._is_away(where) and (worked or self._is_inside(where))

    def _is_inside(self, place: Position) -> bool:
        """Return whether the nearest end of all corridors out is an inner one."""
        ends = [(dist(place[:2], line[end]), end) for line in self._lines_out for end in (0, -1)]
        return not ends or min(ends)[1] == 0

    def _named(self, move: int) -> str:
        found = self._robot.moves[move]
        return f"task '{found.task}'" if found.task else f"{found.kind} '{found.id}'"

    def _chains(self, start: int) -> Iterator[tuple[list[int], int | None]]:
        """Yield moves from one on, and what they lead to.

        That is a move that works, or the end of the sortie; None where they go round, or divide too often.
        """
        pending, divided = [[start]], 0
        while pending:
            chain = pending.pop()
            transition = self._robot.transitions.get(chain[-1])
            following = tuple(dict.fromkeys(transition.next_moves)) if transition is not None else ()
            divided += max(0, len(following) - 1)
            for after in following:
                move = self._robot.moves[after]
                if self._works(after) or move.is_a(RECHARGE) or after == self._robot.stop:
                    yield chain, after
                elif after in chain or divided > _MOST:
                    yield chain, None
                else:
                    pending.append([*chain, after])

    def _pieces(
        self, chain: Iterable[int], places: list[Position]
    ) -> tuple[tuple[tuple[Piece, ...], ...], tuple[UnknownMove, ...]]:
        """Return the pieces of the paths of moves one after the other, in runs without a gap."""
        runs: list[list[Piece]] = [[]]
        gaps = list[UnknownMove]()
        before = 0.0
        for move in chain:
            known = [path for path in self._paths.get(move, ()) if _begins(path, places)]
            if not places and len(self._paths.get(move, ())) == 1:  # what was before is not known
                known = self._paths[move]
            if move in self._unknown or not known:
                gaps.append(self._unknown.get(move, UnknownMove(move, "its start is unknown")))
                runs.append([])
                places = [path.points[-1] for path in self._paths.get(move, ())]
                continue
            path = max(known, key=lambda each: each.radius)
            after = self._spreads.get(move, 0.0)
            runs[-1] += _split(path, before, after)
            places, before = [path.points[-1]], after
        return tuple(tuple(run) for run in runs if run), tuple(gaps)


def _begins(path: MovePath, places: Iterable[Position]) -> bool:
    return any(dist(path.points[0], place) <= path.radius + _SAME for place in places)


def _spreads(input: CheckInput, robot: RobotProgram, motion: Motion) -> dict[int, float]:
    """Return, by move, how far the robot may be off its end: it cuts the corner, or stops late."""
    found: dict[int, float] = {}
    for _, move, metres in cuts(input, robot, motion):
        found[move] = max(found.get(move, 0.0), metres)
    for end, beyond, move, _ in stops(input, robot, motion):
        found[move] = max(found.get(move, 0.0), dist(end, beyond))
    return found


def _split(path: MovePath, before: float, after: float) -> Iterator[Piece]:
    """Yield the pieces of a path: near a corner the robot may be off it, by as much as it cuts it.

    Args:
        before, after: metres by which the corners at its ends are cut at most. Off its legs a robot is
            within twice as much of the corner.
    """
    legs = [*pairwise(path.points)] or [(path.points[0], path.points[0])]
    for number, (begin, end) in enumerate(legs):
        length = dist(begin, end)
        first = before if number == 0 else 0.0
        last = after if number == len(legs) - 1 else 0.0
        if length <= 0.0:
            yield Piece(begin, end, path.move, path.radius + max(first, last))
            continue
        cut = [0.0, min(0.5, 2.0 * first / length), max(0.5, 1.0 - 2.0 * last / length), 1.0]
        for (a, b), spread in zip(pairwise(cut), (first, 0.0, last), strict=True):
            if b > a:
                off = path.radius + spread
                yield Piece(_along(begin, end, a), _along(begin, end, b), path.move, off)


def _along(begin: Position, end: Position, share: float) -> Position:
    if share in (0.0, 1.0):
        return end if share else begin
    x, y, z = (p + share * (q - p) for p, q in zip(begin, end, strict=True))
    return x, y, z


CORRIDORS = Check(
    name=NAME,
    title="Robots come to their tasks, and go back home, through corridors where the context has some.",
    run=for_each_robot(NAME, _judge),
    hint="lead the path along a corridor from end to end, or name by robotTypes which robots it is for",
)
