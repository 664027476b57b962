"""Thrusters on DroneCAN for MMRS: electronic speed controllers by RawCommand and Status."""
