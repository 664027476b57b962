"""A vehicle whose thrusters speak DroneCAN goes where it is to go, and stops when it is to stop."""

import subprocess
from collections.abc import Sequence
from math import copysign, dist, sqrt
from pathlib import Path

import dronecan
import pytest
from can_hub import Raw, running
from dronecan.transport import Frame as Part
from dronecan.transport import Transfer, TransferManager
from mmrs_dronecan.transfers import Outgoing
from sample_vessels import pool_sheet
from warm_python import python

from auv_vessel.api import Craft
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.drives import drives_of
from auv_vessel.control.sensors import Sensors
from auv_vessel.hosting import Rehearsal
from auv_vessel.movement.movement import Movement
from auv_vessel.sheet import Sheet, to_json
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame

pytestmark = pytest.mark.real_time("vessels")

HIGHEST = 3000.0
DRIVES = f"mmrs_dronecan.speed_controllers:opened,node=7,max-rpm={HIGHEST:g}"


class DroneCanVehicle:
    """A vehicle whose drives are electronic speed controllers; the messages are the package's own work."""

    name = Vehicle.name
    period = Vehicle.period

    def __init__(self, sheet: Sheet) -> None:
        self.vehicle = Vehicle(sheet, Codec(sheet), Surroundings(current=(0.1, 0.0), bottom=20.0), 1)
        self.armed = False
        self.silent: set[int] = set()
        self._sheet = sheet
        self._said = Codec(sheet)
        self._heard = Codec(sheet)
        self._manager = TransferManager()
        self._transfers = 0

    def hear(self, frame: Frame, now: float) -> None:
        if not frame.extended:
            self.vehicle.hear(frame, now)
            return
        parts = self._manager.receive_frame(Part(frame.id, frame.data))
        if parts is None:
            return
        transfer = Transfer()
        transfer.from_frames(parts)
        if transfer.data_type_id == 1100:
            self.armed = transfer.payload.status == 255
        if transfer.data_type_id == 1030:
            for number, raw in enumerate(transfer.payload.cmd):
                part = int(raw) / (8191 if raw > 0 else 8192)
                thrust = self._sheet.thrusters[number].max_thrust * part * abs(part)
                command = self._said.encode(f"Thruster{number}Command", Thrust=thrust, Enable=self.armed)
                self.vehicle.hear(command, now)

    def tick(self, now: float) -> Sequence[Frame]:
        frames = []
        for frame in self.vehicle.tick(now):
            said = self._heard.decode(frame)
            if said is None or not said.name.startswith("Thruster"):
                frames.append(frame)
                continue
            number = frame.id - 0x140
            if number in self.silent:
                continue
            part = float(said.values["Thrust"]) / self._sheet.thrusters[number].max_thrust
            frames += self._status(number, round(copysign(sqrt(abs(part)), part) * HIGHEST))
        return frames

    def _status(self, number: int, rpm: int) -> list[Frame]:
        status = dronecan.uavcan.equipment.esc.Status(
            error_count=0,
            voltage=14.8,
            current=1.0,
            temperature=290.0,
            rpm=rpm,
            power_rating_pct=0,
            esc_index=number,
        )
        self._transfers += 1
        transfer = Transfer(transfer_id=self._transfers % 32, source_node_id=40 + number, payload=status)
        return [Frame(part.message_id, bytes(part.bytes), True) for part in transfer.to_frames()]


def rig() -> tuple[Rehearsal, DroneCanVehicle, Craft, Actuators, list[tuple[float, Frame]]]:
    sheet = pool_sheet()
    body, craft = DroneCanVehicle(sheet), Craft(sheet, Codec(sheet))
    actuators = Actuators(sheet, Codec(sheet), drives_of(DRIVES, sheet))
    heard: list[tuple[float, Frame]] = []
    nodes = [body, Sensors(sheet, Codec(sheet)), actuators, Movement(sheet, Codec(sheet)), craft]
    return (
        Rehearsal(nodes, watch=lambda now, frame: heard.append((now, frame))),
        body,
        craft,
        actuators,
        heard,
    )


def test_it_goes_to_a_place_and_no_drive_hears_a_message_of_the_catalogue() -> None:
    run, body, craft, actuators, heard = rig()
    run.run(2.0)
    craft.go_to(3.0, 1.0, 2.0)
    run.run(25.0)
    truth = body.vehicle.truth
    assert craft.state().progress == "REACHED"
    assert dist((truth.north, truth.east, truth.depth), (3.0, 1.0, 2.0)) < 1.0
    assert all(actuators._watch.working)
    assert not [frame for _, frame in heard if not frame.extended and 0x100 <= frame.id < 0x180]


