"""The side of the bus of decision centres in Ada, held against that of the interpreter: frame by frame."""

import json
import shutil
import struct
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import inf, nan, nextafter
from pathlib import Path
from random import Random

import ada_centres
from ada_centres import write
from dives import dive
from mmrs_auv.targets.ada import tables
from mmrs_auv.targets.ada.bus import HEARD, SPOKEN

from auv_vessel.api import Craft, State
from auv_vessel.eyes import CAMERAS, Detection, to_datagram
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import (
    BEATS,
    COMMON,
    EMERGENCIES,
    MODES,
    PROGRESS,
    REASONS,
    Message,
    depth_step,
)
from auv_vessel.wire.catalogue import Field as Part
from auv_vessel.wire.codec import Codec, Value
from auv_vessel.wire.frame import Frame, check_of

SCRIPT = Path(__file__).parents[2] / "plugins" / "auv" / "tests" / "targets" / "craft_script.adb"
FIGURES = {**tables.SECONDS, **tables.METRES, **tables.PARTS, **tables.COUNTS}
KNOWN = {message.name: message for message in (*COMMON, *BEATS)}
MESSAGES: Sequence[Message] = [KNOWN[name] for name in (*SPOKEN, *HEARD)]
OWNER = 'Né "1"'
OBJECTS = ("a buoy", 'gate "1"', "é")
NAMES = (
    b'"a\\u0020\\u0062uoy"', b'"gate \\u00221\\""', b'"\\u00e9"', b'"\xc3\xa9"', b'"a buoy\\n"', b'"a\x01"',
    b'"\\ud83e"', b'"\\ud83e\\udd91"', b'"\\x"', b'""', b'"' + 81 * b"a" + b'"', b"7",
)  # fmt: skip
"""Names as others write them: some are the same as those of objects, some are none."""

GREATEST = struct.unpack(">d", bytes.fromhex("7fefffffffffffff"))[0]


def compiled(folder: Path) -> Path:
    """Return a program that does what scripts say with the modules of a decision centre."""
    robot = write(dive(), folder)
    listed = ",\n      ".join(f"{number} => Catalogue.{each.name}" for number, each in enumerate(MESSAGES))
    figures = ",\n      ".join(
        f"{number} => Long_Float (Tables.LIMIT_{each})" for number, each in enumerate(FIGURES)
    )
    table = f"   Messages : constant array (Natural range <>) of Wire.Message :=\n     ({listed});\n"
    table += f"   Figures : constant array (Natural range <>) of Long_Float :=\n     ({figures});\n"
    text = f"with Catalogue;\nwith Tables;\nwith Wire;\n\npackage Listed is\n{table}end Listed;\n"
    (robot / "listed.ads").write_text(text)
    shutil.copy(SCRIPT, robot)
    return ada_centres.compiled(robot, f"../{SCRIPT.name}")


