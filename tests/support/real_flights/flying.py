"""Flies one flight: starts vehicles and program, injects what is to happen, and measures what came of it."""

from __future__ import annotations

import gzip
import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from math import atan2, degrees, hypot, inf
from pathlib import Path
from secrets import token_bytes
from typing import IO

import numpy as np
from example_flight.ways import controller_commands, run_command
from firmware import ARDUCOPTER, ARDUROVER, ARDUROVER_SKID, ARDUSUB, PX4, Firmware, Fix, InstalledVehicle
from flown_times.comparison import Comparison, NotComparableError, compared
from ports import free_port
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_core.errors import MmrsError
from mmrs_core.languages import behaviour
from mmrs_runtime.controllers.geodesy import turn
from mmrs_runtime.orders.channels import Unreachable
from mmrs_runtime.orders.ordering import give
from real_flights import plans
from real_flights.flight import (
    AWAY,
    CONTROLLERS,
    DONE,
    HOLDS,
    HOME,
    PLAN,
    SURFACE,
    Begun,
    Change,
    Cut,
    Disarm,
    Flight,
    Happening,
    Kill,
    Order,
    Pilot,
    Reboot,
    Resume,
)
from real_flights.judging import Planned, distances, landing, planned
from real_flights.plans import AUTO, PX4_AUTO, PX4_MISSION
from real_flights.strait import Strait

KEPT = 0.9
"""Part of the speed-up that must be kept for a flight to count."""

STILL, DISARMED_STILL, STILL_SECONDS = 0.3, 1.5, 8.0
"""Metres per second up to which a vehicle stands still, and seconds for which it must. The estimate of a PX4
that stands disarmed on the ground wanders by up to 0.9 m/s in its simulation."""

REST_SECONDS = 400.0
"""Seconds of the vehicle in which it must come to rest once its program has ended."""

SURFACE_METRES = 1.0
ORDER_SECONDS = 30.0
"""Real seconds in which an order must be confirmed."""

WATCHED = ("interrupt to end", "is left alone")
"""What a program says that has nothing left to do but to watch its vehicle."""

CHANGE_SECONDS = 20.0
"""Seconds of the vehicle after which operators have changed a battery; no simulated one recharges."""

ENDS = "log ends although"
"""What the replay says of the log of a program that was killed, or waits for a new battery."""


@dataclass
class Result:
    """What came of a flight.

    Attributes:
        flown: seconds. times: of each robot, planned and flown, where all came to its end. deviation:
            metres, all and 95 %. landing: metres. margin: to areas.
        photos: that were reported. kept: part of the speed-up. end: of each robot. faults: of the logs.
        deviates: what is not as declared, in words. versions: of firmware. confirmed: orders, with real
            seconds.
    """

    flown: float = 0.0
    times: list[Comparison] = field(default_factory=list)
    deviation: tuple[float, float] | None = None
    landing: float | None = None
    margin: float | None = None
    photos: int = 0
    kept: float = 0.0
    end: dict[str, str] = field(default_factory=dict)
    faults: dict[str, str] = field(default_factory=dict)
    deviates: list[str] = field(default_factory=list)
    versions: set[str] = field(default_factory=set)
    confirmed: dict[str, float] = field(default_factory=dict)


def firmware_of(plan: Planned, robot: str, *, px4: bool) -> Firmware:
    """Return what flies a robot."""
    rover = ARDUROVER_SKID if plan.turns_on_the_spot(robot) else ARDUROVER
    return {"copter": PX4 if px4 else ARDUCOPTER, "rover": rover, "sub": ARDUSUB}[plan.vehicle(robot)]


def missing(flight: Flight, folder: Path) -> list[str]:
    """Return the variables of the binaries that a flight needs and that are not given; write its models."""
    plan = prepare(flight, folder)
    needed = [firmware_of(plan, robot, px4=flight.px4) for robot in robots_of(flight, plan)]
    return sorted({each.variable for each in needed if not each.binary})


def prepare(flight: Flight, folder: Path) -> Planned:
    """Write the models of a flight, plan its mission, and return what is planned."""
    if not (folder / "behaviour.xmi").exists():
        flight.models(folder)
    if not (folder / "behaviour.xmi").exists():
        subprocess.run(
            [sys.executable, "-m", "mmrs_core", "plan", str(folder)], check=True, capture_output=True
        )
    return planned(folder, uploaded=flight.way == PLAN)


