"""What decision centres go by, whatever the mission: the runtime's tables and the vehicle's figures."""

from __future__ import annotations

from collections.abc import Mapping

from auv_vessel.api import FARTHEST_SEEN, FIRST_SIGN, OFTEN, POSITION_LOST, REQUESTS, SELDOM
from auv_vessel.control.failsafe import HEALTH_SILENT
from auv_vessel.decision.duties import AFLOAT, CHARGING, CHARGING_SPARE, FULL, STALE
from auv_vessel.decision.duty_control import SILENT, UNHEARD
from auv_vessel.eyes import (
    CONFIDENCE,
    DEEPEST,
    FARTHEST,
    KEPT,
    LASTING,
    LATEST,
    LEAST,
    LONGEST,
    LONGEST_NAME,
    NAMES,
    REPEATED,
    SPREAD,
)
from auv_vessel.goals import FAREWELL, GOAL_PERIOD, GOALS
from auv_vessel.wire.catalogue import BEAT_PERIOD
from auv_vessel.wire.socketcand import LONGEST as LONGEST_WORD
from mmrs_auv.targets.ada import policies
from mmrs_runtime.bus.meeting import PATIENCE
from mmrs_runtime.bus.messages import MOST_FINDS
from mmrs_runtime.controllers.return_paths import ALIGNED, NEAR
from mmrs_runtime.engine.life import PACE

WATCHDOG = 2.0
"""Seconds for which what carries out the mission, or repeats its goals, may stand still."""

SECONDS: Mapping[str, float] = {
    "BUS_SILENT": SILENT,
    "STATE_SILENT": STALE,
    "HEALTH_SILENT": HEALTH_SILENT + BEAT_PERIOD,  # after the actuator controller, which does so by itself
    "UNHEARD": UNHEARD,
    "FIRST_SIGN": FIRST_SIGN,
    "GATHERING": PATIENCE,
    "CHARGING_SPARE": CHARGING_SPARE,
    "WATCHDOG": WATCHDOG,
    "PACE": PACE,
    "GOAL_PERIOD": GOAL_PERIOD,
    "BEAT_PERIOD": BEAT_PERIOD,
    "FAREWELL": FAREWELL,
    "DETECTION_LASTS": LASTING,
    "DETECTION_REPEATED": REPEATED,
    "DETECTION_LATEST": LATEST,
}

METRES: Mapping[str, float] = {
    "POSITION_LOST": POSITION_LOST,
    "FARTHEST_SEEN": FARTHEST_SEEN,
    "AFLOAT": AFLOAT,
    "NEAR": NEAR,
    "ALIGNED": ALIGNED,
    "DETECTION_SPREAD": SPREAD,
    "DETECTION_FARTHEST": FARTHEST,
    "DETECTION_DEEPEST": DEEPEST,
}

PARTS: Mapping[str, float] = {"FULL": FULL, "CONFIDENCE": CONFIDENCE}

COUNTS: Mapping[str, float] = {
    "CHARGING": CHARGING,
    "GOALS": GOALS,
    "REQUESTS": REQUESTS,
    "SELDOM": SELDOM,
    "OFTEN": OFTEN,
    "FINDS": MOST_FINDS,
    "DETECTIONS_AGREE": LEAST,
    "DETECTIONS_KEPT": KEPT,
    "OBJECTS": NAMES,
    "DATAGRAM": LONGEST,
    "NAME": LONGEST_NAME,
    "WORD": LONGEST_WORD,
}


def view() -> Mapping[str, object]:
    """Return what the template of the tables sees."""
    return {
        "lasting": policies.LASTING,
        "events": policies.EVENTS,
        "responses": tuple(dict.fromkeys(policies.RESPONSES.values())),
        "undeclared": [(event, policies.undeclared(event)) for event in policies.EVENTS],
        "unbearable": [(event, policies.unbearable(event)) for event in policies.EVENTS],
        "overtakes": [(event, event in policies.OVERTAKING) for event in policies.LASTING],
        "limits": {
            "Seconds": SECONDS,
            "Metres": METRES,
            "Parts of the battery, and of certainty": PARTS,
            "Times as many, or as long": COUNTS,
        },
    }
