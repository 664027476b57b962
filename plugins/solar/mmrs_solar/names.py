"""The names of the metaclasses, features and keys that this plug-in brings."""

from __future__ import annotations

SOLAR = "urn:mmrs:solar:1.0"
PANEL_GROUP = (SOLAR, "PanelGroup")
PANEL_TASK = (SOLAR, "PanelTask")
THERMAL_ROW_TASK = (SOLAR, "ThermalRowTask")
PANEL_LOOK_TASK = (SOLAR, "PanelLookTask")

IRRADIANCE = "minimumIrradiance"
"""Feature of panel tasks, and parameter of the actions that record it: watts per square metre."""
