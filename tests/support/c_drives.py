"""Drives in C as they are generated: built here, and held against those of the simulated vehicle."""

import os
import shutil
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

import pytest
from mmrs_auv.targets.can_c.target import CAN_C, files_of

from auv_vessel.body.devices import Release, pressure_of_depth
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import EMERGENCIES, STATUS_BASE
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame, check_of
from mmrs_core.generation.environment import environment_of
from mmrs_core.generation.render import Press

SCRIPT = Path(__file__).parents[2] / "plugins" / "auv" / "tests" / "targets" / "drives_script.c"
STRICT = ("-std=c11", "-Wall", "-Wextra", "-Werror", "-Wconversion")
HUNDREDTHS = 10_000  # microseconds in a hundredth of a second


def need_compiler() -> None:
    """Skip a test where nothing compiles C, or fail it where peers must be."""
    if shutil.which("gcc") and shutil.which("make"):
        return
    message = "gcc and make are not installed: they build the drives that are generated"
    pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)


def written(sheet: Sheet, folder: Path) -> Path:
    """Write the drives of a vehicle; return its folder."""
    press = Press(CAN_C, environment_of(CAN_C))
    for spec in files_of({"vehicle": sheet}):
        path = folder / spec.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(press.content(spec)[0])
    return folder / "vehicle"


def compiled(sheet: Sheet, folder: Path, *options: str) -> Path:
    """Return a program that does what scripts say with the drives of a vehicle."""
    need_compiler()
    made = written(sheet, folder)
    program = made / "script"
    bus, shared = folder / "bus", folder / "drives"
    sources = [SCRIPT, made / "vehicle.c", bus / "bus.c", shared / "drives.c"]
    words = ["gcc", *STRICT, "-O1", *options, *(f"-I{each}" for each in (made, bus, shared))]
    words += ["-o", program, *sources, "-lm"]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    return program


@dataclass
class Script:
    """What happens to drives, line by line; times in hundredths of a second."""

    begin: int = 0
    lines: list[str] = field(default_factory=list)

    def hear(self, at: int, frame: Frame) -> None:
        data = frame.data.hex() or "-"
        self.lines.append(f"h {self._time(at)} {frame.id:x} {int(frame.extended)} {data}")

    def tick(self, at: int) -> None:
        self.lines.append(f"t {self._time(at)}")

    def fail(self, number: int, failed: bool) -> None:
        self.lines.append(f"f {number} {int(failed)}")

    def _time(self, at: int) -> int:
        return (self.begin + at * HUNDREDTHS) % 2**32


