"""Thrust to DroneCAN's messages and back, with the package's own transport as the other side."""

from dataclasses import dataclass
from typing import Any

import dronecan
import pytest
from counts import many
from dronecan.transport import Frame as Part
from dronecan.transport import Transfer, TransferManager
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mmrs_dronecan import speed_controllers
from mmrs_dronecan.speed_controllers import Options, SpeedControllers, options_of
from mmrs_dronecan.transfers import Incoming, Outgoing

from auv_vessel.sheet import Thruster
from auv_vessel.wire.frame import Frame

Esc = dronecan.uavcan.equipment.esc


def thrusters(count: int, most: float = 50.0) -> list[Thruster]:
    still, ahead = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    return [
        Thruster(f"T{number}", still, ahead, most * 0.8, most, 100.0, 200.0, 50.0) for number in range(count)
    ]


def opened(count: int, **options: str) -> Any:
    return speed_controllers.opened(thrusters(count), options)


def heard(frames: list[Frame]) -> list[Transfer]:
    """Return the messages that a node of the package makes of frames."""
    manager, found = TransferManager(), []
    for frame in frames:
        assert frame.extended
        assert len(frame.data) <= 8
        parts = manager.receive_frame(Part(frame.id, frame.data))
        if parts is not None:
            transfer = Transfer()
            transfer.from_frames(parts)
            found.append(transfer)
    return found


def command(frames: list[Frame]) -> list[int]:
    (found,) = [each.payload for each in heard(frames) if each.data_type_id == 1030]
    return list(found.cmd)


def status(index: int, rpm: int, node: int = 42, number: int = 0) -> list[Frame]:
    said = Esc.Status(
        error_count=3,
        voltage=14.8,
        current=2.0,
        temperature=300.0,
        rpm=rpm,
        power_rating_pct=20,
        esc_index=index,
    )
    transfer = Transfer(transfer_id=number % 32, source_node_id=node, payload=said, transfer_priority=16)
    return [Frame(part.message_id, bytes(part.bytes), extended=True) for part in transfer.to_frames()]


@pytest.mark.parametrize("count", [0, 1, 4, 5, 6, 20])
def test_all_thrusters_are_told_in_one_message(count: int) -> None:
    driver = opened(count, curve="linear")
    assert command(driver.commands([50.0] * count, True)) == [8191] * count
    assert command(driver.commands([-50.0] * count, True)) == [-8192] * count
    assert command(driver.commands([25.0] * count, False)) == [0] * count


@given(st.lists(st.floats(-60.0, 60.0), min_size=6, max_size=6), st.booleans())
@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_commands_are_in_range_and_keep_sign_and_order(asked: list[float], square: bool) -> None:
    found = command(SpeedControllers(thrusters(6), Options(square=square)).commands(asked, True))
    assert all(-8192 <= each <= 8191 for each in found)
    assert all(each * thrust >= 0 for each, thrust in zip(found, asked, strict=True))
    for first, one in zip(asked, found, strict=True):
        assert all(first <= second or one >= two for second, two in zip(asked, found, strict=True))
    part = [each / (8191 if each > 0 else 8192) for each in found]
    for thrust, each in zip(asked, part, strict=True):
        expected = max(-1.0, min(1.0, thrust / 50.0))
        assert (each * abs(each) if square else each) == pytest.approx(expected, abs=2e-4)


def test_transfer_identifiers_count_on_by_themselves() -> None:
    driver = opened(6)
    found = [each for _ in range(70) for each in heard(driver.commands([0.0] * 6, True))]
    for type_id in (1030, 341, 1100):
        numbers = [each.transfer_id for each in found if each.data_type_id == type_id]
        assert numbers == [number % 32 for number in range(len(numbers))]
    assert {each.source_node_id for each in found} == {10}


def test_once_a_second_it_says_that_it_is_there_and_that_drives_may_turn() -> None:
    driver = opened(2)
    said = [[each.data_type_id for each in heard(driver.commands([0.0] * 2, True))] for _ in range(40)]
    assert said == [[1030, 341, 1100], *[[1030]] * 19] * 2
    driver.commands([0.0] * 2, True)
    (_, disarmed) = heard(driver.commands([0.0] * 2, False))
    assert (disarmed.data_type_id, disarmed.payload.status) == (1100, 0)


