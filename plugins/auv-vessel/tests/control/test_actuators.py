from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pytest
from sample_vessels import heavy_sheet, pool_sheet

from auv_vessel.control import failsafe
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.allocation import Allocation
from auv_vessel.control.drives import Status
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import EMERGENCIES
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame

TICK = 0.05


class Bench:
    """An actuator controller alone, told all that it needs to push."""

    def __init__(self, sheet: Sheet | None = None) -> None:
        self.sheet = sheet or pool_sheet()
        self.actuators = Actuators(self.sheet, Codec(self.sheet))
        self.codec = Codec(self.sheet)
        self._listener = Codec(self.sheet)
        self.now = 0.0
        self.last: dict[str, Mapping[str, object]] = {}
        self.said: list[tuple[str, Mapping[str, object]]] = []

    def say(self, name: str, **values: object) -> Frame:
        frame = self.codec.encode(name, **values)
        self.actuators.hear(frame, self.now)
        return frame

    def wrench(
        self, surge: float = 0.0, *, heave: float = 0.0, yaw: float = 0.0, enable: bool = True
    ) -> None:
        self.say("WrenchForce", Surge=surge, Sway=0.0, Heave=heave, Enable=enable)
        self.say("WrenchMoment", Roll=0.0, Pitch=0.0, Yaw=yaw)

    def trusted(self) -> None:
        self.say("Depth", Depth=1.0, Uncertainty=0.1, Trusted=True)

    def drives(self, *numbers: int) -> None:
        """Have those drives say that they push; all, if none is said."""
        for number in numbers or range(len(self.sheet.thrusters)):
            self.say(f"Thruster{number}Status", Thrust=7.0, Power=0.0, Drive="RUNS")

    def tick(self) -> None:
        self.now += TICK
        self.said = []
        for frame in self.actuators.tick(self.now):
            found = self._listener.decode(frame)
            assert found is not None
            self.said.append((found.name, found.values))
            self.last[found.name] = found.values

    def push(self, seconds: float, surge: float = 0.0, **more: float) -> None:
        for _ in range(round(seconds / TICK)):
            self.trusted()
            self.wrench(surge, **more)
            self.tick()

    def commanded(self) -> list[tuple[float, bool]]:
        return [
            (float(values["Thrust"]), bool(values["Enable"]))
            for name, values in self.said
            if name.endswith("Command")
        ]

    def told(self, name: str) -> list[Mapping[str, object]]:
        return [values for each, values in self.said if each == name]


def test_a_wrench_becomes_thrust() -> None:
    bench = Bench()
    bench.push(1.0, 20.0, yaw=1.0)
    thrusts = [thrust for thrust, _ in bench.commanded()]
    given = Allocation(bench.sheet).matrix @ np.array(thrusts)
    assert given == pytest.approx((20.0, 0.0, 0.0, 0.0, 0.0, 1.0), abs=0.02)
    assert all(enable for _, enable in bench.commanded())


def test_a_wrench_whose_halves_do_not_belong_together_is_not_obeyed() -> None:
    bench = Bench()
    bench.push(0.1)
    for _ in range(20):
        bench.trusted()
        bench.codec.encode("WrenchForce", Surge=0.0, Sway=0.0, Heave=0.0, Enable=True)
        bench.wrench(20.0)
        bench.tick()
    assert bench.commanded() == [(0.0, False)] * 6


def test_a_wrench_that_is_repeated_for_ever_is_not_obeyed() -> None:
    bench = Bench()
    bench.push(0.5, 20.0)
    force = bench.codec.encode("WrenchForce", Surge=20.0, Sway=0.0, Heave=0.0, Enable=True)
    moment = bench.codec.encode("WrenchMoment", Roll=0.0, Pitch=0.0, Yaw=0.0)
    for _ in range(10):
        bench.trusted()
        bench.actuators.hear(force, bench.now)
        bench.actuators.hear(moment, bench.now)
        bench.tick()
    assert bench.commanded() == [(0.0, False)] * 6


def test_a_wrench_that_is_not_enabled_means_no_thrust_and_no_emergency() -> None:
    bench = Bench()
    bench.push(0.5, 20.0)
    for _ in range(100):
        bench.trusted()
        bench.wrench(20.0, enable=False)
        bench.tick()
    assert bench.commanded() == [(0.0, False)] * 6
    assert bench.actuators.emergency is None


@pytest.mark.parametrize("name", EMERGENCIES)
def test_an_emergency_of_any_node_is_for_good(name: str) -> None:
    bench = Bench()
    bench.push(0.5, 20.0)
    bench.say(name, Reason="ORDERED", Release=False)
    bench.push(3.0, 20.0)
    assert bench.commanded() == [(0.0, False)] * 6
    assert bench.actuators.emergency == "ORDERED"


