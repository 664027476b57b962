"""How the decision centre answers what goes wrong, as policies and the runtime's tables say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, isfinite

from auv_vessel.decision.duty_control import COMES_UP, NEVER_BORNE
from mmrs_auv.kinds import AUV_KIND
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.safety import policies_of
from mmrs_core.scene import Policy, PolicyResponse
from mmrs_runtime.engine.responses import Responses
from mmrs_runtime.faults import (
    BATTERY_LOW,
    CONDITION_FAILED,
    CRASHED,
    DEVICE_SILENT,
    LINK_LOST,
    LOG_FAILED,
    NO_PROGRESS,
    OBJECT_NOT_FOUND,
    OBSTACLE,
    PEER_LOST,
    POSITION_LOST,
    WAIT_TOO_LONG,
)
from mmrs_runtime.policies import AFTER, LAST_RESORT, OVERTAKES, SURFACE, in_precedence
from mmrs_runtime.vehicle import Fault

RESPONSES: Mapping[str, str] = {
    "HOLD": "Holds_Place", "RETURN": "Backs_Out", "LAND": "Comes_Up", "SURFACE": "Comes_Up",
    "STOP_THRUST": "Stops_Thrust", "CONTINUE": "Goes_On",
}  # fmt: skip
"""Responses that it can give; paths to an emergency area are not among them."""

LASTING = (LINK_LOST, POSITION_LOST, BATTERY_LOW, OBSTACLE, WAIT_TOO_LONG, PEER_LOST)
"""Events that have to last before they count."""

DECLARED = (*LASTING, DEVICE_SILENT, LOG_FAILED)
"""Events that may happen to an underwater vehicle, and that policies are about."""

EVENTS = (*DECLARED, OBJECT_NOT_FOUND, NO_PROGRESS, CONDITION_FAILED, CRASHED)
"""All that may happen to one."""

OVERTAKING = OVERTAKES | NEVER_BORNE
"""Events that are answered although another one is."""

OTHERWISE: PolicyResponse = "SURFACE"
"""What is done in place of a response that cannot be given."""


def declared(robot: RobotProgram, input: TargetInput) -> tuple[Policy, ...]:
    """Return a robot's policies, the first for an event counts; the kind's defaults last."""
    kinds = {AUV_KIND.metaclass: AUV_KIND, **input.robot_kinds}
    return policies_of(robot, replace(input, robot_kinds=kinds))


def obstacles_to(policy: Policy) -> str:
    """Return why a policy cannot be kept; empty where it can."""
    if policy.event not in DECLARED:
        return ""
    if policy.response not in RESPONSES:
        return "no decision centre knows a path to an emergency area: it surfaces"
    if policy.event == POSITION_LOST and policy.response == "RETURN":
        return "without a position no return is possible: it surfaces"
    if policy.event == LOG_FAILED and policy.response == "CONTINUE":
        return "without its log its actions could not be replayed: it holds"
    return ""


def view(policies: Sequence[Policy]) -> Mapping[str, object]:
    """Return what templates see of policies, the first for an event counts: how long, and what then."""
    answers = Responses([_possible(each) for each in policies], live=True)
    waits = ((event, _seconds(event, answers)) for event in LASTING)
    return {
        "bears": [(event, seconds) for event, seconds in waits if isfinite(seconds)],
        "answer": [(event, RESPONSES[answers.response(Fault(event))]) for event in DECLARED],
    }


def undeclared(event: str) -> str:
    """Return what a decision centre does about an event of which no model says anything."""
    usual = Responses(in_precedence(kind=AUV_KIND.policies), live=True)
    return RESPONSES[SURFACE if event in COMES_UP else usual.response(Fault(event))]


def unbearable(event: str) -> str:
    """Return its response to an event that it was to tolerate, and cannot."""
    return RESPONSES[SURFACE if event in NEVER_BORNE | {PEER_LOST} else LAST_RESORT]


def _possible(policy: Policy) -> Policy:
    """Return a policy that can be kept."""
    bears = policy.response == "CONTINUE"
    return policy if bears or not obstacles_to(policy) else replace(policy, response=OTHERWISE)


def _seconds(event: str, answers: Responses) -> float:
    """Return for how many seconds an event is tolerated; inf: without limit.

    Tolerating a lost link is about radio: on a vehicle's own bus, silence counts at last.
    """
    found = answers.patience(Fault(event))
    return AFTER[event] if found == inf and event in NEVER_BORNE else found
