"""The target can-c: what runs beside the motors of each vehicle's thrusters, in C.

It obeys the same commands as the drives of the simulated vehicle, frame by frame. What a robot does on its
mission makes no difference to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from auv_vessel.body.devices import patience_of, pressure_of_depth
from auv_vessel.body.thrust import MOST_AHEAD, curve_of
from auv_vessel.refusals import MOST_POWER
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import EMERGENCIES, STATUS_PERIOD, layout_of, messages_of
from mmrs_auv.names import VEHICLES
from mmrs_auv.sheets import is_vehicle, sheet_of
from mmrs_auv.targets.can_c.bus import codec_of
from mmrs_auv.targets.can_c.words import block, number
from mmrs_auv.targets.places import templates_of
from mmrs_core.behaviour.program import BEHAVIOUR, RobotProgram
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import MOVES, vehicleless

SHARED = "drives"
"""Folder of what the drives of all vehicles share."""

AS_THEY_ARE = ("drives.h", "drives.c", "outputs.h", "hub.c", "drives.mk")
ASKS = ("sets the thrust of each motor, reports its faults and the depth, and releases the drop weight",)
KNOWN = frozenset({*MOVES, (BEHAVIOUR, "Recharge")})
"""Moves in which thrusters only carry out commands."""

LONGEST = 2000.0
"""Seconds that drives measure, at most: their microseconds have 32 bits."""

CAPABILITIES = {
    "Behaviour.robots": "a folder each, beside what they share",
    "Robot: a sub": "a drive for each of its thrusters",
    "Robot.id": "name of the folder",
}


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield the files that all drives share, a folder for each robot, and the build file.

    Raises:
        UnsupportedError: a robot is not an underwater vehicle with known data.
    """
    robots = input.program.robots
    stems = file_stems([robot.id for robot in robots], hyphens=False)
    folders = {robot.id: f"drives_{stems[robot.id]}" for robot in robots}
    yield from files_of({folders[robot.id]: _sheet(robot, input) for robot in robots})
    shown = [
        {"folder": folder, "robot": id, "traced": TracedStep("drives", id, "")}
        for id, folder in folders.items()
    ]
    yield FileSpec("README.md", "README.md.jinja", {"robots": shown})


def files_of(sheets: Mapping[str, Sheet]) -> Iterator[FileSpec]:
    """Yield the drives of vehicles, by folder; those whose buses carry the same messages share a codec.

    Raises:
        SheetError: a bus cannot be made of the data of a vehicle; lists all that is wrong.
    """
    for file in AS_THEY_ARE:
        yield FileSpec(f"{SHARED}/{file}", file)
    buses: dict[tuple[str, str], str] = {}
    for folder, sheet in sheets.items():
        codec = codec_of(sheet)
        if codec not in buses:
            bus = buses[codec] = f"bus_{len(buses) + 1}" if buses else "bus"
            yield FileSpec(f"{bus}/bus.h", "", data=codec[0].encode())
            yield FileSpec(f"{bus}/bus.c", "", data=codec[1].encode())
        view, folders = _view(sheet), {"bus": buses[codec], "shared": SHARED}
        yield FileSpec(f"{folder}/vehicle.h", "vehicle.h.jinja", view)
        yield FileSpec(f"{folder}/vehicle.c", "vehicle.c.jinja", view)
        yield FileSpec(f"{folder}/Makefile", "Makefile.jinja", folders)
        yield FileSpec(f"{folder}/outputs.c", "outputs.c", once=True, asks=ASKS)


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield robots without thrusters on a bus, and unknown moves."""
    for robot in input.program.robots:
        if unknown := vehicleless(robot, input, VEHICLES):
            yield unknown
            continue
        try:
            _sheet(robot, input)
        except UnsupportedError as error:
            yield from (f"robot '{robot.id}': {each}" for each in error.elements or (str(error),))
        for move in robot.moves:
            if move.metaclasses[0] not in KNOWN:
                yield f"robot '{robot.id}', move '{move.id}': {move.kind} is not known to this target"


def _sheet(robot: RobotProgram, input: TargetInput) -> Sheet:
    type = input.types.get(robot.type_name)
    if type is None:
        why = f"type '{robot.type_name}' is not known"
        raise UnsupportedError(f"robot '{robot.id}': {why}", (why,))
    if unknown := vehicleless(robot, input, VEHICLES):
        raise UnsupportedError(unknown)
    if not is_vehicle(type):
        why = "is not an underwater vehicle"
        raise UnsupportedError(f"robot '{robot.id}': {why}", (why,))
    density = input.environment.get("waterDensity")
    return sheet_of(type, robot.id, payload=robot.payload, density=density)


def _view(sheet: Sheet) -> dict[str, object]:
    layouts = {message.name: layout_of(message) for message in messages_of(sheet)}
    thrusters = []
    for index, thruster in enumerate(sheet.thrusters):
        watts, newtons, exponent = curve_of(thruster)
        thrust = layouts[f"Thruster{index}Command"].slots["Thrust"]
        thrusters.append(
            {
                "number": index,
                "id": thruster.id,
                "low": thrust.low,
                "high": thrust.high,
                "most": float(thruster.max_thrust),
                "watts": float(watts),
                "newtons": float(newtons),
                "exponent": float(exponent),
            }
        )
    return {
        "robot": sheet.robot,
        "watchdog": _microseconds(sheet.watchdog, "watchdog"),
        "dead_man": _microseconds(patience_of(sheet), "deadman.time"),
        "deep": pressure_of_depth(sheet),
        "most_power": MOST_POWER,
        "most_ahead": MOST_AHEAD,
        "status_period": _microseconds(STATUS_PERIOD, "status"),
        "emergencies": len(EMERGENCIES),
        "thrusters": thrusters,
    }


def _microseconds(seconds: float, what: str) -> int:
    if seconds > LONGEST:
        why = f"{what}: {seconds:g} s is more than {LONGEST:g} s, which the drives' counter of 32 bits holds"
        raise UnsupportedError(why, (why,))
    return int(seconds * 1e6 + 1e-3)


CAN_C = Target(
    name="can-c",
    description="drives of the thrusters of underwater vehicles on CAN buses, in C11",
    templates=templates_of("can-c"),
    files=files,
    refusals=refusals,
    filters={"block": block, "c": number},
    capabilities=CAPABILITIES,
    tried_with="water",
)
