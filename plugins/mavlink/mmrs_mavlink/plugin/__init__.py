"""The plug-in called mavlink: what plugs into the core, where that is installed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from mmrs_core.contributions.commands import Command
from mmrs_core.contributions.hooks import Hook
from mmrs_core.hookspecs import hookimpl

if TYPE_CHECKING:
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.drawings import DrawingReader
    from mmrs_core.contributions.targets import Target
    from mmrs_core.contributions.timing import VehicleTiming
    from mmrs_core.contributions.vehicles import VehicleFactory
    from mmrs_mavlink.profiles import VehicleProfile
    from mmrs_mavlink.wiring import DeviceWiring


@hookimpl
def mmrs_targets() -> Iterable[Target]:
    """Contribute controllers, and plans for ground stations."""
    from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
    from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
    from mmrs_mavlink.plugin.plans.wpl import WPL

    return (MAVLINK_PYTHON, QGC_PLAN, WPL)


@hookimpl
def mmrs_drawing_readers() -> Iterable[DrawingReader]:
    """Contribute readers of missions of ground stations."""
    from mmrs_core.contributions.drawings import DrawingReader
    from mmrs_mavlink.plugin.plans import drawn_lists, drawn_plans

    return (
        DrawingReader("QGroundControl plan", (".plan",), drawn_plans.recognise_plan, drawn_plans.read_plan),
        DrawingReader("waypoints", (".waypoints", ".wpl"), drawn_lists.recognise_list, drawn_lists.read_list),
    )


@hookimpl
def mmrs_constraints() -> Iterable[Constraint]:
    """Contribute what holds of devices on autopilots."""
    from mmrs_mavlink.plugin.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_vehicles() -> Iterable[VehicleFactory]:
    """Contribute vehicles at the ends of MAVLink links."""
    from mmrs_mavlink.plugin.backend import MAVLINK
    from mmrs_mavlink.plugin.manual import ARDUSUB_MANUAL

    return (MAVLINK, ARDUSUB_MANUAL)


@hookimpl
def mmrs_commands() -> Iterable[Command]:
    """Contribute simulated vehicles, and figures of real ones from their flight logs."""
    return (
        Command("sitl", "Start simulated MAVLink vehicles.", "mmrs_mavlink.commands.sitl:app"),
        Command(
            "calibrate",
            "Calculate the figures of a robot type from a flight log.",
            "mmrs_mavlink.commands.calibrate:app",
        ),
    )


@hookimpl
def mmrs_hooks() -> Iterable[Hook]:
    """Specify what other plug-ins may add to vehicles on MAVLink."""
    return (
        Hook(
            "mmrs_device_actions",
            "How actions of devices become MAVLink commands",
            "mmrs_mavlink.wiring:DeviceWiring",
            "property",
        ),
        Hook(
            "mmrs_vehicle_profiles",
            "What one autopilot does with one class of vehicle",
            "mmrs_mavlink.profiles:VehicleProfile",
        ),
    )


@hookimpl
def mmrs_device_actions() -> Iterable[DeviceWiring]:
    """Contribute how cameras, servos, relays and other devices are wired."""
    from mmrs_mavlink.plugin.devices import WIRINGS

    return tuple(WIRINGS.values())


@hookimpl
def mmrs_vehicle_timings() -> Iterable[VehicleTiming]:
    """Contribute how long copters, rovers and underwater vehicles take with ArduPilot and PX4."""
    from mmrs_mavlink.plugin.vehicles import timings

    return timings()


@hookimpl
def mmrs_vehicle_profiles() -> Iterable[VehicleProfile]:
    """Contribute ArduCopter, ArduSub and Rover, and the same with PX4."""
    from mmrs_mavlink.profiles import PROFILES

    return tuple(PROFILES.values())
