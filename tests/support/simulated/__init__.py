"""A simulated vehicle without wires: its time passes when a test says so."""

from collections.abc import Callable, Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.commands import execute
from mmrs_mavlink.sitl.items import StoredItem
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.simulation import advance

TICK = 0.05
Place = tuple[float, float, float]


class Bench:
    """A vehicle that stands ready at home.

    Attributes:
        pilot: its autopilot.
    """

    def __init__(self, **settings: object) -> None:
        self.pilot = SimulatedAutopilot(Settings(**{"ready": 0.5, "boot": 0.2, **settings}))
        self.wait(1.0)

    @property
    def last_text(self) -> str:
        """Return the last STATUSTEXT."""
        return self.pilot.said[-1][2]

    def command(self, number: int, *params: float) -> int:
        """Return the MAV_RESULT of a command."""
        return execute(self.pilot, number, (*params, *[0.0] * 7)[:7])

    def mode(self, name: str) -> int:
        return self.pilot.set_mode(self.pilot.numbers[name])

    def wait(self, seconds: float) -> None:
        """Let time pass, with a ground station that is heard."""
        self.wait_for(lambda: False, seconds)

    def wait_for(self, test: Callable[[], bool], seconds: float = 300.0, heard: bool = True) -> bool:
        """Let time pass until a test holds; return whether it does."""
        for _ in range(round(seconds / TICK)):
            if test():
                return True
            if heard:
                self.pilot.last_heartbeat = self.pilot.time
            advance(self.pilot, TICK)
        return test()

    def fly_up(self, height: float = 10.0) -> None:
        """Take off in GUIDED."""
        assert self.mode("guided") == 0
        assert self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1) == 0
        assert self.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, height) == 0
        assert self.wait_for(lambda: self.pilot.body.position[2] > height - 0.1)

    def load(self, *items: StoredItem) -> None:
        """Put a mission on it, after a home item."""
        self.pilot.stores[0] = [self.item(16, (0.0, 0.0, 0.0)), *items]

    def item(self, command: int, place: Place, *params: float) -> StoredItem:
        """Return an item at metres north, east and up of home."""
        latitude, longitude = self.pilot.degrees_at(place)
        values = (*params, *[0.0] * 4)
        return StoredItem(3, command, values[:4], round(latitude * 1e7), round(longitude * 1e7), place[2])

    def go_to(self, *places: Place, hold: float = 0.0) -> Sequence[StoredItem]:
        return [self.item(16, place, hold) for place in places]

    def closest_to(self, place: Place) -> float:
        """Return how near the track came to a place, metres."""
        return min(
            sum((a - b) ** 2 for a, b in zip(point[1:], place, strict=True)) ** 0.5
            for point in self.pilot.track
        )
