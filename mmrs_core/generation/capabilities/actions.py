"""Probes of actions, and of the wirings of devices."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.contributions.samples import ACTION, DEVICE
from mmrs_core.generation.capabilities.probes import ALPHA, BETA, Probe, Samples, action, with_move

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
