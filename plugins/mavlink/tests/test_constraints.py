"""What holds of devices that are wired to an autopilot."""

from mmrs_core.languages import robot
from mmrs_core.testing.conformance import Case, ConstraintConformance
from mmrs_mavlink import plugin


def two_devices(first: str, second: str) -> list[robot.Robot]:
    devices = [
        robot.Device(id=id, properties=[robot.Property(name="mavlink.relay", value=relay)])
        for id, relay in (("siren", first), ("lamp", second))
    ]
    return [robot.Robot(name="Any", devices=devices)]


class TestConstraints(ConstraintConformance):
    plugin = plugin
    cases = {"RL030": Case(lambda r: two_devices("3", "3"), lambda r: two_devices("3", "4"))}