def robots_of(flight: Flight, plan: Planned) -> tuple[str, ...]:
    """Return the robots that fly."""
    return flight.robots or tuple(robot.id for robot in plan.program.robots)


def fly(flight: Flight, folder: Path, speedup: float | None = None) -> Result:
    """Fly a flight in a folder, which then holds models, logs, tracks and what was said."""
    return Flying(flight, folder, speedup or flight.speedup).fly()


class Flying:
    """A flight in progress."""

    def __init__(self, flight: Flight, folder: Path, speedup: float) -> None:
        self.flight, self.folder, self.speedup = flight, folder, speedup
        self.plan = prepare(flight, folder)
        self.robots = robots_of(flight, self.plan)
        moves = [move for robot in self.plan.program.robots for move in robot.moves]
        self.recharges = {move.id for move in moves if (behaviour.NS_URI, "Recharge") in move.metaclasses}
        self.logs = folder / "logs"
        self.result = Result()
        self.vehicles: dict[str, InstalledVehicle] = {}
        self.straits: dict[str, Strait] = {}
        self.links: dict[str, str] = {}
        self.processes: dict[str, subprocess.Popen[bytes]] = {}
        self.waits: dict[str, set[int]] = {}
        self.interrupts = 0.0
        self._changed: dict[tuple[str, str], float | None] = {}
        self._upset: set[tuple[str, str]] = set()
        self._key = token_bytes(32) if flight.signed else b""

    def fly(self) -> Result:
        """Fly it."""
        with ExitStack() as stack:
            said = stack.enter_context((self.folder / "said.txt").open("ab"))
            for number, robot in enumerate(self.robots):
                self._man(robot, number, stack)
            try:
                self._begin(said)
                happens = self._happening(said)
                until = time.monotonic() + self._patience()
                while (more := next(happens, False)) or self._working():
                    if not more:
                        self._leave_the_watched(said)
                    self._change_batteries(said)
                    if time.monotonic() > until:
                        self.result.deviates.append("did not come to its end in time")
                        break
                    time.sleep(0.05)
                self._wait_for_rest()
            except plans.PlanError as error:
                self.result.deviates.append(str(error))
            finally:
                for process in self.processes.values():
                    process.kill()
                    process.wait(30.0)
        self._judge()
        return self.result

    def _leave_the_watched(self, said: IO[bytes]) -> None:
        """Interrupt a program that only watches its vehicle, once that is at rest; twice, as operators do."""
        running = [process for process in self.processes.values() if process.poll() is None]
        if time.monotonic() < self.interrupts or not running:
            return
        self.interrupts = time.monotonic() + 3.0
        words = Path(said.name).read_text("utf-8")
        if any(each in words for each in WATCHED) and all(map(self._still, self.robots)):
            for process in running:
                process.send_signal(signal.SIGINT)

    def _change_batteries(self, said: IO[bytes]) -> None:
        """Confirm that batteries were changed, as operators do, where robots have waited long enough."""
        for robot in self.robots if self.recharges else ():
            steps, now = self._steps(robot), self.vehicles[robot].observer.now
            latest = steps[-1] if steps else None
            if latest is None or latest.label != "begin" or latest.move not in self.recharges:
                continue
            begun = self._changed.setdefault((robot, latest.move), now)
            if begun is not None and now > begun + CHANGE_SECONDS:
                self._changed[robot, latest.move] = None
                self._let_happen(Order("battery-changed"), robot, said)

    def _patience(self) -> float:
        longest = max(self.plan.seconds.values(), default=0.0)
        happenings = sum(when.seconds for when, _ in self.flight.happens)
        return 90.0 + (180.0 + 2.0 * longest + happenings) / self.speedup

    def _man(self, robot: str, number: int, stack: ExitStack) -> None:
        firmware = firmware_of(self.plan, robot, px4=self.flight.px4)
        vehicle = InstalledVehicle(
            firmware,
            self.plan.stand(robot),
            self.folder / "vehicles",
            number=number,
            speedup=self.speedup,
            parameters=self.flight.parameters,
            key=self._key,
        )
        self.links[robot] = vehicle.link
        # As behind a radio: a simulation that restarts sends from another port.
        if any(isinstance(what, Cut | Reboot) for _, what in self.flight.happens) and number == 0:
            if firmware is PX4:  # it sends to a port of its own choice
                program = free_port()
                self.links[robot] = vehicle.link_at(program)
                self.straits[robot] = stack.enter_context(Strait(program, vehicle.port))
            else:
                self.straits[robot] = stack.enter_context(Strait(vehicle.port))
                vehicle.port = self.straits[robot].port
        self.vehicles[robot] = stack.enter_context(vehicle)

    def _begin(self, said: IO[bytes], *more: str) -> None:
        if self.flight.way == PLAN:
            self._load_plans()
            return
        more = (*more, *self._signed())
        if self.flight.way == CONTROLLERS:
            self._generate("mavlink-python", "controllers")
            commands = controller_commands(self.folder / "controllers", self.links, self.speedup, self.logs)
        else:
            commands = {"run": run_command([str(self.folder)], self.links, self.speedup, self.logs)}
            if len(self.robots) < len(self.plan.program.robots):
                commands["run"] += [part for robot in self.robots for part in ("--robot", robot)]
        for name, command in commands.items():
            arguments = [sys.executable, *command, *self.flight.arguments, *more]
            self.processes[name] = subprocess.Popen(
                arguments, stdin=subprocess.DEVNULL, stdout=said, stderr=said, cwd=self.folder
            )

    def _signed(self) -> tuple[str, ...]:
        """Give the vehicles their key, and return the arguments by which programs have it."""
        if not self._key:
            return ()
        file = self.folder / "key"
        if not file.exists():
            file.write_bytes(self._key)
            file.chmod(0o600)
            for vehicle in self.vehicles.values():
                self._wait(lambda v=vehicle: v.observer.now > 5.0, 60.0)
                vehicle.sign()
        return ("--signing-key", str(file))

    def _generate(self, target: str, where: str) -> str:
        """Generate files, and return what was said."""
        command = [sys.executable, "-m", "mmrs_core", "generate", str(self.folder / "behaviour.xmi")]
        command += ["--target", target, "-o", str(self.folder / where), "--allow-lossy", "--force"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise plans.PlanError(f"{target}: {done.stderr[-300:]}")
        return done.stdout

    def _load_plans(self) -> None:
        said = self._generate("qgc-plan", "plans")
        for robot, vehicle in self.vehicles.items():
            (file,) = [p for p in (self.folder / "plans").glob("*.plan") if robot.lower() in p.stem.lower()]
            self._wait(lambda v=vehicle: v.observer.now > 40.0, 120.0)
            px4 = vehicle.firmware is PX4
            plans.set_up(vehicle.observer, file.name, said)
            self.items = plans.upload(vehicle.observer, file, px4=px4)
            self.waits[robot] = plans.waits_in(file, px4=px4)
            plans.start(vehicle.observer, rover=self.plan.vehicle(robot) == "rover", px4=px4)

    def _working(self) -> bool:
        if self.flight.way == PLAN:
            for robot in self.robots:
                observer = self.vehicles[robot].observer
                if observer.item in self.waits[robot] and self._still(robot):
                    plans.go_on(observer)
            return not all(self._at_rest(robot) for robot in self.robots)
        return any(process.poll() is None for process in self.processes.values())

    def _happening(self, said: IO[bytes]) -> Iterator[bool]:
        """Let happen what happens, each once its time has come; yield while there is more to come."""
        robot, since = self.robots[0], 0.0
        for when, what in self.flight.happens:
            if isinstance(when, Begun):
                robot = when.robot or self.robots[0]
                while not self._has_begun(robot, when.move):
                    yield True
                since = self.vehicles[robot].observer.now
            observer = self.vehicles[robot].observer
            while observer.now < since + when.seconds:
                yield True
            self._let_happen(what, robot, said)
            since = observer.now

    def _let_happen(self, what: Happening, robot: str, said: IO[bytes]) -> None:
        observer, steps = self.vehicles[robot].observer, self._steps(robot)
        self._upset |= {(robot, step.move) for step in steps[-1:]}
        said.write(f"--- {observer.now:.1f} s: {what}\n".encode())
        said.flush()
        match what:
            case Order(order):
                self._order(order, robot)
            case Change(parameters):
                observer.change(parameters)
            case Cut(inwards, outwards):
                self.straits[robot].inwards, self.straits[robot].outwards = inwards, outwards
            case Pilot(mode, submode):
                observer.command(mavlink.MAV_CMD_DO_SET_MODE, 1, mode, submode)
            case Disarm():
                observer.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
            case Kill():
                for process in self.processes.values():
                    process.kill()
                    process.wait(30.0)
            case Resume():
                self._begin(said, "--resume")
            case Reboot():
                self.result.kept = self._kept()
                observer.command(mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1, 0, 0, 0, 0, 20190226)

    def _order(self, order: str, robot: str) -> None:
        try:
            for reply in give(self.logs, order, [robot], seconds=ORDER_SECONDS):
                self.result.confirmed[order] = reply["seconds"]
                if not reply["confirmed"]:
                    self.result.deviates.append(f"{order} not confirmed: {reply['why']}")
        except (Unreachable, ValueError, OSError) as error:
            self.result.deviates.append(f"{order}: {error}")

    def _has_begun(self, robot: str, move: str) -> bool:
        if self.flight.way == PLAN:
            return self.vehicles[robot].observer.armed
        return any(step.label == "begin" and step.move == move for step in self._steps(robot))

    def _steps(self, robot: str) -> list[object]:
        path = self.logs / f"{robot}.jsonl"
        return [_Step(line) for line in path.read_text("utf-8").splitlines()] if path.exists() else []

    def _wait(self, holds: Callable[[], bool], seconds: float) -> bool:
        until = time.monotonic() + seconds
        while not holds():
            if time.monotonic() > until:
                return False
            time.sleep(0.05)
        return True

    def _at_rest(self, robot: str) -> bool:
        """Return whether a vehicle has come to rest, a copter on the ground or where it is to hold."""
        observer, kind = self.vehicles[robot].observer, self.plan.vehicle(robot)
        if self.flight.way == PLAN and kind != "copter" and observer.item < self.items:
            return False
        return self._still(robot) and (not observer.armed or kind != "copter" or self.flight.ends == HOLDS)

    def _still(self, robot: str) -> bool:
        observer = self.vehicles[robot].observer
        latest = [fix for fix in observer.track[-400:] if fix.t > observer.now - STILL_SECONDS]
        flew = observer.has_been_armed
        return flew and all(
            hypot(fix.vx, fix.vy, fix.vz) < (STILL if fix.armed else DISARMED_STILL) for fix in latest
        )

    def _wait_for_rest(self) -> None:
        flew = [robot for robot in self.robots if self.vehicles[robot].observer.has_been_armed]
        self._wait(lambda: all(map(self._at_rest, flew)), 30.0 + REST_SECONDS / self.speedup)

    def _kept(self) -> float:
        return min(vehicle.observer.pace / self.speedup for vehicle in self.vehicles.values())

    def _judge(self) -> None:
        result, flight = self.result, self.flight
        result.kept = result.kept or self._kept()
        if result.kept < KEPT:
            result.deviates.append(f"only {int(100.0 * result.kept)} % of the speed-up kept")
        all_rows: list[np.ndarray] = []
        for robot in self.robots:
            observer = self.vehicles[robot].observer
            write_track(self.folder / f"{robot}.track.csv.gz", observer.track)
            result.photos += max(observer.photos) - min(observer.photos) + 1 if observer.photos else 0
            result.versions.add(f"{self.vehicles[robot].firmware.name} {observer.version}".strip())
            flown = [fix for fix in observer.track if fix.armed]
            if not flown:
                result.deviates.append(f"'{robot}' was never armed")
                result.end[robot] = "on the ground"
                continue
            line, plane = self.plan.line[robot], self.plan.vehicle(robot) == "rover"
            rows = self.plan.placed(robot, flown)
            if flight.looks is not None:
                self._judge_looks(flown, rows, *flight.looks)
            all_rows.append(distances(rows, line, plane=plane))
            result.landing = max(result.landing or 0.0, landing(rows, line))
            if (margin := self.plan.margin(robot, flown)) is not None:
                result.margin = min(margin, result.margin if result.margin is not None else margin)
            result.end[robot] = self._end_of(robot, rows[-1], observer.track[-1])
            if flight.way == PLAN:
                result.flown = max(result.flown, flown[-1].t - flown[0].t)
        if all_rows:
            values = np.concatenate(all_rows)
            result.deviation = (float(values.max()), float(np.percentile(values, 95)))
        if flight.way != PLAN:
            self._judge_logs()
        self._compare()
        if flight.timed and flight.ends == DONE and set(result.end.values()) == {DONE}:
            self._judge_times()

    def _judge_looks(
        self, flown: list[Fix], rows: np.ndarray, east: float, north: float, most: float
    ) -> None:
        """Compare where the vehicle looks on missions with the direction of a place."""
        auto = PX4_AUTO << 16 | PX4_MISSION << 24 if self.flight.px4 else AUTO
        beside = [
            abs(turn(fix.hdg, degrees(atan2(east - x, north - y))))
            for fix, (x, y, _) in zip(flown, rows, strict=True)
            if fix.mode == auto
        ]
        found = float(np.percentile(beside, 90)) if beside else inf
        if found > most:
            self.result.deviates.append(f"looks {found:.0f} degrees beside the place")

    def _judge_times(self) -> None:
        """Compare what was flown with the plan, and with the bounds of its check; waits are left out."""
        try:
            self.result.times = compared(self.folder, without=self._upset)
        except NotComparableError as error:
            self.result.deviates.append(str(error))
        self.result.deviates += [fault for each in self.result.times for fault in each.faults()]
        self.result.deviates += [
            f"'{each.robot}': not completed" for each in self.result.times if not each.whole
        ]

    def _end_of(self, robot: str, place: np.ndarray, last: Fix) -> str:
        kind = self.plan.vehicle(robot)
        east, north, _ = self.plan.line[robot][0]
        away = hypot(place[0] - east, place[1] - north)
        if self.flight.ends == DONE:
            codes = [process.returncode for process in self.processes.values()]
            return DONE if self.flight.way == PLAN or not any(codes) else f"exit code {max(codes)}"
        if kind == "sub" and last.rel > -SURFACE_METRES and self.flight.ends == SURFACE:
            return SURFACE
        if away < self.flight.landing:
            return HOME
        return HOLDS if self.vehicles[robot].observer.armed or kind == "rover" else AWAY

    def _judge_logs(self) -> None:
        result = self.result
        times = []
        for robot in self.robots:
            for step in self._steps(robot):
                times.append(step.time)
                if step.label == "fault":
                    result.faults[robot] = step.detail
        if times:
            result.flown = (max(times) - min(times)) * min(result.kept, 1.0)
        if len(self.robots) < len(self.plan.program.robots):
            return
        try:
            replayed = replay(self.plan.program, read_logs([self.logs]))
        except MmrsError as error:
            result.deviates.append(f"logs: {error}")
            return
        broken_off = self.flight.ends != DONE and not self.flight.fault
        result.deviates += [
            f"replay: {each}" for each in replayed.complaints[:2] if not (broken_off and ENDS in each.message)
        ]

    def _compare(self) -> None:
        result, flight = self.result, self.flight
        for robot, end in result.end.items():
            if end != flight.ends:
                result.deviates.append(f"'{robot}': end {end} instead of {flight.ends}")
        found = {name.split(":")[0].split(" ")[0] for name in result.faults.values()}
        if flight.way != PLAN and found != ({flight.fault} if flight.fault else set()):
            result.deviates.append(f"log holds {', '.join(sorted(found)) or 'no fault'}")
        if flight.deviation is not None and result.deviation and result.deviation[0] > flight.deviation:
            result.deviates.append(f"{result.deviation[0]:.2f} m from the planned line")
        judged = flight.ends in (DONE, HOME) and result.landing is not None
        if judged and result.landing > flight.landing:
            result.deviates.append(f"{result.landing:.2f} m from the planned end")
        if not flight.photos[0] <= result.photos <= (flight.photos[1] or inf):
            result.deviates.append(f"{result.photos} photos")
        if flight.says not in (self.folder / "said.txt").read_text("utf-8"):
            result.deviates.append(f"did not say '{flight.says}'")
        if result.margin is not None and result.margin < -0.05 and flight.deviation is not None:
            result.deviates.append(f"{-result.margin:.2f} m too close to an area")


class _Step:
    """A line of a step log, maybe still being written."""

    def __init__(self, line: str) -> None:
        try:
            said = json.loads(line)
        except ValueError:
            said = {}
        self.label, self.move = said.get("label", ""), said.get("move", "")
        self.detail, self.time = said.get("detail", ""), said.get("time", 0.0)


def write_track(path: Path, track: list[Fix]) -> None:
    """Write a track as a table of comma-separated values, compressed."""
    with gzip.open(path, "wt", encoding="ascii") as file:
        file.write(",".join(Fix._fields) + "\n")
        for fix in track:
            file.write(",".join(f"{value:.7f}".rstrip("0").rstrip(".") for value in map(float, fix)) + "\n")
