"""Probes of moves, of where things point meanwhile, of what follows them, and of actions and wirings."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.behaviour.program import BEHAVIOUR, Heading, Move, MoveTarget, Transition
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.samples import ACTION, DEVICE
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.capabilities.probes import (
    ALPHA,
    BETA,
    MOVE,
    Probe,
    Sample,
    Samples,
    action,
    changed,
    move,
    with_move,
)
from mmrs_core.languages.metaclass import Enumeration, Metaclass
from mmrs_core.scene import Metaclasses, Value

AHEAD = Heading(MoveTarget((0.0, 90.0, 0.0)), DEVICE)
ASIDE = replace(AHEAD, angle_degrees=90.0)
MOUNTED_ASIDE = {"mount.yaw": "90"}
UNHEARD_OF: Metaclasses = (("urn:mmrs:nowhere:1.0", "Somersault"), MOVE)


def of_moves(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each metaclass and feature of moves."""
    sample, base = samples.base, samples.base.plain
    there = MoveTarget(sample.there)
    yield Probe("move", "Start, Stop", sample.given(sample.robot(ALPHA, ())), base)
    go_to = replace(move("m", "GoTo"), target=there, speed=2.0)
    yield Probe("move", "GoTo", *sample.inserted(go_to))
    yield Probe("move", "GoTo.target", with_move(base, "a", target=there), base)
    yield Probe("move", "GoTo.distance", with_move(base, "a", distance=4.0), base)
    yield Probe("move", "GoTo.speed", with_move(base, "a", speed=3.0), base)
    yield Probe("move", "GoTo.speed absent", with_move(base, "a", speed=None), base)
    yield Probe("move", "HoldPosition", *sample.inserted(move("m", "HoldPosition", duration=3.0)))
    longer, _ = sample.inserted(move("m", "HoldPosition", duration=9.0))
    shorter = with_move(longer, "m", attributes={"duration": 3.0})
    yield Probe("move", "HoldPosition.duration", shorter, longer)
    yield Probe("move", "Recharge", *_between_sorties(sample))
    facing = replace(move("m", "HeadTo"), heading=replace(AHEAD, device=""))
    yield Probe("move", "HeadTo.heading", *sample.inserted(facing))
    for name, changes in {
        "Move.name": {"id": "other"},
        "Move.task": {"task": "t"},
        "Move.rule": {"rule": "r"},
    }.items():
        yield Probe("move", name, with_move(base, "a", **changes), base)
    yield Probe("move", "a move of a plug-in", *sample.inserted(Move("m", UNHEARD_OF)))


def of_plugins(samples: Samples, contributions: Contributions) -> Iterator[Probe]:
    """Yield a probe for each metaclass of moves that plug-ins have added, and for each attribute of it."""
    for uri, name in sorted(each for each in contributions.move_kinds if each[0] != BEHAVIOUR):
        metaclass, group = contributions.languages.metaclass(uri, name), f"move of {uri}"
        values = _values_of(metaclass)
        usual: dict[str, Value] = {}
        for each in metaclass.ancestry:
            if each[0] != BEHAVIOUR:
                own = _values_of(contributions.languages.metaclass(*each))
                usual |= {feature: some[0] for feature, some in own.items() if feature not in usual}
        made = Move("m", metaclass.ancestry, usual)
        if metaclass.is_kind(BEHAVIOUR, "GoTo"):
            made = replace(made, target=MoveTarget(samples.base.above), speed=2.0)
        kind, sample = contributions.move_kinds[uri, name], samples.base
        before = sample.recover if kind.needs == {"grounded"} else ()
        after = sample.launch if kind.leaves == "grounded" else ()
        given, without = sample.inserted(*before, made, *after)
        yield Probe(group, name, given, without)
        for feature, (_, *others) in values.items():
            for other in others:
                words = f"{name}.{feature} {other}" if isinstance(other, str) else f"{name}.{feature}"
                varied = with_move(given, "m", attributes={**usual, feature: other})
                yield Probe(group, words, varied, given)


def _values_of(metaclass: Metaclass) -> dict[str, list[Value]]:
    """Return two or more values for each number, truth and enumeration that a metaclass itself declares."""
    found: dict[str, list[Value]] = {}
    for feature in metaclass.by_name.values():
        if feature.owner is not metaclass or feature.is_reference or feature.many:
            continue
        if isinstance(feature.type, Enumeration):
            default = feature.default if isinstance(feature.default, str) else feature.type.names[0]
            found[feature.name] = [default, *(each for each in feature.type.names if each != default)]
        elif feature.type.name == "EBoolean":
            found[feature.name] = [False, True]
        elif feature.type.name in ("EDouble", "EFloat", "EInt", "ELong"):
            found[feature.name] = [20.0, 12.0]
    return found


