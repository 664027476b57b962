"""Probes of policies: each response to each fault, by each kind of vehicle."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.behaviour.program import Transition
from mmrs_core.generation.capabilities.probes import ALPHA, FLIGHT, KINDS, Probe, changed, given, plain, robot
from mmrs_core.scene import Area, AreaUse, Policy, Ring
from mmrs_runtime.policies import EVENTS, RESPONSES

MEADOW: Ring = ((-40.0, 0.0), (-20.0, 0.0), (-20.0, 20.0), (-40.0, 20.0))


def of_policies() -> Iterator[Probe]:
    """Yield a probe for each event, response and kind of vehicle, and for those of single waits."""
    for vehicle in KINDS:
        base = replace(plain(vehicle), areas=(Area("meadow", AreaUse.EMERGENCY, MEADOW),))
        for event in EVENTS:
            for response in RESPONSES:
                policy = Policy(event, response)
                other = changed(base, lambda r, policy=policy: replace(r, policies=(policy,)))  # type: ignore[misc]
                yield Probe(f"policy of a {vehicle}", f"{event}: {response}", other, base)
    waiting = Transition(0, 3, waits=("go",))
    patient = Policy("WAIT_TOO_LONG", "LAND", 9.0)
    inputs = [
        changed(given(robot(ALPHA, FLIGHT, a=each)), lambda r: replace(r, slots=("go",)))
        for each in (replace(waiting, policies=(patient,)), waiting)
    ]
    yield Probe("transition", "MoveTransition.policies", *inputs)
