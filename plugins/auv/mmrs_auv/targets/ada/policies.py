"""How the decision centre answers what goes wrong, as policies say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite

from mmrs_auv.kinds import AUV_KIND
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Policy, PolicyResponse
from mmrs_mavlink.plugin.safety import policies_of
from mmrs_runtime.policies import AFTER, LAST_RESORT, patience, response_to

RESPONSES: Mapping[str, str] = {
    "HOLD": "Holds_Place", "RETURN": "Backs_Out", "LAND": "Comes_Up", "SURFACE": "Comes_Up",
    "STOP_THRUST": "Stops_Thrust", "CONTINUE": "Goes_On",
}  # fmt: skip
"""Responses that it can give; one that finds its way to an emergency area it cannot."""

LASTING = ("LINK_LOST", "POSITION_LOST", "BATTERY_LOW", "OBSTACLE", "WAIT_TOO_LONG", "PEER_LOST")
"""Events that have to last before they count."""

EVENTS = (*LASTING, "DEVICE_SILENT", "LOG_FAILED")
"""Events that may happen to an underwater vehicle."""

OTHERWISE: PolicyResponse = "SURFACE"
"""What is done in place of a response that cannot be given."""


def declared(robot: RobotProgram, input: TargetInput) -> tuple[Policy, ...]:
    """Return a robot's policies, the first for an event counts; what nobody declared is its kind's."""
    kinds = {AUV_KIND.metaclass: AUV_KIND, **input.robot_kinds}
    return policies_of(robot, replace(input, robot_kinds=kinds))


def obstacles_to(policy: Policy) -> str:
    """Return why a policy cannot be kept; empty where it can."""
    if policy.event not in EVENTS:
        return ""
    if policy.response not in RESPONSES:
        return "no decision centre knows a way to an emergency area: it comes up"
    if policy.event == "POSITION_LOST" and policy.response == "RETURN":
        return "nobody finds back without its position: it comes up"
    if policy.event == "LOG_FAILED" and policy.response == "CONTINUE":
        return "nobody could replay what it does without its log: it holds"
    return ""


def view(policies: Sequence[Policy]) -> Mapping[str, object]:
    """Return what templates see of policies, the first for an event counts: how long, and what then."""
    kept = [_possible(each) for each in policies]
    waits = ((event, _seconds(event, kept)) for event in LASTING)
    return {
        "bears": [(event, seconds) for event, seconds in waits if isfinite(seconds)],
        "answer": [
            *((event, RESPONSES[response_to(event, kept)]) for event in EVENTS),
            ("CONDITION_FAILED", RESPONSES[LAST_RESORT]),
        ],
    }


def _possible(policy: Policy) -> Policy:
    """Return a policy that can be kept."""
    bears = policy.response == "CONTINUE"
    return policy if bears or not obstacles_to(policy) else replace(policy, response=OTHERWISE)


def _seconds(event: str, policies: Sequence[Policy]) -> float:
    """Return for how many seconds an event is borne; inf: for ever.

    That a link may be lost is about radio: on a vehicle's own bus, silence counts at last.
    """
    if response_to(event, policies) == "CONTINUE":
        return AFTER[event] if event == "LINK_LOST" else float("inf")
    found = patience(event, policies)
    return float("inf") if found is None else found
