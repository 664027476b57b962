"""Actions of the Behaviour Language as actions of the runtime's programs."""

from __future__ import annotations

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move
from mmrs_core.contributions.wiring import Sampled, Unwired, Wired
from mmrs_core.generation.escaping import Call
from mmrs_mavlink.plugin.context import RobotContext

DEVICE_ACTION = (BEHAVIOUR, "DeviceAction")
FEEDBACK = (BEHAVIOUR, "Feedback")
NOTIFY = (BEHAVIOUR, "Notify")


def action_of(action: Action, context: RobotContext) -> Call:
    """Return the action; ``NoEffect`` where there is no way to do it."""
    if action.is_a(NOTIFY):
        return Call("Notify", (action.sets,), () if action.active else (("active", False),))
    if action.is_a(FEEDBACK):
        return Call("Report", (action.name, action.parameters))
    if not action.is_a(DEVICE_ACTION):
        return Call("NoEffect", (action.name, f"{action.metaclasses[0][1]} is not known to this target"))
    wiring = context.wiring(action)
    if isinstance(wiring, Wired):
        return _operate(action, wiring)
    if isinstance(wiring, Sampled):
        return Call("Measure", (action.device, action.name, wiring.value, wiring.seconds))
    return Call("NoEffect", (action.name, wiring.reason))


def _operate(action: Action, wiring: Wired) -> Call:
    named: list[tuple[str, object]] = []
    if wiring.more:
        more = tuple((number, tuple(map(float, params))) for number, params in wiring.more)
        named.append(("more", more))
    if wiring.confirmed:
        named.append(("confirmed", True))
    params = tuple(map(float, wiring.params))
    return Call("Operate", (action.device, action.name, wiring.command, params, wiring.seconds), tuple(named))


def action_losses(move: Move, context: RobotContext) -> tuple[str, ...]:
    """Return what of a move's actions cannot be expressed."""
    losses = []
    for action in (*move.before, *move.after):
        if action.is_a(DEVICE_ACTION):
            wiring = context.wiring(action)
            if isinstance(wiring, Unwired):
                losses.append(f"{context.label(move)}: action '{action.name}': {wiring.reason}")
        elif not (action.is_a(NOTIFY) or action.is_a(FEEDBACK)):
            kind = action.metaclasses[0][1]
            losses.append(f"{context.label(move)}: action {kind} is not known to this target")
    return tuple(losses)
