"""The names of the metaclasses that this plug-in brings."""

from __future__ import annotations

SURVEY = "urn:mmrs:survey:1.0"
PHOTO_TASK = (SURVEY, "PhotoTask")
PATH_PHOTO_TASK = (SURVEY, "PathPhotoTask")
PHOTO_GRID_TASK = (SURVEY, "PhotoGridTask")
GO_TO_TASK = (SURVEY, "GoToTask")
ROAD_TASK = (SURVEY, "RoadTask")
PERIMETER_TASK = (SURVEY, "PerimeterTask")
ORBIT_TASK = (SURVEY, "OrbitTask")
OBSERVE_TASK = (SURVEY, "ObserveTask")
RELAY_TASK = (SURVEY, "RelayTask")
MEASURE_TASK = (SURVEY, "MeasureTask")
APPROACH_TASK = (SURVEY, "ApproachTask")
LANDMARK = (SURVEY, "Landmark")