def test_commands_stop_with_the_movement_node() -> None:
    run, body, craft, _, heard = rig()
    run.run(2.0)
    craft.go_to(20.0, 0.0, 2.0)
    run.run(5.0)
    assert max(abs(each) for each in body.vehicle.truth.thrusts) > 1.0
    run.kill("Movement")
    killed = run.now
    run.run(1.0)
    raws = [
        frame
        for now, frame in heard
        if frame.extended and frame.id >> 8 & 0xFFFF == 1030 and now > killed + 0.4
    ]
    assert raws
    assert all(
        frame.data[:-1].strip(b"\0") in (b"", frame.data[:2]) for frame in raws
    )  # zeros but for the check
    assert all(drive.thrust == 0.0 for drive in body.vehicle.drives)


def test_a_thruster_that_does_not_turn_is_found_out() -> None:
    run, body, craft, actuators, _ = rig()
    body.vehicle.faults.dead |= {2}
    run.run(2.0)
    craft.go_to(3.0, 1.0, 2.0)
    run.run(10.0)
    assert actuators._watch.working == [number != 2 for number in range(6)]


def test_a_drive_that_falls_silent_is_done_without() -> None:
    run, body, craft, actuators, _ = rig()
    run.run(2.0)
    craft.go_to(2.0, 0.5, 1.0)
    run.run(1.0)
    body.silent = {1}
    run.run(12.0)
    assert actuators._watch.working == [number != 1 for number in range(6)]
    assert actuators.thrusts[1] == 0.0
    assert craft.state().progress == "REACHED"


def test_when_all_drives_fall_silent_the_dive_is_given_up() -> None:
    run, body, craft, actuators, _ = rig()
    run.run(2.0)
    craft.go_to(20.0, 0.0, 2.0)
    run.run(5.0)
    body.silent = set(range(6))
    run.run(2.0)
    assert actuators.emergency == "THRUSTER_FAULT"
    assert all(drive.thrust == 0.0 for drive in body.vehicle.drives)


class Commander:
    """Another node that commands drives."""

    name, period = "Commander", 0.1

    def __init__(self, node: int) -> None:
        self._says = Outgoing(node)

    def hear(self, frame: Frame, now: float) -> None:
        """Hear nothing."""

    def tick(self, now: float) -> list[Frame]:
        said = self._says.frames(dronecan.uavcan.equipment.esc.RawCommand(cmd=[4000] * 6))
        return [Frame(each.id, each.data, True) for each in said]


@pytest.mark.parametrize("node", [7, 99], ids=["of the same number", "of another"])
def test_a_second_commander_ends_the_dive(node: int) -> None:
    run, body, craft, actuators, _ = rig()
    run.run(2.0)
    craft.go_to(20.0, 0.0, 2.0)
    run.run(5.0)
    run.add(Commander(node))
    run.run(2.5)
    assert actuators.emergency is not None
    assert not body.armed
    assert all(drive.thrust == 0.0 for drive in body.vehicle.drives)


def test_the_process_of_the_actuator_controller_takes_drives_by_name(tmp_path: Path) -> None:
    file = tmp_path / "sheet.json"
    file.write_text(to_json(pool_sheet()))
    with running() as hub, Raw(hub.port) as heard:
        words = [
            "actuators",
            "--sheet",
            str(file),
            "--channel",
            f"can0@127.0.0.1:{hub.port}",
            "--drives",
            DRIVES,
        ]
        process = subprocess.Popen([python(), "-m", "auv_vessel", *words], stderr=subprocess.PIPE)
        try:
            ids = {heard.word().split()[2] for _ in range(40)}
        finally:
            process.terminate()
            _, told = process.communicate(timeout=20)
    assert process.returncode == 0, told
    assert "08040607" in ids  # RawCommand of node 7
    assert not {each for each in ids if len(each) == 3 and each.startswith("1")}


def test_a_process_with_drives_that_are_none_says_so(tmp_path: Path) -> None:
    file = tmp_path / "sheet.json"
    file.write_text(to_json(pool_sheet()))
    words = ["actuators", "--sheet", str(file), "--interface", "virtual", "--drives", "no.such:thing"]
    done = subprocess.run([python(), "-m", "auv_vessel", *words], capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr == "actuators: drives no.such:thing: No module named 'no'\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mmrs_dronecan", "expected MODULE:FUNCTION"),
        ("mmrs_dronecan.speed_controllers:opened,node", "expected MODULE:FUNCTION"),
        ("mmrs_dronecan.speed_controllers:opened,node=0", "node '0' is not 1 to 127"),
        ("mmrs_dronecan.speed_controllers:nothing", "nothing"),
        ("no.such:thing", "No module named 'no'"),
    ],
)
def test_drives_that_are_none(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        drives_of(text, pool_sheet())
