"""A simulated vehicle on its bus, and a node that commands its thrusters."""

from collections.abc import Sequence

from sample_vessels import pool_sheet

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.hosting import Rehearsal
from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Codec, Received
from auv_vessel.wire.frame import Frame

QUIET = Surroundings(noise=False, bottom=10.0)


class Helm:
    """A node that commands thrusters, and remembers what all others say."""

    name = "Actuators"
    period = 0.05

    def __init__(self, sheet: Sheet, thrusts: Sequence[float]) -> None:
        self.codec = Codec(sheet)
        self.thrusts = list(thrusts)
        self.enable = True
        self.heard: list[tuple[float, Received]] = []

    def hear(self, frame: Frame, now: float) -> None:
        received = self.codec.decode(frame)
        assert received is not None
        self.heard.append((now, received))

    def tick(self, now: float) -> Sequence[Frame]:
        return [
            self.codec.encode(f"Thruster{number}Command", Thrust=thrust, Enable=self.enable)
            for number, thrust in enumerate(self.thrusts)
        ]

    def last(self, name: str) -> dict[str, float]:
        return dict([received for _, received in self.heard if received.name == name][-1].values)

    def times(self, name: str) -> list[float]:
        return [now for now, received in self.heard if received.name == name]


def at_sea(
    surroundings: Surroundings = QUIET,
    thrusts: Sequence[float] = (0.0,) * 6,
    sheet: Sheet | None = None,
    **how: object,
) -> tuple[Vehicle, Helm, Rehearsal]:
    sheet = sheet or pool_sheet()
    vehicle = Vehicle(sheet, Codec(sheet), surroundings, **({"place": (0.0, 0.0, 3.0)} | how))
    helm = Helm(sheet, thrusts)
    return vehicle, helm, Rehearsal([vehicle, helm])
