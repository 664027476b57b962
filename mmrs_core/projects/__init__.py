"""Projects made of drawings: what each feature becomes, and the files that hold it."""

ALTITUDE = 30.0
"""Metres above the origin of tasks of flying robots that are drawn without a height."""
