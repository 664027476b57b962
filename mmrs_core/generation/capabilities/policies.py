"""Probes of policies: each response to each fault, by each robot kind that a target carries."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.behaviour.program import Transition
from mmrs_core.generation.capabilities.probes import ALPHA, Probe, Samples, changed
from mmrs_core.scene import Area, AreaUse, Policy, Ring
from mmrs_runtime.policies import EVENTS, RESPONSES

MEADOW: Ring = ((-40.0, 0.0), (-20.0, 0.0), (-20.0, 20.0), (-40.0, 20.0))


def of_policies(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each event, response and robot kind, and for those of single waits."""
    for sample in samples.carried:
        base = replace(sample.plain, areas=(Area("meadow", AreaUse.EMERGENCY, MEADOW),))
        for event in EVENTS:
            for response in RESPONSES:
                policy = Policy(event, response)
                other = changed(base, lambda r, policy=policy: replace(r, policies=(policy,)))  # type: ignore[misc]
                yield Probe(f"policy ({sample.name})", f"{event}: {response}", other, base)
    base_sample = samples.base
    waiting = Transition(0, base_sample.after("a"), waits=("go",))
    patient = Policy("WAIT_TOO_LONG", "LAND", 9.0)
    inputs = [
        changed(
            base_sample.given(base_sample.robot(ALPHA, base_sample.journey, a=each)),
            lambda r: replace(r, slots=("go",)),
        )
        for each in (replace(waiting, policies=(patient,)), waiting)
    ]
    yield Probe("transition", "MoveTransition.policies", *inputs)
