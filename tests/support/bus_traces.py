"""What a decision centre does, as anybody on its bus and in its log sees it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Codec, Received, Value
from auv_vessel.wire.frame import Frame
from mmrs_core.behaviour.log import read_logs

COUNTED = 2
"""Bytes at the end of a frame that are another each time: counter and check."""


@dataclass(frozen=True)
class Said:
    """A goal: the bytes of place and pose without counter and check, and what they mean."""

    data: bytes
    values: Mapping[str, Value]


@dataclass
class Trace:
    """Goals, orders to devices and what became of them, each once, in the order in which they were said.

    A node of a rehearsal, too: it only listens.

    Attributes:
        told: goals; another number is another goal. That nothing is to move counts for none.
        orders: commands of devices, without counter and check.
        ends: goals whose end was told, by their number, and how they ended.
    """

    sheet: Sheet
    told: list[Said] = field(default_factory=list)
    orders: list[bytes] = field(default_factory=list)
    ends: list[tuple[int, str]] = field(default_factory=list)
    name: str = "Trace"
    period: float = 1.0

    def __post_init__(self) -> None:
        self._codec = Codec(self.sheet)
        self._place: tuple[Frame, Received] | None = None

    def tick(self, now: float) -> list[Frame]:
        return []

    def hear(self, frame: Frame, now: float) -> None:
        said = self._codec.decode(frame)
        if said is None:
            return
        if said.name == "GoalPlace":
            self._place = (frame, said)
        elif said.name == "GoalPose" and self._place is not None:
            self._keep(frame, said, *self._place)
        elif said.name == "DeviceCommand" and frame.data[:-COUNTED] not in self.orders[-1:]:
            self.orders.append(frame.data[:-COUNTED])
        elif said.name == "Progress" and said.values["State"] in ("REACHED", "FAILED"):
            end = (int(said.values["Goal"]), str(said.values["State"]))
            if end not in self.ends[-1:]:
                self.ends.append(end)

    def _keep(self, frame: Frame, pose: Received, place: Frame, where: Received) -> None:
        goal = Said(place.data[:-COUNTED] + frame.data[:-COUNTED], {**where.values, **pose.values})
        if goal not in self.told[-1:] and pose.values["Mode"] != "IDLE":
            self.told.append(goal)


def steps_in(log: Path) -> Sequence[tuple[str, str, str, str]]:
    """Return label, move, detail and slots of each step in the logs of one robot."""
    return [(each.label, each.move, each.detail, str(each.slot)) for each in read_logs([log])]
