"""All injected faults of one process: begun and ended at their time, reported and recorded."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterable, Mapping
from math import inf
from typing import NamedTuple, Protocol

from ..bus.carriers.carrier import Carrier
from ..clock import Clock
from ..ports import Port
from ..records.blackbox import BlackBox
from .carrier import InjectedCarrier
from .port import InjectedPort, Line
from .process import Effect, effect_of
from .spec import OF_BUS, OF_PROCESS, OF_STATIONS, OF_VEHICLE, Injection, Injections

Note = Callable[[str, Mapping[str, object]], None]
"""Records an injected fault: its text, and its state."""

LONGEST_WAIT = 60.0
NO_STATION = "no ground station received yet"
ONLY_SIMULATED = "the vehicle has no simulated satellites: it is a real one, or does not answer"


class Stations(Protocol):
    """Ground stations that a link receives; `deaf`: whether they are ignored."""

    deaf: bool

    @property
    def systems(self) -> Collection[object]:
        """Return those that are received."""
        ...


class Attended(NamedTuple):
    """What faults of a robot's vehicle need.

    Attributes:
        stations: received by its link.
        satellites: enables or disables satellite reception of its vehicle; returns whether the vehicle
            confirms it.
    """

    stations: Stations
    satellites: Callable[[bool], bool]


class Rehearsal:
    """The faults of one process; without any, nothing is changed and no thread is started."""

    def __init__(self, injections: Injections, clock: Clock, say: Callable[[str], None]) -> None:
        """Prepare faults; `say` tells people about them."""
        self._injections = injections
        self._clock = clock
        self._say = say
        self._notes: dict[str, Note] = {}
        self._vehicles: dict[str, Attended] = {}
        self._carriers: list[InjectedCarrier] = []
        self._ends: list[tuple[float, Injection, Effect | None]] = []
        self._closed = threading.Event()
        self._noting = threading.Lock()
        self._thread = threading.Thread(target=self._follow, name="injected faults", daemon=True)

    def start(self) -> None:
        """Announce the faults, and inject them at their times."""
        if self._injections.faults:
            faults = ", ".join(fault.text for fault in self._injections.faults)
            self._say(f"faults are injected: {faults}, seed={self._injections.seed}")
            self._thread.start()

    def close(self) -> None:
        """Undo what is still there, and do nothing more."""
        self._closed.set()
        if self._thread.is_alive():
            self._thread.join()

    def record(self, robot: str, note: Note) -> None:
        """Register the recorder of a robot's faults, beginning with the announced ones."""
        self._notes[robot] = note
        for fault in self._injections.faults:
            if fault.robot in ("", robot):
                note(fault.text, {"state": "asked for", "seed": self._injections.seed})

    def forget(self, robot: str) -> None:
        """Record nothing more for a robot, and leave its vehicle alone; all faults end with the last one."""
        with self._noting:
            self._notes.pop(robot, None)
            self._vehicles.pop(robot, None)
            others = bool(self._notes)
        if not others:
            self.close()

    def wrap(self, port: Port, robots: Collection[str], line: type[Line] = Line) -> Port:
        """Return a port that these robots share, with the faults of their links, each way by a `line`."""
        faults = self._injections.of_link(robots)
        if not faults:
            return port
        seed = f"{self._injections.seed} {' '.join(sorted(robots))}"
        incoming = line([f for f in faults if f.name != "cut-out"], self._clock, f"{seed} in")
        outgoing = line([f for f in faults if f.name != "cut-in"], self._clock, f"{seed} out")

        def count(counts: Mapping[str, int]) -> None:
            self._say(f"{_list(robots)}: injected, in pieces: {dict(counts)}")
            self._note(robots, "link", {"state": "counted", **counts})

        return InjectedPort(port, self._clock, incoming, outgoing, count)

    def wrap_carrier(self, carrier: Carrier, robots: Collection[str]) -> Carrier:
        """Return a carrier of these robots' bus, with its faults."""
        faults = self._injections.of_bus().faults
        if not faults:
            return carrier
        seed = f"{self._injections.seed} {' '.join(sorted(robots))} bus"
        self._carriers.append(InjectedCarrier(carrier, faults, self._clock, seed))
        return self._carriers[-1]

    def attend(self, robot: str, vehicle: Attended) -> None:
        """Keep what faults of a robot's vehicle itself need."""
        self._vehicles[robot] = vehicle
        now = self._clock.now()
        if any(f.acts(now) for f in self._injections.of_stations() if f.robot in ("", robot)):
            vehicle.stations.deaf = True

    def _follow(self) -> None:
        coming = list(self._injections.timed())
        while not self._closed.is_set():
            now = self._clock.now()
            for fault in [f for f in coming if f.begins <= now]:
                coming.remove(fault)
                self._begin(fault)
            for entry in [e for e in self._ends if e[0] <= now]:
                self._ends.remove(entry)
                self._end(entry[1], entry[2])
            following = min([f.begins for f in coming] + [when for when, _, _ in self._ends], default=inf)
            self._closed.wait(min(self._clock.real(following - self._clock.now()), LONGEST_WAIT))
        for _, fault, effect in self._ends:
            self._end(fault, effect)

    def _begin(self, fault: Injection) -> None:
        effect = effect_of(fault, self._clock.real)
        self._tell(fault, "begins")
        if effect is not None:
            effect.begin()
        if fault.name in OF_VEHICLE:
            self._switch(fault, on=False)
        if fault.name in OF_STATIONS:
            self._deafen(fault, deaf=True)
        if fault.name in OF_BUS:
            for carrier in self._carriers:
                carrier.cut()
        if fault.ends < inf or fault.name in OF_PROCESS:
            self._ends.append((fault.ends, fault, effect))

    def _end(self, fault: Injection, effect: Effect | None) -> None:
        if effect is not None:
            effect.end()
        if fault.name in OF_VEHICLE and not self._closed.is_set():
            self._switch(fault, on=True)
        if fault.name in OF_STATIONS:
            self._deafen(fault, deaf=False)
        if fault.name in OF_BUS and not self._closed.is_set():
            for carrier in self._carriers:
                carrier.mend()
        self._tell(fault, "ends")

    def _deafen(self, fault: Injection, *, deaf: bool) -> None:
        """Receive or ignore ground stations; report where there is none, since nothing changes then."""
        for robot, vehicle in tuple(self._vehicles.items()):
            if fault.robot in ("", robot):
                vehicle.stations.deaf = deaf
                if deaf and not vehicle.stations.systems:
                    self._say(f"{robot!r}: {fault.text}: {NO_STATION}")
                    self._note((robot,), fault.text, {"state": "begins", "why": NO_STATION})

    def _switch(self, fault: Injection, on: bool) -> None:
        for robot, vehicle in tuple(self._vehicles.items()):
            if fault.robot in ("", robot):
                threading.Thread(
                    target=self._switch_one, args=(fault, robot, vehicle, on), name="satellites", daemon=True
                ).start()

    def _switch_one(self, fault: Injection, robot: str, vehicle: Attended, on: bool) -> None:
        if not vehicle.satellites(on):
            self._say(f"{robot!r}: {fault.text}: {ONLY_SIMULATED}")
            self._note((robot,), fault.text, {"state": "impossible", "why": ONLY_SIMULATED})

    def _tell(self, fault: Injection, state: str) -> None:
        self._say(f"{fault.text}: {state}")
        self._note(tuple(self._notes) if not fault.robot else (fault.robot,), fault.text, {"state": state})

    def _note(self, robots: Iterable[str], text: str, content: Mapping[str, object]) -> None:
        with self._noting:
            for note in [self._notes[robot] for robot in robots if robot in self._notes]:
                note(text, content)


def noted_in(box: BlackBox | None) -> Note:
    """Return what records faults in a black box, where there is one."""

    def note(text: str, content: Mapping[str, object]) -> None:
        if box is not None:
            box.write("injected", fault=text, **content)

    return note


def _list(robots: Iterable[str]) -> str:
    return ", ".join(map(ascii, robots))
