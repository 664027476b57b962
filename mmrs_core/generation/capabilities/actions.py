"""Probes of actions, and of the wirings of devices."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.generation.capabilities.probes import (
    ALPHA,
    BETA,
    FLIGHT,
    Probe,
    action,
    given,
    kind_of,
    plain,
    robot,
    with_move,
)

WIRINGS: Mapping[str, Mapping[str, str]] = {
    "a MAVLink command (mavlink.command.ACTION)": {"mavlink.command.act": "183 9 1900"},
    "a value that is measured (mavlink.value)": {"mavlink.value": "CO2"},
    "a camera (mavlink.camera)": {"mavlink.camera": "0"},
    "a camera that the autopilot triggers": {"mavlink.camera": "0", "mavlink.camera.command": "digicam"},
    "a camera that tells each image": {"mavlink.camera": "0", "mavlink.camera.confirms": "yes"},
    "a servo (mavlink.servo)": {"mavlink.servo": "9", "mavlink.servo.act": "1900"},
    "a relay (mavlink.relay)": {"mavlink.relay": "0", "mavlink.relay.act": "on"},
    "a gripper (mavlink.gripper)": {"mavlink.gripper": "1", "mavlink.gripper.act": "release"},
    "a video (mavlink.video)": {"mavlink.video": "0", "mavlink.video.act": "start"},
    "a trigger by distance (mavlink.trigger)": {"mavlink.trigger": "5", "mavlink.trigger.act": "start"},
    "a winch (mavlink.winch)": {"mavlink.winch": "1", "mavlink.winch.act": "length 5"},
    "a gimbal (mavlink.gimbal.ACTION)": {"mavlink.gimbal": "1", "mavlink.gimbal.act": "-90 0"},
    "no wiring": {},
}


def of_actions() -> Iterator[Probe]:
    """Yield a probe for each metaclass of actions, and each wiring of devices."""
    for words, properties in WIRINGS.items():
        type = replace(
            kind_of("copter"),
            devices={"device": replace(kind_of("copter").devices["device"], properties=properties)},
        )
        base = replace(plain(), types={"Kind": type})
        act = action("DeviceAction", name="act", device="device")
        yield Probe("device action", f"DeviceAction: {words}", with_move(base, "a", after=(act,)), base)
    servo = kind_of("copter", mavlink__servo="9", mavlink__servo__act="1900")
    base = with_move(replace(plain(), types={"Kind": servo}), "a", after=(act,))
    told = replace(act, parameters=(("pwm", "1100"),))
    yield Probe("device action", "DeviceAction.parameters", with_move(base, "a", after=(told,)), base)
    base = given(robot(ALPHA, FLIGHT), replace(robot(BETA, FLIGHT), slots=("go", "on")))
    notify = ("Notify", "CommunicationAction")
    go, on = (BETA, "go"), (BETA, "on")
    for element, does in {
        "Feedback": action("Feedback", "CommunicationAction", name="arrived"),
        "UnicastNotify": replace(action("UnicastNotify", *notify), sets=(go,)),
        "MulticastNotify": replace(action("MulticastNotify", *notify), sets=(go, on)),
        "BroadcastNotify": replace(action("BroadcastNotify", *notify), sets=(go,)),
        "Notify.active false": replace(action("UnicastNotify", *notify), sets=(go,), active=False),
        "an action of a plug-in": replace(
            action("Sing"), metaclasses=(("urn:mmrs:nowhere:1.0", "Sing"), (BEHAVIOUR, "Action"))
        ),
    }.items():
        yield Probe("action", element, with_move(base, "a", after=(does,)), base)
    device = replace(plain(), types={"Kind": servo})
    yield Probe("action", "Move.preActions", with_move(device, "a", before=(act,)), device)
    yield Probe("action", "Move.postActions", with_move(device, "a", after=(act,)), device)
    payload = replace(action("Feedback", "CommunicationAction", name="arrived"), parameters=(("at", "a"),))
    spoken = with_move(base, "a", after=(replace(payload, parameters=()),))
    yield Probe("action", "Feedback.payload", with_move(base, "a", after=(payload,)), spoken)
