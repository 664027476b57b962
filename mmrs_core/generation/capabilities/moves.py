"""Probes of moves, of where things point meanwhile, and of what follows them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from mmrs_core.behaviour.program import BEHAVIOUR, Heading, Move, MoveTarget, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.capabilities.probes import (
    ALPHA,
    FLIGHT,
    KINDS,
    LAND,
    MOVE,
    TAKE_OFF,
    THERE,
    Probe,
    changed,
    given,
    go_to,
    kind_of,
    move,
    plain,
    robot,
    with_move,
)
from mmrs_core.scene import Metaclasses

AHEAD = Heading(MoveTarget((0.0, 90.0, 0.0)), "device")
ASIDE = replace(AHEAD, angle_degrees=90.0)
UNHEARD_OF: Metaclasses = (("urn:mmrs:nowhere:1.0", "Somersault"), MOVE)
ON_THE_WAY = (TAKE_OFF, go_to("a"), go_to("b", THERE), LAND)
"""Places where the moves of plug-ins are tried: between two of the core's."""


def of_moves() -> Iterator[Probe]:
    """Yield a probe for each metaclass and feature of moves."""
    base, two = plain(), given(robot(ALPHA, ON_THE_WAY))
    yield Probe("move", "Start, Stop", given(robot(ALPHA, ())), base)
    yield Probe("move", "multicopter GoTo", given(robot(ALPHA, ON_THE_WAY)), base)
    yield Probe("move", "GoTo", *_inserted(move("m", "GoTo"), target=MoveTarget(THERE), speed=2.0))
    yield Probe("move", "GoTo.target", with_move(base, "a", target=MoveTarget(THERE)), base)
    yield Probe("move", "GoTo.distance", with_move(base, "a", distance=4.0), base)
    yield Probe("move", "GoTo.speed", with_move(base, "a", speed=3.0), base)
    yield Probe("move", "GoTo.speed absent", with_move(base, "a", speed=None), base)
    for trajectory in ("HORIZONTAL_FIRST", "VERTICAL_FIRST"):
        other = with_move(two, "b", attributes={"trajectory": trajectory})
        yield Probe("move", f"GoTo.trajectory {trajectory}", other, two)
    yield Probe("move", "TakeOff", *_inserted(replace(TAKE_OFF, id="m"), LAND))
    higher = {"altitude": 12.0}
    yield Probe("move", "TakeOff.altitude", with_move(base, "up", attributes=higher), base)
    yield Probe("move", "Land", *_inserted(replace(LAND, id="m"), TAKE_OFF))
    yield Probe("move", "HoldPosition", *_inserted(move("m", "HoldPosition", duration=3.0)))
    yield Probe("move", "HoldPosition.duration", *_differing(duration=3.0))
    charge = move("m", "Recharge", BEHAVIOUR, (BEHAVIOUR, "HoldPosition"), duration=60.0)
    yield Probe("move", "Recharge", *_between_sorties(charge))
    yield Probe(
        "move", "HeadTo.heading", *_inserted(replace(move("m", "HeadTo"), heading=replace(AHEAD, device="")))
    )
    for name, changes in {
        "Move.name": {"id": "other"},
        "Move.task": {"task": "t"},
        "Move.rule": {"rule": "r"},
    }.items():
        yield Probe("move", name, with_move(base, "a", **changes), base)
    yield Probe("move", "a move of a plug-in", *_inserted(Move("m", UNHEARD_OF)))


def of_plugins(moves: Iterable[Metaclasses]) -> Iterator[Probe]:
    """Yield a probe for each metaclass of moves, most specific first, that plug-ins have added."""
    for metaclasses in moves:
        uri, name = metaclasses[0]
        yield Probe("move of a plug-in", f"{name} ({uri})", *_inserted(Move("m", metaclasses)))


def of_headings() -> Iterator[Probe]:
    """Yield a probe for each way of pointing something somewhere."""
    for vehicle in KINDS:
        base = plain(vehicle)
        turned = with_move(base, "a", heading=AHEAD)
        yield Probe("heading", f"GoTo.heading of a {vehicle}", turned, base)
        yield Probe("heading", f"Heading.angle of a {vehicle}", with_move(base, "a", heading=ASIDE), turned)
        for words, properties in {
            "of a device that looks aside (mount.yaw)": {"mount__yaw": "90"},
            "of a device on a gimbal (mavlink.gimbal)": {"mavlink__gimbal": "1"},
        }.items():
            fitted = replace(turned, types={"Kind": kind_of(vehicle, **properties)})
            yield Probe("heading", f"GoTo.heading of a {vehicle}, {words}", fitted, turned)
            aside = with_move(fitted, "a", heading=ASIDE)
            yield Probe("heading", f"Heading.angle of a {vehicle}, {words}", aside, fitted)
            facing = replace(move("m", "HeadTo"), heading=AHEAD)
            ahead = _then(base, facing)
            other = replace(ahead, types=fitted.types)
            yield Probe("heading", f"HeadTo.heading of a {vehicle}, {words}", other, ahead)
    front = replace(AHEAD, device="")
    base = plain()
    yield Probe("heading", "Heading.deviceId absent: the front", with_move(base, "a", heading=front), base)
    found = Heading(MoveTarget((0.0, 90.0, 0.0), "a buoy", 2.0))
    yield Probe("heading", "Heading.target: an object", with_move(base, "a", heading=found), base)


def of_transitions() -> Iterator[Probe]:
    """Yield a probe for each feature of MoveTransition and Choice."""
    base = given(robot(ALPHA, ON_THE_WAY))
    plainly = Transition(0, 3)
    for element, transition in {
        "MoveTransition.waitFor": replace(plainly, waits=("go",)),
        "MoveTransition.fluid": replace(plainly, fluid=True),
        "MoveTransition.to: a move that comes round again": Transition(0, 1),
        "Choice.conditionIdentifier, Choice.falseBranch": Transition(0, 3, condition="calm", otherwise=4),
        "Choice by a standard condition": Transition(0, 3, condition="battery-below:0.3", otherwise=4),
    }.items():
        other = changed(given(robot(ALPHA, ON_THE_WAY, a=transition)), lambda r: replace(r, slots=("go",)))
        listening = changed(base, lambda r: replace(r, slots=("go",)))
        yield Probe("transition", element, other, listening)


def _inserted(new: Move, *more: Move, **changes: object) -> tuple[TargetInput, TargetInput]:
    """Return a behaviour with a move in it, and without it; `more` makes up for it."""
    made = replace(new, **changes)  # type: ignore[arg-type]
    longer = (*ON_THE_WAY[:2], made, *more, *ON_THE_WAY[2:])
    return given(robot(ALPHA, longer)), given(robot(ALPHA, ON_THE_WAY))


def _differing(**attributes: float) -> tuple[TargetInput, TargetInput]:
    base, _ = _inserted(move("m", "HoldPosition", duration=9.0))
    return with_move(base, "m", attributes=attributes), base


def _then(base: TargetInput, new: Move) -> TargetInput:
    """Return an input whose first robot makes another move after its first GoTo."""
    (first, *_) = base.program.robots
    index = next(number for number, each in enumerate(first.moves) if each.id == "a")
    moves = (*first.moves[1 : index + 1], new, *first.moves[index + 1 : -1])
    return changed(base, lambda r: robot(ALPHA, moves))


def _between_sorties(new: Move) -> tuple[TargetInput, TargetInput]:
    again = (replace(TAKE_OFF, id="up2"), replace(LAND, id="down2"))
    return given(robot(ALPHA, (*FLIGHT, new, *again))), given(robot(ALPHA, (*FLIGHT, *again)))