def told(program: Path, lines: Sequence[str]) -> list[str]:
    """Return the answer to each line of a script."""
    script = "\n".join(lines) + "\n"
    done = subprocess.run([str(program)], input=script, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    return [" ".join(line.split()) for line in done.stdout.splitlines()]


def bits(number: float) -> str:
    """Return a number's 64 bits as hexadecimal digits."""
    return struct.pack(">d", number).hex()


def real(digits: str) -> float:
    """Return the number of 64 bits."""
    found: float = struct.unpack(">d", bytes.fromhex(digits))[0]
    return found


def words_of(frames: Sequence[Frame]) -> str:
    """Return frames as the program tells them."""
    return " ".join(f"{each.id} {each.data.hex()}" for each in frames)


def some_value(part: Part, random: Random) -> float:
    """Return a value of a field: anywhere, at a step, half a step beside one, or at or beyond its bounds."""
    if part.names:
        return float(random.randrange(len(part.names) + (random.random() < 0.05)))
    step = random.randint(round(part.low / part.scale), round(part.high / part.scale))
    beside = random.choice([0.0, 0.5, -0.5, 0.4999999999, random.uniform(-0.5, 0.5)])
    value = random.choice([random.uniform(part.low, part.high), (step + beside) * part.scale])
    value = random.choice([value] * 8 + [part.low, part.high, -0.0, nextafter(value, inf)])
    if random.random() < 0.05:
        beyond = [nextafter(part.high, inf), nextafter(part.low, -inf), part.high + part.scale]
        value = random.choice([*beyond, nan, inf, -inf, 1e300, -1e300])
    return value


def said(codec: Codec, message: Message, values: Sequence[float]) -> Frame | None:
    """Return the frame that says so; None: it is refused."""
    meant: dict[str, Value] = {}
    for part, value in zip(message.fields, values, strict=True):
        known = part.names and value < len(part.names)
        meant[part.name] = part.names[int(value)] if known else ("?" if part.names else value)
    try:
        return codec.encode(message.name, **meant)
    except ValueError:
        return None


def meant(codec: Codec, message: Message, frame: Frame) -> str:
    """Return what a frame means, as the program tells it."""
    found = codec.decode(frame)
    if found is None:
        return "none"
    values = (found.values[part.name] for part in message.fields)
    numbers = [
        float(part.names.index(str(value)) if part.names else value)
        for part, value in zip(message.fields, values, strict=True)
    ]
    return " ".join(map(bits, [*numbers, float(found.sequence or 0)]))


def some_frame(codec: Codec, message: Message, random: Random) -> Frame:
    """Return a frame of a message: right, broken, of another length or identifier, or right and senseless."""
    frame = None
    while frame is None:
        frame = said(codec, message, [some_value(part, random) for part in message.fields])
    return broken(frame, random)


def broken(frame: Frame, random: Random) -> Frame:
    """Return a frame as it is, mostly, or with something wrong."""
    data = bytearray(frame.data)
    match random.choice(["as it is"] * 4 + ["bits", "length", "identifier", "chance", "check"]):
        case "bits":
            for _ in range(random.randint(1, 4)):
                data[random.randrange(len(data))] ^= 1 << random.randrange(8)
        case "length":
            data = (data[: random.randrange(len(data))] if random.random() < 0.7 else data + b"\0")[:8]
        case "identifier":
            return Frame(frame.id ^ (1 << random.randrange(11)), frame.data)
        case "chance":
            data[:-1] = random.choice([random.randbytes, lambda n: b"\xff" * n, lambda n: b"\x80" * n])(
                len(data) - 1
            )
            for place in range(len(data) - 2):
                if random.random() < 0.3:
                    data[place] = random.choice([0x00, 0x7F, 0x80, 0xFF])
            data[-1] = check_of(frame.id, bytes(data[:-1]))
        case "check":
            data[-1] = random.randrange(256)
    return Frame(frame.id, bytes(data))


@dataclass
class Compared:
    """A craft of the interpreter, and a script of all that it is told, with what must come of it."""

    sheet: Sheet
    craft: Craft = field(init=False)
    lines: list[str] = field(default_factory=list)
    expected: list[str] = field(default_factory=list)
    states: list[tuple[int, float, str]] = field(default_factory=list)
    request: int = 0

    def __post_init__(self) -> None:
        self.craft = Craft(self.sheet, Codec(self.sheet))
        self._tell(f"v {bits(depth_step(self.sheet.max_depth))}")
        self._tell(f"l {bits(self.sheet.extra.get('position.lost', tables.METRES['POSITION_LOST']))}")

    def go(self, mode: str, place: Sequence[float], heading: float | None, speed: float) -> None:
        north, east, depth = place
        numbers = " ".join(map(bits, (north, east, depth, heading or 0.0, speed)))
        line = f"g {MODES.index(mode)} {numbers} {int(heading is None)}"
        try:
            if mode == "GO_TO":
                self.craft.go_to(*place, speed=speed, heading=heading)
            else:
                self.craft.search(*place, speed=speed, heading=heading)
        except ValueError:
            self._tell(line, "refused")
        else:
            self._tell(line)

    def turn(self, heading: float) -> None:
        self.craft.turn(heading)
        self._tell(f"g {MODES.index('TURN')} {' '.join(map(bits, (0.0, 0.0, 0.0, heading, 0.0)))} 0")

    def rest(self, mode: str) -> None:
        self.craft.idle() if mode == "IDLE" else self.craft.surface()
        self._tell(f"g {MODES.index(mode)} {' '.join([bits(0.0)] * 5)} 0")

    def operate(self, number: int, action: int, parameter: float) -> None:
        line = f"o {number} {action} {bits(parameter)}"
        try:
            self.request = self.craft.operate(self.sheet.devices[number], action, parameter)
        except ValueError:
            self._tell(line, "refused")
        else:
            self._tell(line)

    def give_up(self, reason: str) -> None:
        self.craft.emergency(reason)
        self._tell(f"x {REASONS.index(reason)}")

    def hear(self, now: float, frame: Frame) -> None:
        self.craft.hear(frame, now)
        self._tell(f"h {bits(now)} {frame.id} {frame.data.hex()}")

    def tick(self, now: float) -> None:
        self._tell(f"t {bits(now)}", words_of(self.craft.tick(now)))
        self.states.append((len(self.lines), now, _state(self.craft.state(), self.request)))
        self._tell("s", "?")

    def _tell(self, line: str, answer: str = "") -> None:
        self.lines.append(line)
        self.expected.append(answer)

    def differences(self, program: Path) -> Iterator[tuple[str, str, str]]:
        """Yield lines after which the program does otherwise, what it does, and what is wanted."""
        answers = told(program, self.lines)
        assert len(answers) == len(self.lines)
        for number, now, state in self.states:
            answers[number] = _compared(answers[number].split(), now)
            self.expected[number] = state
        for line, answer, wanted in zip(self.lines, answers, self.expected, strict=True):
            if answer != wanted:
                yield line, answer, wanted


def _compared(answer: Sequence[str], now: float) -> str:
    """Return what the program knows, with ages instead of times."""
    *numbers, heard, known = map(real, answer[:10])
    places = [None if abs(each) == GREATEST else each for each in numbers]
    ages = [inf if each == -GREATEST else now - each for each in (heard, known)]
    return f"{places} {ages} {' '.join(answer[10:])}"


def _state(state: State, request: int) -> str:
    numbers = [
        state.north, state.east, state.depth, state.heading,
        None if state.uncertainty == inf else state.uncertainty,
        -1.0 if state.charge is None else state.charge,
        state.sonar, state.distance,
    ]  # fmt: skip
    emergency = 0 if state.emergency is None else max(1, REASONS.index(state.emergency))
    answer = PROGRESS.index(state.devices.get(request, "NONE"))
    flags = f"{state.trusted} {state.leak} {state.position_lost}".upper()
    words = f"{flags} {PROGRESS.index(state.progress)} {emergency} {request} {answer}"
    return f"{numbers} {[state.silent, state.age]} {words}"


def happenings(sheet: Sheet, seed: int, ticks: int) -> Compared:
    """Return a craft that is told all sorts of things by chance, with good values and bad."""
    random = Random(seed)
    compared, codec = Compared(sheet), Codec(sheet)
    device = 0
    for tick in range(ticks):
        now = tick * 0.2
        if random.random() < 0.3:
            _order(compared, random)
        for name in HEARD:
            if name not in ("Progress", "DeviceStatus") and random.random() < 0.4:
                compared.hear(now, some_frame(codec, KNOWN[name], random))
        goal = compared.craft.state().goal or 0
        goal = goal if random.random() < 0.8 else random.randrange(16)
        progress = {"Goal": goal, "State": random.choice(PROGRESS), "Distance": random.uniform(0.0, 600.0)}
        compared.hear(now, broken(codec.encode("Progress", **progress), random))
        request = compared.request
        if random.random() < 0.05:
            ended = compared.craft.state().devices.get(request, "REACHED") in ("REACHED", "FAILED")
            device = random.randrange(2) if ended else device
            compared.operate(device, random.randrange(256), random.uniform(-9000.0, 9000.0))
        if random.random() < 0.2:
            told = {
                "Device": device,
                "Request": random.choice([request, 7]),
                "State": random.choice(PROGRESS),
            }
            compared.hear(now, broken(codec.encode("DeviceStatus", **told), random))
        if tick > ticks * 0.9 and random.random() < 0.05:
            name = random.choice(list(EMERGENCIES))
            said = codec.encode(name, Reason=random.choice(REASONS), Release=True)
            compared.hear(now, broken(said, random))
        if tick > ticks * 0.8 and random.random() < 0.02:
            compared.give_up(random.choice(REASONS[1:]))
        compared.tick(now)
    return compared


def _order(compared: Compared, random: Random) -> None:
    """Give an order, one in a while beyond what messages hold."""
    heading = random.choice(
        [None, random.uniform(-1000.0, 1000.0), random.choice([-1e-20, 359.999, 360.0, -0.0])]
    )
    reach = random.choice([10.0, 8388.607, 8388.61])
    place = [random.uniform(-reach, reach) for _ in range(2)]
    depth = random.choice([0.0, random.uniform(0.0, compared.sheet.max_depth), 70000.0, -0.001])
    match random.choice(["go", "go", "go", "turn", "rest"]):
        case "go":
            mode = random.choice(["GO_TO", "SEARCH"])
            compared.go(
                mode, (*place, depth), heading, random.choice([0.0, 5.1, 5.12, random.uniform(0.0, 5.1)])
            )
        case "turn":
            compared.turn(heading or 0.0)
        case _:
            compared.rest(random.choice(["IDLE", "SURFACE"]))


def some_datagram(random: Random, time: float) -> bytes:
    """Return what a camera tells: of an object near its place, of one elsewhere, late, doubtful or broken."""
    number = random.randrange(len(OBJECTS))
    off = random.choice([0.2] * 5 + [0.8, 50.0, 9000.0])
    north, east, depth = (5.0 * number + random.gauss(0.0, off) for _ in range(3))
    time = max(0.0, time - random.choice([0.0] * 6 + [5.0, 100.0]))
    confidence = random.choice([0.9] * 6 + [0.5, 0.49, 1.01])
    camera = random.choice(CAMERAS)
    whose = random.choice(["", "", OWNER, OWNER, "Otter"])
    data = to_datagram(Detection(time, OBJECTS[number], confidence, north, east, depth, camera, whose))
    ways = ["cut", "text", "less", "other hand", "name", "camera", "robot"]
    match random.choice(["as it is"] * 8 + ways):
        case "other hand":
            tight = random.choice([(",", ":"), (" ,\t", " : ")])
            return json.dumps(json.loads(data), ensure_ascii=False, separators=tight).encode()
        case "name":
            named = json.dumps(json.loads(data)["name"]).encode()
            return data.replace(named, random.choice(NAMES))
        case "camera":
            return data.replace(f'"{camera}"'.encode(), b'"side"')
        case "robot":
            return json.dumps(json.loads(data) | {"robot": random.choice(["", 7, "a", None])}).encode()
        case "cut":
            return data[: random.randrange(1, len(data) - 1)]
        case "text":
            return data.replace(b'"depth": ', b'"depth": "deep", "deeper": ')
        case "less":
            return data.replace(b'"north": ', b'"south": ')
    return data