def told(program: Path, script: Script) -> list[list[str]]:
    """Return what drives tell after each frame and tick of a script."""
    done = subprocess.run(
        [str(program)], input="\n".join(script.lines) + "\n", capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (0, "")
    blocks = done.stdout.split(".\n")
    assert blocks.pop() == ""
    return [block.splitlines() for block in blocks]


class ReleaseByPressure(Release):
    """A drop weight's release that knows of the depth what the bus says of it."""

    deep = False

    def run(self, now: float, depth: float) -> None:
        super().run(now, 1.0 if self.deep else 0.0)


class Compared:
    """The drives of a simulated vehicle, and a script of all that happens to them."""

    def __init__(self, sheet: Sheet, begin: int = 0) -> None:
        self.vehicle = Vehicle(sheet, Codec(sheet))
        self.release = self.vehicle._release = ReleaseByPressure(sheet)
        self.script = Script(begin)
        self.expected: list[list[str]] = []
        self._count = len(sheet.thrusters)
        self._released = False
        self._deep = pressure_of_depth(sheet)
        self._codec = Codec(sheet)

    def hear(self, at: int, frame: Frame) -> None:
        self.script.hear(at, frame)
        self._go_on(at)
        self.vehicle.hear(frame, at / 100.0)
        said = self._codec.decode(frame)
        if said is not None and said.name == "Pressure":
            self.release.deep = said.values["Pressure"] > self._deep
        self._tell(())

    def tick(self, at: int) -> None:
        self.script.tick(at)
        self._go_on(at)
        self._tell(self.vehicle.tick(at / 100.0))

    def _go_on(self, at: int) -> None:
        self.vehicle._advance(at / 100.0)
        self.release.run(at / 100.0, 0.0)

    def fail(self, number: int, failed: bool) -> None:
        self.script.fail(number, failed)
        dead = self.vehicle.faults.dead
        self.vehicle.faults.dead = dead | {number} if failed else dead - {number}

    def _tell(self, frames: Iterable[Frame]) -> None:
        said = [each for each in frames if 0 <= each.id - STATUS_BASE < self._count]
        lines = [f"s {each.id:x} {each.data.hex()}" for each in said]
        if self.vehicle.released and not self._released:
            self._released = True
            lines.insert(0, "r")
        outputs = (f"o {number} {_text(drive.thrust)}" for number, drive in enumerate(self.vehicle.drives))
        self.expected.append([*lines, *outputs])


def _text(newtons: float) -> str:
    return f"{newtons:.17g}"


def happenings(sheet: Sheet, seed: int, seconds: float, *, emergencies: bool = True) -> Compared:
    """Return drives to which all sorts of things have happened by chance."""
    random = Random(seed)
    compared = Compared(sheet, random.choice([0, 2**32 - 300 * HUNDREDTHS]))
    codec = Codec(sheet)
    silent: dict[int, int] = {}
    for at in range(int(seconds * 100)):
        for number, thruster in enumerate(sheet.thrusters):
            if random.random() < 0.005:
                silent[number] = at + random.randint(1, 150)
            if at < silent.get(number, 0) or (at + number) % random.choice([4, 5, 6]):
                continue
            thrust = random.choice([0.0, 1.0, -1.0, random.uniform(-1.0, 1.0)]) * thruster.max_thrust
            said = codec.encode(f"Thruster{number}Command", Thrust=thrust, Enable=random.random() < 0.9)
            compared.hear(at, _changed(said, random))
        if random.random() < 0.05:
            pressure = random.choice([0.0, 101_325.0, pressure_of_depth(sheet) // 1, 2e5, 2.0**32 - 2.0])
            said = codec.encode("Pressure", Pressure=pressure + random.randint(0, 1), Temperature=4.0)
            compared.hear(at, _changed(said, random))
        if random.random() < 0.01 and sheet.thrusters:
            compared.fail(random.randrange(len(sheet.thrusters)), random.random() < 0.4)
        if emergencies and at > seconds * 70 and random.random() < 0.004:
            emergency = codec.encode(
                random.choice(list(EMERGENCIES)), Reason="LEAK", Release=random.random() < 0.5
            )
            compared.hear(at, _changed(emergency, random))
        if random.random() < (0.02 if at % 5 else 0.9):
            compared.tick(at)
    return compared


def _changed(frame: Frame, random: Random) -> Frame:
    """Return a frame, as it is or with something wrong, or something right that is rare."""
    data = bytearray(frame.data)
    match random.choice(["as it is"] * 12 + ["bits", "length", "extended", "other", "chance", "counter"]):
        case "bits":
            for _ in range(random.randint(1, 3)):
                data[random.randrange(len(data))] ^= 1 << random.randrange(8)
        case "length":
            shorter = random.random() < 0.5 or len(data) == 8
            data = data[: random.randrange(len(data))] if shorter else data + b"\0"
        case "extended":
            return Frame(frame.id, frame.data, extended=True)
        case "other":
            return Frame(frame.id ^ 0x400, frame.data)
        case "chance":
            data[:-2] = random.randbytes(len(data) - 2)
            data[-1] = check_of(frame.id, bytes(data[:-1]))
        case "counter":
            data[-2] = (data[-2] + random.choice([-1, 0, 1, 126, 127, 128, 200])) % 256
            data[-1] = check_of(frame.id, bytes(data[:-1]))
    return Frame(frame.id, bytes(data))
