"""A simulated vehicle on its CAN bus: hull, thrusters with their drives, battery, instruments and devices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees, inf

from auv_vessel.body.devices import Devices, Operation, Outside, Release
from auv_vessel.body.dynamics import (
    Body,
    at_rest,
    body_of,
    floating_depth,
    lighter,
    over_ground,
    slopes,
    step,
)
from auv_vessel.body.rotation import angles_of, of_angles, rows_of, to_body
from auv_vessel.body.sensing import SENSORS, Faults, Sensing, Truth, antenna_of
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.thrust import Drive, Propulsion, curve_of, watts_by
from auv_vessel.sheet import Sheet, Vector
from auv_vessel.wire.catalogue import COMMAND_BASE, EMERGENCIES, STATUS_BASE, VEHICLE, messages_of
from auv_vessel.wire.codec import Codec, Received, Value
from auv_vessel.wire.frame import Frame

STEP = 0.01
"""Seconds of a step of the motion."""

DEVICE_COMMAND = 0x500
HEARD = frozenset({*EMERGENCIES.values(), DEVICE_COMMAND})

_SOON = 1e-9  # seconds by which sums of periods may be off
_CALM = Surroundings()


class Vehicle:
    """The vehicle, as all others on its bus know it.

    Attributes:
        faults: what is wrong with it; may be changed at any time.
        drives: of the thrusters, in the order of their numbers.
        devices: what they did is in `devices.operations`.
        charge: joules that are left; without any, all is silent and the drop weight falls.
        has_drives: whether it contains the drives of its thrusters.
    """

    name = VEHICLE
    period = 0.05

    def __init__(
        self,
        sheet: Sheet,
        codec: Codec,
        surroundings: Surroundings = _CALM,
        seed: int = 0,
        *,
        place: Vector | None = None,
        heading: float | None = None,
        without_drives: bool = False,
    ) -> None:
        """Put a vehicle into the water, at rest over ground, level.

        The keys of `Sheet.extra` are documented at `hull_of`, `Propulsion`, `Sensing`, `Devices`, `Release`,
        `antenna_of` and `instruments_of`.

        Args:
            seed: of the noise and bias of its instruments.
            place: north, east and depth, metres; home if None. It begins no higher than it floats.
            heading: degrees; that of home if None.
            without_drives: whether its thrusters' drives are other nodes, which report their thrust. Its
                own then only see to the drop weight.

        Raises:
            ValueError: the sheet has a dimension, mass or coefficient that can't be.
        """
        self.faults = Faults()
        self.drives = tuple(Drive(thruster, sheet.watchdog) for thruster in sheet.thrusters)
        self.devices = Devices(sheet)
        self.charge = sheet.battery
        self._release = Release(sheet)
        self._sheet, self._codec = sheet, codec
        self._laden = body_of(sheet, surroundings.current, surroundings.bottom, surroundings.density)
        self._light = lighter(self._laden, sheet.drop_weight)
        north, east, depth = sheet.home if place is None else place
        deepest = surroundings.bottom - sheet.height / 2.0
        begin = (north, east, min(max(depth, floating_depth(self._laden)), deepest))
        attitude = of_angles(0.0, 0.0, sheet.heading if heading is None else heading)
        self._state = at_rest(self._laden, begin, attitude)
        self._propulsion = Propulsion(sheet, STEP)
        self._curves = [curve_of(each) for each in sheet.thrusters]
        self._sensing = Sensing(sheet, surroundings, seed)
        self._antenna = antenna_of(sheet)
        self._watts = sheet.hotel
        self._begin: float | None = None
        self._steps = 0
        self._reason = "NONE"
        self._fields = {each.name: each.fields for each in messages_of(sheet)}
        self._periods = {
            each.name: each.period
            for each in messages_of(sheet)
            if each.sender == VEHICLE and each.period is not None
        }
        self._due = dict.fromkeys(self._periods, -inf)
        self._last: dict[str, Mapping[str, Value]] = {}
        self.has_drives = not without_drives
        self._outside = Outside(sheet) if without_drives else None
        if without_drives:
            for number in range(len(self.drives)):
                del self._periods[f"Thruster{number}Status"]

    @property
    def released(self) -> bool:
        """Whether the drop weight is gone."""
        return self._release.open

    @property
    def truth(self) -> Truth:
        """Where the vehicle is and how it moves."""
        state, body = self._state, self._body
        rows = rows_of(*state[3:7])
        roll, pitch, heading = angles_of(rows)
        velocity = over_ground(body, state)
        change = slopes(body, state, self._propulsion.thrusts)[7:10]
        u, v, w, p, q, r = state[7:]
        return Truth(
            time=self._time,
            north=state[0],
            east=state[1],
            depth=state[2],
            roll=roll,
            pitch=pitch,
            heading=heading,
            velocity=velocity,
            speeds=to_body(rows, velocity),
            rates=(degrees(p), degrees(q), degrees(r)),
            acceleration=(change[0] + q * w - r * v, change[1] + r * u - p * w, change[2] + p * v - q * u),
            thrusts=tuple(self._propulsion.thrusts),
            axes=rows,
            antenna=state[2] - self._antenna * rows[2][2],
        )

    def hear(self, frame: Frame, now: float) -> None:
        """Obey commands to thrusters and devices, and emergencies."""
        number, status = frame.id - COMMAND_BASE, frame.id - STATUS_BASE
        reported = self._outside is not None and 0 <= status < len(self.drives)
        if not (reported or 0 <= number < len(self.drives) or frame.id in HEARD):
            return
        received = self._codec.decode(frame)
        if received is None or self.charge <= 0.0:
            return
        self._advance(now)
        if reported and self._outside is not None:
            self._outside.hear(status, received, now)
        elif frame.id in EMERGENCIES.values():
            self._reason = str(received.values["Reason"])
            self._stop(release=bool(received.values["Release"]))
        elif frame.id == DEVICE_COMMAND:
            self.devices.command(_operation(received, now))
        elif received.sequence is not None:
            thrust, enable = float(received.values["Thrust"]), bool(received.values["Enable"])
            if self.drives[number].command(thrust, enable, received.sequence, now):
                self._release.command(now)

    def tick(self, now: float) -> Sequence[Frame]:
        """Move on to that time; return what instruments, drives and devices have to say."""
        self._advance(now)
        if self.charge <= 0.0:
            return ()
        truth = self.truth
        frames = []
        for name in self._periods:
            if self._is_due(name, now) and (values := self._values(name, truth)) is not None:
                frames.append(self._encoded(name, values))
        for answer in self.devices.answers(now):
            values = {"Device": answer.device, "Request": answer.request, "State": answer.state}
            frames.append(self._encoded("DeviceStatus", values))
        return frames

    @property
    def _body(self) -> Body:
        return self._light if self._release.open else self._laden

    @property
    def _time(self) -> float:
        return (self._begin or 0.0) + self._steps * STEP

    def _advance(self, now: float) -> None:
        if self._begin is None:
            self._begin = now
        while self._time + STEP <= now + _SOON:
            self._move()
        self._look_after_drives(now)

    def _move(self) -> None:
        self._look_after_drives(self._time)
        wanted = self._thrusts()
        self._state = step(self._body, self._state, self._propulsion.step(wanted), STEP)
        self._steps += 1
        drawn = [watts_by(curve, thrust) for curve, thrust in zip(self._curves, wanted, strict=True)]
        self._watts = self._sheet.hotel + sum(drawn)
        self.charge = max(0.0, self.charge - self._watts * STEP)
        if self.charge <= 0.0:
            self._stop(release=True)
        self._release.run(self._time, self._state[2])

    def _thrusts(self) -> list[float]:
        """Return newtons that the drives put out."""
        if self._outside is None:
            return [drive.thrust for drive in self.drives]
        if self.charge <= 0.0:
            return [0.0] * len(self.drives)
        reported = enumerate(self._outside.thrusts(self._time))
        return [0.0 if number in self.faults.dead else thrust for number, thrust in reported]

    def _look_after_drives(self, now: float) -> None:
        for number, drive in enumerate(self.drives):
            drive.dead = number in self.faults.dead
            drive.run(now)

    def _stop(self, release: bool) -> None:
        for drive in self.drives:
            drive.stop()
        self._release.open = self._release.open or release

    def _is_due(self, name: str, now: float) -> bool:
        due, period = self._due[name], self._periods[name]
        if now < due - _SOON:
            return False
        self._due[name] = due + period if due + period > now + _SOON else now + period
        return name not in self.faults.silent

    def _values(self, name: str, truth: Truth) -> Mapping[str, Value] | None:
        """Return what a message says now; None: nothing."""
        if name in self.faults.frozen and name in self._last:
            return self._last[name]
        values = self._fresh(name, truth)
        if values is not None:
            self._last[name] = values
        return values

    def _fresh(self, name: str, truth: Truth) -> Mapping[str, Value] | None:
        if name == "Health":
            return {
                "Leak": self.faults.leak,
                "Charge": self.charge / self._sheet.battery,
                "Power": self._watts,
                "SonarRange": self._sensing.range_ahead(truth, self.faults),
            }
        if name in SENSORS:
            return self._sensing.measure(name, truth, self.faults)
        if name == f"{VEHICLE}Beat":
            stopped = self._reason != "NONE"
            state = "FAILS_SAFE" if stopped else "RUNS"
            return {"State": state, "Uptime": self._steps * STEP, "Reason": self._reason}
        number = int(name.removeprefix("Thruster").removesuffix("Status"))
        drive = self.drives[number]
        watts = watts_by(self._curves[number], drive.thrust)
        return {"Thrust": drive.thrust, "Power": watts, "Drive": drive.state}

    def _encoded(self, name: str, values: Mapping[str, Value]) -> Frame:
        """Return a message; an instrument says the end of its range of what is beyond."""
        within = dict(values)
        for each in self._fields[name]:
            value = values[each.name]
            if not each.names and not isinstance(value, (str, bool)):
                within[each.name] = min(max(value, each.low), each.high)
        return self._codec.encode(name, **within)


def _operation(received: Received, now: float) -> Operation:
    values = received.values
    return Operation(
        time=now,
        device=int(values["Device"]),
        action=int(values["Action"]),
        parameter=float(values["Parameter"]),
        request=int(values["Request"]),
    )
