"""Autonomous underwater vehicles for MMRS: thrusters, buoyancy and depth."""