def test_arming_may_be_left_to_others() -> None:
    driver = opened(2, arming="no")
    assert all(
        each.data_type_id != 1100 for _ in range(30) for each in heard(driver.commands([0.0] * 2, True))
    )


def test_a_status_is_put_together_and_tells_thrust_by_rotation() -> None:
    driver = opened(6, **{"max-rpm": "3000"})
    assert [driver.hear(frame) for frame in status(2, -1500)[:-1]] == [None, None]
    found = driver.hear(status(2, -1500)[-1])
    assert found is not None
    assert (found.number, found.thrust, found.fault, found.runs) == (2, -12.5, False, True)


def test_without_a_highest_rotation_thrust_is_not_told() -> None:
    driver = opened(6)
    found = [driver.hear(frame) for frame in status(5, 1500)][-1]
    assert found is not None
    assert (found.number, found.thrust) == (5, None)


def test_a_drive_of_another_vehicle_is_not_ours() -> None:
    driver = opened(2)
    assert [driver.hear(frame) for frame in status(2, 1500)] == [None, None, None]


def test_statuses_of_several_nodes_may_be_mixed() -> None:
    driver = opened(6, **{"max-rpm": "1000"})
    mixed = [
        frame
        for frames in zip(*(status(node, 1000, node + 40) for node in range(6)), strict=True)
        for frame in frames
    ]
    found = [each.number for frame in mixed if (each := driver.hear(frame)) is not None]
    assert found == list(range(6))
    assert driver.faults == 0


@pytest.mark.parametrize("missing", [0, 1, 2])
def test_a_lost_frame_spoils_one_status_only(missing: int) -> None:
    driver = opened(6)
    frames = [frame for number in range(3) for frame in status(1, 100, number=number)]
    del frames[3 + missing]
    assert sum(driver.hear(frame) is not None for frame in frames) == 2
    assert driver.faults >= 1


def test_a_frame_that_comes_twice_spoils_no_more_than_its_status() -> None:
    for twice in range(3):
        driver = opened(6)
        frames = status(1, 100)
        frames.insert(twice, frames[twice])
        told = [
            each for frame in frames + status(1, 200, number=1) if (each := driver.hear(frame)) is not None
        ]
        assert 1 <= len(told) <= 2
        assert all(each.number == 1 for each in told)


def test_every_wrong_bit_of_a_status_is_noticed() -> None:
    frames = status(1, 100)
    for place, frame in enumerate(frames):
        for bit in range(8 * (len(frame.data) - 1)):
            wrong = int.from_bytes(frame.data, "little") ^ 1 << bit
            changed = [*frames]
            changed[place] = Frame(frame.id, wrong.to_bytes(len(frame.data), "little"), extended=True)
            driver = opened_fast(6)
            assert [driver.hear(each) for each in changed] == [None, None, None]
            assert driver.faults == 1


def opened_fast(count: int) -> SpeedControllers:
    return SpeedControllers(thrusters(count), Options())


@dataclass(frozen=True)
class Any29:
    id: int
    data: bytes
    extended: bool = True


