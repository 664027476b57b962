"""Multicopters for MMRS: their types, take-off, landing and trajectories."""
