"""The conformance class for device wirings of plug-ins."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

from mmrs_core.behaviour.program import Action
from mmrs_core.generation.render import render
from mmrs_core.plugins import load_plugins
from mmrs_core.scene import Device, RobotType
from mmrs_core.testing.conformance.declared import Conformance, declared
from mmrs_core.testing.programs import target_input
from mmrs_core.testing.small_programs import go, program, robot, robot_type, use
from mmrs_mavlink.plugin.wiring import wiring_of
from mmrs_mavlink.wiring import DeviceWiring, Unwired, Wiring


class DeviceWiringConformance(Conformance):
    """Every wiring does what its device can do, says why not otherwise, and reaches vehicles.

    Attributes:
        devices: by the wiring's property, a device that has it, with the name of an action that it can do.
    """

    more_sorts = ("device_action",)
    devices: ClassVar[Mapping[str, tuple[Device, str]]] = {}

    def test_there_is_a_device_for_each_wiring_and_no_other(self) -> None:
        """A plug-in whose wirings are tested has some, and none is left out."""
        properties = {each.property for each in declared(self.plugin, "device_actions")}
        assert properties
        assert set(self.devices) == properties

    def test_it_is_named_and_described_for_people(self, device_action: DeviceWiring) -> None:
        """The property begins with a word of the plug-in's, the description is one line."""
        first, dot, rest = device_action.property.partition(".")
        assert first
        assert dot
        assert rest
        assert device_action.description
        assert "\n" not in device_action.description

    def test_it_says_how_an_action_is_done(self, device_action: DeviceWiring) -> None:
        """The commands have at most seven finite parameters, and seconds."""
        device, name = self.devices[device_action.property]
        assert not isinstance(self._wired(device_action, device, use(device.id, name)), Unwired)

    def test_it_says_why_an_action_cannot_be_done(self, device_action: DeviceWiring) -> None:
        """An unknown action raises nothing, nor does an invalid property."""
        device, _ = self.devices[device_action.property]
        nonsense = replace(device, properties=dict.fromkeys(device.properties, "\u2603 nonsense"))
        for each in (device, nonsense):
            found = self._wired(device_action, each, use(each.id, "somersault"))
            assert not isinstance(found, Unwired) or found.reason

    def test_it_reaches_controllers(self, device_action: DeviceWiring) -> None:
        """A generated controller has the device act, by the target ``mavlink-python`` of mmrs-mavlink."""
        target = load_plugins().contributions.targets["mavlink-python"]
        device, name = self.devices[device_action.property]
        acts = go("a", (0.0, 9.0, 0.0), after=(use(device.id, name),))
        given = target_input(program(robot("alpha", [acts])), [_with(device)])
        files = render(
            target, replace(given, extensions={"device_actions": {device_action.property: device_action}})
        )
        assert f'"{device.id}", "{name}", ' in " ".join(files[0].content.decode("utf-8").split())

    @staticmethod
    def _wired(wiring: DeviceWiring, device: Device, action: Action) -> Wiring:
        return wiring_of(action, _with(device), {wiring.property: wiring})


def _with(device: Device) -> RobotType:
    return replace(robot_type(), devices={device.id: device})