def test_an_emergency_is_repeated_for_ever() -> None:
    bench = Bench()
    bench.say("Health", Leak=True, Charge=0.5, Power=10.0, SonarRange=5.0)
    bench.say("Health", Leak=True, Charge=0.5, Power=10.0, SonarRange=5.0)
    times = []
    for _ in range(400):
        bench.tick()
        times += [
            bench.now
            for values in bench.told("ActuatorsEmergency")
            if values == {"Reason": "LEAK", "Release": True}
        ]
    assert times[0] == pytest.approx(TICK)
    assert max(later - earlier for earlier, later in pairwise(times)) < 0.5 + 2.0 * TICK
    assert len([each for each in times if each < 1.0]) >= 9


def test_one_message_of_a_leak_is_no_leak() -> None:
    bench = Bench()
    for leak in (True, False) * 10:
        bench.say("Health", Leak=leak, Charge=0.5, Power=10.0, SonarRange=5.0)
        bench.tick()
    assert bench.actuators.emergency is None


def test_reach_tells_which_degrees_are_left() -> None:
    bench = Bench(heavy_sheet())
    bench.push(0.1)
    for number in (0, 1, 2):
        bench.say(f"Thruster{number}Status", Thrust=0.0, Power=0.0, Drive="FAULT")
    bench.push(0.2)
    reach = bench.last["Reach"]
    assert reach["Thrusters"] == 5
    assert [reach[degree] for degree in ("Surge", "Sway", "Heave", "Yaw")] == [False, False, True, False]


def test_a_wrench_beyond_what_thrusters_give_is_told_so() -> None:
    bench = Bench()
    bench.push(1.0, 30.0)
    assert not bench.actuators._limited
    bench.push(1.0, 300.0)
    assert bench.actuators._limited


def test_a_silent_drive_counts_as_dead_until_it_is_heard_again() -> None:
    bench = Bench()
    bench.push(0.5, 20.0)
    bench.drives()
    bench.push(0.3, 20.0)
    bench.drives(0, 1, 2, 4, 5)
    bench.push(0.4, 20.0)
    assert bench.commanded()[3][0] == 0.0
    bench.drives()
    bench.push(0.3, 20.0)
    assert bench.commanded()[3][0] > 1.0


def test_a_drive_that_was_never_heard_counts_as_dead_where_others_are_heard() -> None:
    bench = Bench()
    for _ in range(10):
        bench.drives(0, 2, 3, 4, 5)
        bench.push(0.1, 20.0)
    assert bench.commanded()[1][0] == 0.0
    assert bench.last["Reach"]["Thrusters"] == 5.0
    bench.drives()
    bench.push(0.3, 20.0)
    assert bench.commanded()[1][0] > 1.0


def test_power_stays_within_its_limit_and_depth_goes_before_speed() -> None:
    bench = Bench(pool_sheet(**{"power.limit": 150.0}))
    bench.push(2.0, 60.0, heave=15.0)
    power = bench.actuators._limits.power(bench.actuators.thrusts)
    assert 100.0 < power <= 150.0
    given = Allocation(bench.sheet).matrix @ bench.actuators.thrusts
    assert given[2] == pytest.approx(15.0, rel=0.1)
    assert given[0] < 45.0


def test_other_drives_are_told_by_their_own_codec() -> None:
    class Loud:
        def commands(self, thrusts: list[float], enable: bool) -> list[Frame]:
            return [Frame(0x1000, bytes((round(sum(thrusts)) & 0xFF, enable)), True)]

        def hear(self, frame: Frame) -> Status | None:
            return Status(2, None, True) if frame.extended else None

    sheet = pool_sheet()
    actuators = Actuators(sheet, Codec(sheet), Loud())
    actuators.hear(Frame(0x1001, b"", True), 0.0)
    said = actuators.tick(0.0)
    assert said[0] == Frame(0x1000, b"\0\0", True)
    assert not actuators._watch.working[2]


def test_garbage_is_no_wrench() -> None:
    bench = Bench()
    bench.push(0.5, 20.0)
    for _ in range(20):
        bench.trusted()
        frame = bench.codec.encode("WrenchForce", Surge=30.0, Sway=0.0, Heave=0.0, Enable=True)
        bench.actuators.hear(Frame(frame.id, frame.data[:-1] + bytes((frame.data[-1] ^ 1,))), bench.now)
        bench.say("WrenchMoment", Roll=0.0, Pitch=0.0, Yaw=0.0)
        bench.tick()
    assert bench.commanded() == [(0.0, False)] * 6
    assert failsafe.COMMANDS_SILENT < 1.0