def of_headings(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each orientation of a robot or device."""
    turning = {each.description: each.properties for each in samples.target.wirings if each.turns}
    for sample in samples.carried:
        base = sample.plain
        turned = with_move(base, "a", heading=AHEAD)
        name = f"({sample.name})"
        yield Probe("heading", f"GoTo.heading {name}", turned, base)
        yield Probe("heading", f"Heading.angle {name}", with_move(base, "a", heading=ASIDE), turned)
        for words, properties in {
            "of a device that looks aside (mount.yaw)": MOUNTED_ASIDE,
            **{f"of {each}": properties for each, properties in turning.items()},
        }.items():
            wired = {sample.type.name: sample.wired(properties)}
            fitted = replace(turned, types=wired)
            without = replace(base, types=wired)
            yield Probe("heading", f"GoTo.heading {name}, {words}", fitted, without)
            aside = with_move(fitted, "a", heading=ASIDE)
            yield Probe("heading", f"Heading.angle {name}, {words}", aside, fitted)
            facing = replace(move("m", "HeadTo"), heading=AHEAD)
            ahead = sample.given(
                sample.robot(ALPHA, sample.journey_with(facing)), type=wired[sample.type.name]
            )
            yield Probe("heading", f"HeadTo.heading {name}, {words}", ahead, without)
        mounted = {sample.type.name: sample.wired(MOUNTED_ASIDE)}
        yield Probe(
            "heading",
            f"Heading.deviceId: a device that looks aside (mount.yaw) {name}",
            replace(turned, types=mounted),
            turned,
        )
    base, front = samples.base.plain, replace(AHEAD, device="")
    yield Probe("heading", "Heading.deviceId absent: the front", with_move(base, "a", heading=front), base)
    found = Heading(MoveTarget((0.0, 90.0, 0.0), "a buoy", 2.0))
    yield Probe("heading", "Heading.target: an object", with_move(base, "a", heading=found), base)


def of_transitions(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each feature of MoveTransition and Choice."""
    sample = samples.base
    moves, on, beyond = sample.on_the_way(), sample.after("a"), sample.after("b")
    plainly = Transition(0, on)
    choice = replace(plainly, condition="calm", otherwise=beyond)
    listening = changed(sample.given(sample.robot(ALPHA, moves)), lambda r: replace(r, slots=("go",)))
    for element, transition in {
        "MoveTransition.waitFor": replace(plainly, waits=("go",)),
        "MoveTransition.fluid": replace(plainly, fluid=True),
        "MoveTransition.to: a move that comes round again": Transition(0, 1),
        "Choice.conditionIdentifier, Choice.falseBranch": choice,
        "Choice by a standard condition": replace(choice, condition="battery-below:0.3"),
    }.items():
        other = changed(
            sample.given(sample.robot(ALPHA, moves, a=transition)), lambda r: replace(r, slots=("go",))
        )
        yield Probe("transition", element, other, listening)


def _between_sorties(sample: Sample) -> tuple[TargetInput, TargetInput]:
    charge = move("m", "Recharge", (BEHAVIOUR, "HoldPosition"), duration=60.0)
    again = tuple(replace(each, id=f"{each.id}2") for each in (*sample.launch, *sample.recover))
    both = ((*sample.journey, charge, *again), (*sample.journey, *again))
    given, without = (sample.given(sample.robot(ALPHA, moves)) for moves in both)
    return given, without


USE = action("DeviceAction", name=ACTION, device=DEVICE)


def of_devices(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each wiring of a device that the target knows, for none, and for their parameters."""
    sample, wirings = samples.base, samples.target.wirings
    tried = {each.description: each.properties for each in wirings} | {"no wiring": {}}
    for words, properties in tried.items():
        base = replace(sample.plain, types={sample.type.name: sample.wired(properties)})
        yield Probe("device action", f"DeviceAction: {words}", with_move(base, "a", after=(USE,)), base)
    usual = next(iter(tried.values()))
    device = replace(sample.plain, types={sample.type.name: sample.wired(usual)})
    base = with_move(device, "a", after=(USE,))
    given = with_move(device, "a", after=(replace(USE, parameters=(("pwm", "1100"),)),))
    yield Probe("device action", "DeviceAction.parameters", given, base)
    yield Probe("action", "Move.preActions", with_move(device, "a", before=(USE,)), device)
    yield Probe("action", "Move.postActions", with_move(device, "a", after=(USE,)), device)


def of_actions(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each metaclass of actions that no device carries out."""
    sample = samples.base
    robots = [sample.robot(id, sample.journey) for id in (ALPHA, BETA)]
    base = sample.given(robots[0], replace(robots[1], slots=("go", "on")))
    notify = ("Notify", "CommunicationAction")
    go, on = (BETA, "go"), (BETA, "on")
    feedback = action("Feedback", "CommunicationAction", name="arrived")
    for element, does in {
        "Feedback": feedback,
        "UnicastNotify": replace(action("UnicastNotify", *notify), sets=(go,)),
        "MulticastNotify": replace(action("MulticastNotify", *notify), sets=(go, on)),
        "BroadcastNotify": replace(action("BroadcastNotify", *notify), sets=(go,)),
        "Notify.active false": replace(action("UnicastNotify", *notify), sets=(go,), active=False),
        "an action of a plug-in": replace(
            action("Sing"), metaclasses=(("urn:mmrs:nowhere:1.0", "Sing"), (BEHAVIOUR, "Action"))
        ),
    }.items():
        yield Probe("action", element, with_move(base, "a", after=(does,)), base)
    payload = replace(feedback, parameters=(("at", "a"),))
    given, without = (with_move(base, "a", after=(each,)) for each in (payload, feedback))
    yield Probe("action", "Feedback.payload", given, without)
