"""The names of the metaclasses that this plug-in brings."""

from __future__ import annotations

AUV = "urn:mmrs:auv:1.1"
VEHICLE = (AUV, "AUV")
IN_WATER_SIZE = (AUV, "InWaterSize")
AUV_MOVEMENT = (AUV, "AUVMovement")
THRUSTER = (AUV, "Thruster")
MOUNTING = (AUV, "Mounting")

AUV_TASKS = "urn:mmrs:auv-tasks:1.0"
PIPELINE = (AUV_TASKS, "Pipeline")
RECORDING = (AUV_TASKS, "Recording")
DEPTH_HOLD_SURVEY_TASK = (AUV_TASKS, "DepthHoldSurveyTask")
YO_YO_TASK = (AUV_TASKS, "YoYoTask")
INSPECT_OBJECT_TASK = (AUV_TASKS, "InspectObjectTask")
ALIGN_TASK = (AUV_TASKS, "AlignTask")
FOLLOW_PIPELINE_TASK = (AUV_TASKS, "FollowPipelineTask")
SURFACE_TASK = (AUV_TASKS, "SurfaceTask")

SWATH, APERTURE, RANGE = SONAR_KEYS = ("sonar.swath", "sonar.aperture", "sonar.range")
"""Device properties with the figures of a sonar."""

VEHICLES = ("ground", "rover", "sub")
"""Classes of vehicles that the targets of this plug-in look at; they refuse those that do not dive."""
