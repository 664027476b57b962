"""The moves of a robot and the transitions between them: the well-formedness of behaviours."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, called, finding
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, text
from mmrs_core.languages.element import Element, container_of, descendants, is_kind, label_of, path_of
from mmrs_core.languages.modelset import ModelSet

ENDS = ("from", "to", "falseBranch")


class _Graph:
    """The moves of a robot; transitions that leave the robot are left out.

    Attributes:
        out: by move, the transitions that leave it.
        after: by move, those that may follow it.
    """

    def __init__(self, robot: Element) -> None:
        self.moves = children(robot, "moves")
        self.out: dict[Element, list[Element]] = {move: [] for move in self.moves}
        self.after: dict[Element, dict[Element, None]] = {move: {} for move in self.moves}
        for transition in children(robot, "moveTransitions"):
            before = child(transition, "from")
            if before is None or before not in self.out:
                continue
            self.out[before].append(transition)
            ways = (child(transition, end) for end in ENDS[1:])
            self.after[before].update((path, None) for path in ways if path is not None and path in self.out)

    def of(self, kind: str) -> list[Element]:
        return [move for move in self.moves if is_kind(move, BEHAVIOUR, kind)]

    def beyond(self, starts: list[Element]) -> set[Element]:
        found: set[Element] = set()
        pending = list(starts)
        while pending:
            move = pending.pop()
            if move not in found:
                found.add(move)
                pending.extend(self.after[move])
        return found

    def leading_to(self, goals: list[Element]) -> set[Element]:
        before: dict[Element, list[Element]] = {move: [] for move in self.moves}
        for move, following in self.after.items():
            for each in following:
                before[each].append(move)
        found: set[Element] = set()
        pending = list(goals)
        while pending:
            move = pending.pop()
            if move not in found:
                found.add(move)
                pending.extend(before[move])
        return found


def _exactly_one(kind: str) -> Callable[[Element, ModelSet], Iterator[Finding]]:
    def check(robot: Element, models: ModelSet) -> Iterator[Finding]:
        found = _Graph(robot).of(kind)
        if not found:
            yield finding(robot, f"has no {kind}")
        for extra in found[1:]:
            yield finding(extra, f"{called(robot)} already has the {kind} {path_of(found[0])}")

    return check


def _into_start(transition: Element, models: ModelSet) -> Iterator[Finding]:
    for end in ENDS[1:]:
        move = child(transition, end)
        if move is not None and is_kind(move, BEHAVIOUR, "Start"):
            yield finding(transition, f"its {end} leads into the Start {path_of(move)}")


def _out_of_stop(transition: Element, models: ModelSet) -> Iterator[Finding]:
    move = child(transition, "from")
    if move is not None and is_kind(move, BEHAVIOUR, "Stop"):
        yield finding(transition, f"leads out of the Stop {path_of(move)}")


def _two_ways(robot: Element, models: ModelSet) -> Iterator[Finding]:
    for move, ways in _Graph(robot).out.items():
        if len(ways) > 1:
            others = ", ".join(path_of(path) for path in ways)
            yield finding(move, f"{len(ways)} transitions lead out of it: {others}")


def _dead_end(robot: Element, models: ModelSet) -> Iterator[Finding]:
    for move, ways in _Graph(robot).out.items():
        if not ways and not is_kind(move, BEHAVIOUR, "Stop"):
            yield finding(move, "no transition leads out of it")


def _other_robot(robot: Element, models: ModelSet) -> Iterator[Finding]:
    own = set(children(robot, "moves"))
    for transition in children(robot, "moveTransitions"):
        for end in ENDS:
            move = child(transition, end)
            if move is not None and move not in own:
                yield finding(
                    transition, f"its {end} is {called(move)}, which is not a move of {called(robot)}"
                )


def _same_arms(choice: Element, models: ModelSet) -> Iterator[Finding]:
    move = child(choice, "to")
    if move is not None and move is child(choice, "falseBranch"):
        yield finding(choice, f"leads to {called(move)} either way")


def _blank_condition(choice: Element, models: ModelSet) -> Iterator[Finding]:
    if not text(choice, "conditionIdentifier").strip():
        yield finding(choice, "its conditionIdentifier is blank")


def _unreachable(robot: Element, models: ModelSet) -> Iterator[Finding]:
    graph = _Graph(robot)
    starts = graph.of("Start")
    reached = graph.beyond(starts)
    for move in graph.moves if starts else ():
        if move not in reached:
            yield finding(move, f"no path from the Start of {called(robot)} leads to it")


def _never_stops(robot: Element, models: ModelSet) -> Iterator[Finding]:
    graph = _Graph(robot)
    starts, stops = graph.of("Start"), graph.of("Stop")
    reached, stopping = graph.beyond(starts), graph.leading_to(stops)
    caught = [move for move in graph.moves if move in reached and move not in stopping]
    if starts and stops and caught:
        yield finding(caught[0], f"no path leads from it to the Stop of {called(robot)}")


def _for_ever(robot: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield loops of moves without a Choice and without a wait."""
    graph = _Graph(robot)
    onward = {move: ways[0] for move, ways in graph.out.items() if len(ways) == 1 and _is_free(ways[0])}
    done: set[Element] = set()
    for move in onward:
        path: dict[Element, None] = {}
        current: Element | None = move
        while current is not None and current in onward and current not in done and current not in path:
            path[current] = None
            current = child(onward[current], "to")
        if current is not None and current in path:
            circle = tuple(path)[tuple(path).index(current) :]
            names = " → ".join(label_of(each) or path_of(each) for each in (*circle, current))
            yield finding(current, f"loops forever: {names}")
        done.update(path)


