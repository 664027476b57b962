"""The decision centre of a vehicle on its bus, in real time."""

from __future__ import annotations

import logging
import time
from collections.abc import Mapping
from math import hypot

from auv_vessel.api import Connection
from auv_vessel.decision.duties import Ready
from auv_vessel.eyes import Detections
from auv_vessel.goals import FAREWELL
from auv_vessel.sheet import Sheet, Vector
from auv_vessel.wire.ports import CHANNEL, open_port
from mmrs_auv.backend.duties_of import Duties, Waters
from mmrs_auv.backend.injected import ClosablePort, Faults, faults_of, injected
from mmrs_auv.backend.keeping import Keeper, keeper_of
from mmrs_auv.backend.options import Connecting, connecting
from mmrs_auv.backend.robot import CanRobot
from mmrs_auv.sheets import sheet_of
from mmrs_core.contributions.execution import Fault
from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.errors import LinkLostError, UnsupportedError
from mmrs_mavlink.records.start import PROCESS
from mmrs_runtime.engine.clocks import RealClock


class ConnectedRobot(CanRobot):
    """A vehicle on a bus of its own; a thread repeats its goals and hears it."""

    def __init__(
        self,
        given: VehicleInput,
        sheet: Sheet,
        reached: tuple[ClosablePort, Connection, Faults | None],
        duties: Duties,
        keeper: Keeper,
        options: Connecting,
        clock: RealClock,
        eyes: Detections | None,
    ) -> None:
        """Say nothing but that nothing is to move, until the robot is to get ready."""
        self._port, self._connection, self._faults = reached
        super().__init__(given, sheet, self._connection.craft, duties, keeper, clearance=options.clearance)
        if self._faults is not None:
            self._faults.rehearsal.record(given.robot.id, self._injected)
        self._kept, self._options, self._clock, self._eyes = keeper, options, clock, eyes
        self._until = float("inf")
        self._met = False

    def prepare(self, now: float) -> bool:
        """Begin to wait until the vehicle is heard and knows where it is."""
        self.done, self.trouble = False, None
        self._until = now + self._options.patience * self._clock.speedup
        plan = self._given.program.fingerprint
        about = {"link": "can", "vehicle": "sub", "confirms": True}
        self._kept.note("start", {"plan": plan, "process": PROCESS, **about})
        self._helm.begin(Ready(), now)
        return True

    def look(self, now: float) -> float:
        """See how it is, all the time; a bus that is gone is a lost link.

        Raises:
            LinkLostError: it is.
        """
        if self._connection.failure is not None:
            raise LinkLostError(str(self._connection.failure))
        return super().look(now)

    def watched(self, now: float) -> bool:
        """Return whether somebody must stay with the vehicle; nobody can where the bus itself is gone."""
        return self._connection.failure is None and super().watched(now)

    def close(self) -> None:
        """Let the last goal be heard, and fall silent; the vehicle then holds, and comes up."""
        time.sleep(FAREWELL)
        self._connection.close()
        self._port.close()
        if self._eyes is not None:
            self._eyes.close()
        if self._faults is not None:
            self._faults.let_go(self._given.robot.id)
        self._kept.close()

    def _injected(self, text: str, content: Mapping[str, object]) -> None:
        self._keeper.note("injected", {"fault": text, **content})

    def _wrong(self, now: float) -> Fault | None:
        return super()._wrong(now) if self._met else self._unmet(now)

    def _unmet(self, now: float) -> Fault | None:
        """Return why the vehicle does not get ready, if it does not."""
        state = self._connection.craft.state()
        self._met = self._helm.done(now)
        if self._met:
            return self._astray(state.north, state.east)
        if now < self._until:
            return None
        if state.age > self._options.patience:
            return Fault("LINK_LOST", "no vehicle is heard on its bus")
        return Fault("POSITION_LOST", "the vehicle does not know where it is")

    def _astray(self, north: float, east: float) -> Fault | None:
        """Return that the vehicle is not where its program begins; one that goes on may be anywhere."""
        live = self._given.live
        home = self._sheet.home
        away = hypot(north - home[0], east - home[1])
        if (live is not None and live.resumed) or away <= self._options.home_tolerance:
            return None
        return Fault("REFUSED", f"the vehicle is {away:.0f} m from its home: bring it home before it begins")

    def _detected(self) -> Mapping[str, Vector]:
        return {} if self._eyes is None else self._eyes.places()


def connected(given: VehicleInput, live: Live) -> ConnectedRobot:
    """Return a robot on its bus.

    Raises:
        LinkLostError: there is no bus, or the port for detections is taken.
        UnsupportedError: its type lacks data, an option is unknown, or it cannot do what its program holds.
    """
    options = connecting(given.options)
    clock = live.clock
    assert isinstance(clock, RealClock)
    surface = given.program.frame.surface
    sheet = sheet_of(
        given.type,
        given.robot.id,
        home=given.robot.home or (0.0, 0.0, surface),
        surface=surface,
        payload=given.robot.payload,
        density=given.environment.get("waterDensity"),
    )
    eyes = _eyes(given, options)
    sight = None if eyes is None or options.objects == "expected" else eyes.place
    duties = Duties(given, sheet, Waters(surface), sight)
    faults = faults_of(given, live, options.inject)
    logging.getLogger("can").setLevel(logging.ERROR)
    channel = live.links.get(given.robot.id, "") or options.channel or CHANNEL

    def tell(text: str) -> None:
        live.say(f"'{given.robot.id}': {text}")

    try:
        port = open_port(options.interface, channel, bit_rate=options.bit_rate or None, say=tell)
    except OSError as error:
        raise LinkLostError(f"robot '{given.robot.id}': {channel}: {error}") from error
    reached: ClosablePort = port if faults is None else injected(port, faults, given.robot.id)
    paced = options.clock or ("bus" if clock.speedup != 1.0 else "real")
    connection = Connection(sheet, reached, "bus" if paced == "bus" else "real")
    return ConnectedRobot(
        given, sheet, (reached, connection, faults), duties, keeper_of(given, live), options, clock, eyes
    )


def _eyes(given: VehicleInput, options: Connecting) -> Detections | None:
    sought = [
        f"move '{move.id}': object {move.target.description!r}"
        for move in given.robot.moves
        if move.target is not None and move.target.description is not None
    ]
    if not options.detections:
        if sought and options.objects != "expected":
            raise UnsupportedError(
                f"robot '{given.robot.id}': nobody looks for objects: --backend-option detections=PORT, or "
                "objects=expected",
                sought,
            )
        return None
    try:
        return Detections(port=options.detections, robot=given.robot.id)
    except OSError as error:
        raise LinkLostError(f"robot '{given.robot.id}': {error}") from error
