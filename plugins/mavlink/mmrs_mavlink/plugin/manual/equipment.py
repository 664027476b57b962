"""What devices of an ArduSub do, by the commands that they are wired to."""

from __future__ import annotations

from mmrs_core.behaviour.program import Action
from mmrs_core.generation.plan_moves import seconds_of
from mmrs_mavlink.plugin.context import VehicleContext
from mmrs_mavlink.plugin.manual.autopilot import StickAutopilot
from mmrs_mavlink.wiring import Wired
from mmrs_runtime import faults


def carry_out(action: Action, context: VehicleContext, autopilot: StickAutopilot) -> float:
    """Carry out a device action; return the seconds that it takes from then on.

    Raises:
        faults.FaultError: it is not wired for that, does not do it, or does not answer.
    """
    wiring = context.wiring(action)
    if not isinstance(wiring, Wired):
        raise faults.RefusedError(f"'{action.device}' is not wired for '{action.name}'")
    for number, params in ((wiring.command, wiring.params), *wiring.more):
        autopilot.do(number, *params)
    return seconds_of(action, context.type) if wiring.seconds is None else wiring.seconds
