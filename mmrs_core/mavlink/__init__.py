"""Behaviours for vehicles that speak MAVLink: as programs of the flight runtime, and as plans."""
