"""The laws that every plug-in must keep."""

from __future__ import annotations

from mmrs_core.testing.conformance import TargetConformance, VehicleConformance
from mmrs_core.testing.programs import LAND, go_to, program, robot_program, take_off, target_input
from mmrs_mavlink import plugin

FLIGHT = [take_off("up", 20.0), go_to("out", (0.0, 30.0, 20.0)), LAND]
ONE_DRONE = target_input(program(robot_program("alpha", FLIGHT)))


class TestTargets(TargetConformance):
    plugin = plugin
    inputs = {"qgc-plan": ONE_DRONE, "wpl": ONE_DRONE}


class TestVehicles(VehicleConformance):
    plugin = plugin
