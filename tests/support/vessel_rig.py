"""A whole vehicle on one rehearsed bus, and what was said on it."""

from collections.abc import Callable
from dataclasses import replace

from auv_vessel.api import Craft, State
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.hosting import Rehearsal
from auv_vessel.movement.movement import Movement
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import COMMAND_BASE, EMERGENCIES, STATUS_BASE
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame

_GIVEN_UP = frozenset(EMERGENCIES.values())


class Rig:
    """Vehicle, controllers, movement and a decision centre that a test commands.

    Args:
        other: what the body really is, where that is not what its controllers are told.

    Attributes:
        commands, statuses: the last thrust commanded to, and given by, each thruster, newtons.
        pushed: time when a command, and a status, last said other than zero.
        emergencies: time and reason of each emergency message.
    """

    def __init__(
        self,
        sheet: Sheet,
        surroundings: Surroundings | None = None,
        seed: int = 1,
        *,
        other: Sheet | None = None,
    ) -> None:
        around = surroundings or Surroundings(bottom=20.0)
        body = other or sheet
        self.sheet = sheet
        self.vehicle = Vehicle(body, Codec(body), around, seed)
        self.sensors = Sensors(sheet, Codec(sheet))
        self.actuators = Actuators(sheet, Codec(sheet))
        self.movement = Movement(sheet, Codec(sheet))
        self.craft = Craft(sheet, Codec(sheet))
        self._listener = Codec(sheet)
        self.commands = [0.0] * len(sheet.thrusters)
        self.statuses = [0.0] * len(sheet.thrusters)
        self.pushed = {"command": -1.0, "status": -1.0}
        self.emergencies: list[tuple[float, str]] = []
        nodes = [self.vehicle, self.sensors, self.actuators, self.movement, self.craft]
        self.bus = Rehearsal(nodes, watch=self._watch)

    @property
    def state(self) -> State:
        return self.craft.state()

    @property
    def afloat(self) -> bool:
        """Whether the hull is at the surface in truth."""
        return self.vehicle.truth.depth < self.sheet.height / 2.0 + 0.1

    def run(self, seconds: float) -> None:
        self.bus.run(seconds)

    def until(self, done: Callable[[], bool], most: float, step: float = 0.1) -> float:
        """Let time go by until something is so; return the seconds that it took."""
        begin = self.bus.now
        while not done():
            assert self.bus.now - begin < most, f"not within {most} s: {self.where()}"
            self.bus.run(step)
        return self.bus.now - begin

    def reach(self, most: float = 120.0) -> float:
        """Let time go by until the goal in force is reached; return the seconds that it took."""
        found = self.until(lambda: self.state.progress in ("REACHED", "FAILED"), most)
        assert self.state.progress == "REACHED", self.where()
        return found

    def where(self) -> str:
        truth, state = self.vehicle.truth, self.state
        return (
            f"{self.bus.now:.1f} s: truth {truth.north:.2f} {truth.east:.2f} {truth.depth:.2f} m "
            f"{truth.heading:.1f} deg, "
            f"told {state.north:.2f} {state.east:.2f} {state.depth:.2f} m {state.heading:.1f} deg, "
            f"{state.progress} {state.distance:.2f} m, emergency {state.emergency}"
        )

    def _watch(self, now: float, frame: Frame) -> None:
        count = len(self.commands)
        for base, numbers, kind in (
            (COMMAND_BASE, self.commands, "command"),
            (STATUS_BASE, self.statuses, "status"),
        ):
            number = frame.id - base
            if 0 <= number < count:
                found = self._listener.decode(frame)
                assert found is not None
                numbers[number] = float(found.values["Thrust"])
                if numbers[number] != 0.0 or (kind == "command" and found.values["Enable"]):
                    self.pushed[kind] = now
        if frame.id in _GIVEN_UP:
            found = self._listener.decode(frame)
            assert found is not None
            self.emergencies.append((now, str(found.values["Reason"])))


def changed(sheet: Sheet, **extra: float) -> Sheet:
    """Return a vehicle whose `extra` says something more."""
    return replace(sheet, extra={**sheet.extra, **extra})
