"""Resets of simulated autopilots by their watchdog, which no flight on a real firmware has shown."""

from mmrs_mavlink.sitl import SimulatedVehicle


def reset(vehicle: SimulatedVehicle) -> None:
    """Restart a vehicle whose motors run on."""
    pilot = vehicle.autopilot
    with vehicle.lock:
        home = pilot.home
        pilot.restart()
        pilot.armed, pilot.home = True, home