@given(
    st.lists(
        st.builds(
            Any29,
            st.sampled_from([0x1004_0A2A, 0x1004_0A2B, 0x0000_0A2A, 0x10040A00, 0x10040AFF]),
            st.binary(max_size=8),
            st.booleans(),
        ),
        max_size=40,
    )
)
@settings(max_examples=many(2000, fast=60), deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_anything_at_all_is_heard_without_an_error(frames: list[Any29]) -> None:
    driver = opened_fast(6)
    for frame in frames:
        driver.hear(frame)
    assert all(len(parts) <= 64 for parts in driver._statuses._parts.values())


def test_a_message_without_end_is_forgotten() -> None:
    incoming = Incoming(1034)
    id = status(0, 0)[0].id
    incoming.message(Frame(id, bytes(7) + b"\x80", extended=True))
    for number in range(1, 500):
        assert incoming.message(Frame(id, bytes(7) + bytes((0x20 * (number % 2),)), extended=True)) is None
    assert len(incoming._parts[id & 0x7F]) <= 64


@pytest.mark.parametrize(
    "options",
    [
        {"node": "0"},
        {"node": "128"},
        {"node": "x"},
        {"node": "١"},
        {"curve": "cubic"},
        {"max-rpm": "0"},
        {"max-rpm": "nan"},
        {"arming": "maybe"},
        {"nod": "1"},
    ],
)
def test_options_that_are_none(options: dict[str, str]) -> None:
    with pytest.raises(ValueError, match=next(iter(options))):
        options_of(options)


def test_more_thrusters_than_a_message_carries() -> None:
    with pytest.raises(ValueError, match="21 thrusters: a RawCommand carries 20"):
        opened(21)


def test_messages_of_others_are_let_by() -> None:
    driver = opened_fast(6)
    other = Outgoing(42).frames(dronecan.uavcan.protocol.NodeStatus(uptime_sec=1))
    assert [driver.hear(frame) for frame in other] == [None]
    assert driver.hear(Any29(0x140, b"\1\2", extended=False)) is None
    assert driver.faults == 0


def told(driver: SpeedControllers, frames: list[Frame]) -> list[tuple[int, bool]]:
    return [(each.number, each.fault) for frame in frames if (each := driver.hear(frame)) is not None]


def commands_of(node: int, count: int) -> list[Frame]:
    other = Outgoing(node)
    return [frame for _ in range(count) for frame in other.frames(Esc.RawCommand(cmd=[0, 0, 0, 0]))]


@pytest.mark.parametrize("health", ["critical", "offline"])
def test_a_drive_whose_node_says_that_it_cannot_work_is_faulty_till_it_can(health: str) -> None:
    driver, node = opened_fast(6), Outgoing(42)
    said = {"critical": {"health": 3}, "offline": {"mode": 7}}[health]
    assert told(driver, status(2, 100)) == [(2, False)]
    assert told(driver, node.frames(dronecan.uavcan.protocol.NodeStatus(**said))) == []
    assert told(driver, status(2, 100, number=1)) == [(2, True)]
    assert told(driver, status(3, 100, node=43)) == [(3, False)]
    assert told(driver, node.frames(dronecan.uavcan.protocol.NodeStatus(health=1))) == []
    assert told(driver, status(2, 100, number=2)) == [(2, False)]


def test_a_drive_that_two_nodes_are_is_not_used(caplog: pytest.LogCaptureFixture) -> None:
    driver = opened_fast(6)
    found = [told(driver, status(2, 100, node=41 + turn % 2, number=turn)) for turn in range(5)]
    assert found == [[(2, False)]] * 3 + [[(2, True)]] * 2
    assert told(driver, status(3, 100, node=41, number=9)) == [(3, False)]
    assert [each.message for each in caplog.records] == ["drive 2 is said by nodes [41, 42]: it is not used"]


def test_a_drive_that_was_exchanged_is_used() -> None:
    driver = opened_fast(6)
    nodes = [41] * 4 + [42] * 4
    found = [told(driver, status(2, 100, node=node, number=turn)) for turn, node in enumerate(nodes)]
    assert found == [[(2, False)]] * 8


@pytest.mark.parametrize(
    ("strange", "said"),
    [
        (lambda: commands_of(11, 3), "node 11 commands the drives, too: no thrust any more"),
        (
            lambda: Outgoing(10).frames(dronecan.uavcan.protocol.NodeStatus()) * 3,
            "another node has the identifier 10 of this one: no thrust any more",
        ),
    ],
)
def test_when_somebody_else_commands_there_is_no_thrust_any_more(
    strange: Any, said: str, caplog: pytest.LogCaptureFixture
) -> None:
    driver = opened_fast(4)
    driver.commands([30.0] * 4, True)
    assert command(driver.commands([30.0] * 4, True)) != [0] * 4
    found = told(driver, strange())
    assert [each.message for each in caplog.records] == [said]
    frames = driver.commands([30.0] * 4, True)
    assert command(frames) == [0] * 4
    assert [each.payload.status for each in heard(frames) if each.data_type_id == 1100] == [0]
    found += told(driver, status(0, 100) + status(1, 100, number=1))
    assert {number for number, _ in found} == {0, 1, 2, 3}
    assert all(fault for _, fault in found)