def _is_free(transition: Element) -> bool:
    return not is_kind(transition, BEHAVIOUR, "Choice") and not children(transition, "waitFor")


def _foreign(robot: Element, models: ModelSet) -> Iterator[Finding]:
    own = set(children(robot, "slots"))
    for transition in children(robot, "moveTransitions"):
        for slot in children(transition, "waitFor"):
            if slot not in own:
                owner = container_of(slot)
                whose = f"of {called(owner)}" if owner is not None else "of no robot"
                yield finding(
                    transition, f"waits for the slot {text(slot, 'name')!r} {whose}, which is not its own"
                )


def _nobodys(behaviour: Element, models: ModelSet) -> Iterator[Finding]:
    known = {slot for robot in children(behaviour, "robots") for slot in children(robot, "slots")}
    for notify in _notifies(behaviour):
        for slot in _named(notify):
            if slot not in known:
                yield finding(notify, f"sets the slot {text(slot, 'name')!r}, which no robot here has")


def _useless(behaviour: Element, models: ModelSet) -> Iterator[Finding]:
    awaited = {
        slot
        for robot in children(behaviour, "robots")
        for transition in children(robot, "moveTransitions")
        for slot in children(transition, "waitFor")
    }
    for robot in children(behaviour, "robots"):
        for slot in children(robot, "slots"):
            if slot not in awaited:
                yield finding(slot, f"{called(robot)} never waits for it")


def _notifies(behaviour: Element) -> Iterator[Element]:
    return (each for each in descendants(behaviour) if is_kind(each, BEHAVIOUR, "Notify"))


def _named(notify: Element) -> tuple[Element, ...]:
    single = child(notify, "slot")
    return (*children(notify, "slots"), *([single] if single is not None else []))


CONSTRAINTS = (
    Constraint(
        "BL001",
        "A robot has exactly one Start.",
        (BEHAVIOUR, "Robot"),
        _exactly_one("Start"),
        "every robot begins with one Start",
    ),
    Constraint(
        "BL002",
        "A robot has exactly one Stop.",
        (BEHAVIOUR, "Robot"),
        _exactly_one("Stop"),
        "let every path lead to the same Stop",
    ),
    Constraint(
        "BL003",
        "No transition leads into a Start.",
        (BEHAVIOUR, "MoveTransition"),
        _into_start,
        "lead to the first move after it instead",
    ),
    Constraint(
        "BL004",
        "No transition leads out of a Stop.",
        (BEHAVIOUR, "MoveTransition"),
        _out_of_stop,
        "what is to be done comes before the Stop",
    ),
    Constraint(
        "BL005",
        "One transition leads out of a move.",
        (BEHAVIOUR, "Robot"),
        _two_ways,
        "make one of them a Choice with a falseBranch, or remove it",
    ),
    Constraint(
        "BL006",
        "Every move except Stop has an outgoing transition.",
        (BEHAVIOUR, "Robot"),
        _dead_end,
        "add a transition from this move to the next, or to the Stop",
    ),
    Constraint(
        "BL007",
        "A transition leads between moves of its own robot.",
        (BEHAVIOUR, "Robot"),
        _other_robot,
        "let robots wait for each other with slots",
    ),
    Constraint(
        "BL011",
        "Every move can be reached from the Start.",
        (BEHAVIOUR, "Robot"),
        _unreachable,
        "lead a transition to it, or remove the move",
        Severity.WARNING,
    ),
    Constraint(
        "BL012",
        "The Stop can be reached from wherever the robot gets.",
        (BEHAVIOUR, "Robot"),
        _never_stops,
        "leave the loop with a Choice",
        Severity.WARNING,
    ),
    Constraint(
        "BL013",
        "Every loop contains a Choice.",
        (BEHAVIOUR, "Robot"),
        _for_ever,
        "leave the loop with a Choice",
    ),
    Constraint(
        "BL029",
        "The two branches of a Choice differ.",
        (BEHAVIOUR, "Choice"),
        _same_arms,
        "make it a plain transition, or lead one branch elsewhere",
        Severity.WARNING,
    ),
    Constraint(
        "BL030",
        "A Choice names its condition.",
        (BEHAVIOUR, "Choice"),
        _blank_condition,
        "give the identifier of the condition that decides",
    ),
    Constraint(
        "BL008",
        "A robot waits for its own slots only.",
        (BEHAVIOUR, "Robot"),
        _foreign,
        "give this robot a slot, and let the other one set it with a notify",
    ),
    Constraint(
        "BL031",
        "A notify sets slots of this behaviour's robots.",
        (BEHAVIOUR, "Behaviour"),
        _nobodys,
        "refer to a slot of one of the robots",
    ),
    Constraint(
        "BL033",
        "Slots are waited for.",
        (BEHAVIOUR, "Behaviour"),
        _useless,
        "let a transition wait for it, or remove the slot",
        Severity.WARNING,
    ),
)
