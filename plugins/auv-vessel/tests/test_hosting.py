import queue
import threading
import time
from collections import deque
from collections.abc import Sequence

import pytest
from sample_vessels import pool_sheet

from auv_vessel import hosting
from auv_vessel.control.actuators import Actuators
from auv_vessel.hosting import LAG, SEEN_BASE, Awake, Rehearsal, WireFault, clock_frame, clock_time, serve
from auv_vessel.instruments import instruments_of
from auv_vessel.wire.catalogue import EMERGENCIES
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame


class Talker:
    """Says its identifiers at every tick, and keeps what it heard."""

    def __init__(self, name: str, ids: Sequence[int], period: float = 0.1) -> None:
        self.name, self.ids, self.period = name, ids, period
        self.heard: list[tuple[float, int]] = []
        self.frames: list[Frame] = []
        self.ticks: list[float] = []

    def hear(self, frame: Frame, now: float) -> None:
        self.heard.append((now, frame.id))
        self.frames.append(frame)

    def tick(self, now: float) -> list[Frame]:
        self.ticks.append(now)
        return [Frame(each, bytes((each & 0xFF, len(self.ticks) & 0xFF))) for each in self.ids]


class Wire:
    """A port with what a test puts into it."""

    def __init__(self, frames: Sequence[Frame] = ()) -> None:
        self.sent: list[Frame] = []
        self._frames: queue.Queue[Frame] = queue.Queue()
        for frame in frames:
            self._frames.put(frame)

    def send(self, frame: Frame) -> None:
        self.sent.append(frame)

    def receive(self, timeout: float) -> Frame | None:
        try:
            return self._frames.get(timeout=timeout) if timeout > 0.0 else self._frames.get_nowait()
        except queue.Empty:
            return None


def test_frames_of_a_tick_arrive_in_the_order_of_the_bus() -> None:
    low, high, listener = Talker("low", (9, 2)), Talker("high", (5, 1)), Talker("listener", ())
    Rehearsal([low, high, listener]).run(0.0)
    assert listener.heard == [(0.0, 1), (0.0, 2), (0.0, 5), (0.0, 9)]
    assert low.heard == [(0.0, 1), (0.0, 5)]


def test_each_node_ticks_at_its_own_period_without_drift() -> None:
    fast, slow = Talker("fast", (), 0.01), Talker("slow", (), 0.05)
    rehearsal = Rehearsal([fast, slow])
    for _ in range(10):
        rehearsal.run(0.1)
    assert len(fast.ticks) == 101
    assert slow.ticks == pytest.approx([0.05 * number for number in range(21)])
    assert rehearsal.now == pytest.approx(1.0)


def test_a_killed_node_neither_hears_nor_speaks_until_revived() -> None:
    talker, listener = Talker("talker", (7,)), Talker("listener", (8,))
    rehearsal = Rehearsal([talker, listener])
    rehearsal.run(0.05)
    rehearsal.kill("talker")
    rehearsal.run(0.5)
    assert len(listener.heard) == len(talker.heard) == 1
    rehearsal.revive("talker")
    rehearsal.run(0.1)
    assert len(listener.heard) == len(talker.heard) == 2


def test_what_is_posted_and_what_joins_later_takes_part() -> None:
    listener = Talker("listener", ())
    rehearsal = Rehearsal([listener])
    rehearsal.post(Frame(3, b""))
    rehearsal.run(0.05)
    rehearsal.add(Talker("late", (4,)))
    rehearsal.run(0.1)
    assert listener.heard == [(0.0, 3), (0.05, 4), (pytest.approx(0.15), 4)]


def test_a_lossy_bus_loses_its_part_the_same_each_time() -> None:
    def heard() -> list[tuple[float, int]]:
        listener = Talker("listener", ())
        fault = WireFault(loss=0.3, ids=frozenset({7}), begin=1.0, end=101.0, seed=3)
        Rehearsal([Talker("talker", (7, 8)), listener], [fault]).run(101.0)
        return listener.heard

    first = heard()
    assert first == heard()
    assert sum(each == 8 for _, each in first) == 1011
    assert 0.62 < sum(each == 7 for _, each in first) / 1011 < 0.78


def test_a_corrupting_bus_changes_one_to_three_bits() -> None:
    talker, listener, watched = Talker("talker", (7,)), Talker("listener", ()), []
    rehearsal = Rehearsal(
        [talker, listener], [WireFault(corruption=1.0)], lambda now, frame: watched.append(frame)
    )
    rehearsal.run(2.0)
    for sent, arrived in zip(watched, listener.frames, strict=True):
        wrong = int.from_bytes(sent.data, "big") ^ int.from_bytes(arrived.data, "big")
        assert 1 <= wrong.bit_count() <= 3


def test_a_fault_of_one_sender_leaves_the_others_alone() -> None:
    listener = Talker("listener", ())
    Rehearsal([Talker("a", (1,)), Talker("b", (2,)), listener], [WireFault(loss=1.0, sender="a")]).run(1.0)
    assert {each for _, each in listener.heard} == {2}


@pytest.mark.parametrize("now", [0.0, 0.01, 12345.678])
def test_time_told_on_the_bus_is_time_heard(now: float) -> None:
    assert clock_time(clock_frame(now)) == pytest.approx(now)


def test_time_is_told_as_the_database_says() -> None:
    sheet = pool_sheet()
    heard = Codec(sheet).decode(clock_frame(12.345, 300))
    assert heard is not None
    assert (heard.values["Time"], heard.sequence) == (pytest.approx(12.345), 44)


def test_other_frames_tell_no_time() -> None:
    told = clock_frame(5.0)
    assert clock_time(Frame(2, told.data)) is None
    assert clock_time(Frame(1, told.data[:-1])) is None


def test_a_wrong_bit_does_not_make_time_jump() -> None:
    told = clock_frame(5.0, 7)
    number = int.from_bytes(told.data, "little")
    for bit in range(8 * len(told.data)):
        assert clock_time(Frame(told.id, (number ^ 1 << bit).to_bytes(6, "little"))) is None


def test_a_node_by_the_bus_ticks_when_it_is_told_so() -> None:
    stop, node = threading.Event(), Talker("Sensors", (7,), 0.05)
    wire = Wire([clock_frame(number * 0.01) for number in range(21)])
    host = threading.Thread(target=serve, args=(node, wire, "bus", stop))
    host.start()
    while len(node.ticks) < 5:
        stop.wait(0.01)
    stop.set()
    host.join(5.0)
    assert node.ticks == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])
    assert [frame.id for frame in wire.sent if not frame.extended] == [7] * 5


def test_who_leads_tells_time_before_each_tick_and_goes_faster_than_real_time() -> None:
    stop, node, wire = threading.Event(), Talker("node", (7,), 0.1), Wire([Frame(9, b"")])
    host = threading.Thread(target=serve, args=(node, wire, "lead", stop), kwargs={"speedup": 50.0})
    host.start()
    while len(node.ticks) < 20:
        stop.wait(0.01)
    stop.set()
    host.join(5.0)
    told = [clock_time(frame) for frame in wire.sent if frame.id == 1]
    assert told[:20] == pytest.approx([0.1 * number for number in range(20)])
    assert node.heard[0][1] == 9


class Follower(Wire):
    """A port to whom leads; another host follows time with a delay of so many ticks, and dies at one."""

    def __init__(self, behind: int, dies: int) -> None:
        super().__init__()
        self._behind, self._dies = behind, dies
        self._told: list[Frame] = []
        self._said = 0

    def send(self, frame: Frame) -> None:
        super().send(frame)
        if frame.id == 1 and len(self._told) < self._dies:
            self._told.append(frame)

    def receive(self, timeout: float) -> Frame | None:
        if self._said < len(self._told) - self._behind:
            self._said += 1
            return Frame(SEEN_BASE + 1, self._told[self._said - 1].data, True)
        return super().receive(timeout)


@pytest.mark.parametrize(("behind", "least", "most"), [(0, 30, 2000), (LAG + 1, 3, 8)])
def test_time_waits_for_who_follows_it(behind: int, least: int, most: int) -> None:
    stop, node = threading.Event(), Talker("Vehicle", (), 0.05)
    wire = Follower(behind, 10_000)
    host = threading.Thread(target=serve, args=(node, wire, "lead", stop), kwargs={"speedup": 100.0})
    host.start()
    stop.wait(0.6)
    stop.set()
    host.join(5.0)
    assert least <= len(node.ticks) <= most


def test_time_goes_on_without_who_is_gone() -> None:
    stop, node = threading.Event(), Talker("Vehicle", (), 0.05)
    host = threading.Thread(
        target=serve, args=(node, Follower(0, 5), "lead", stop), kwargs={"speedup": 100.0}
    )
    host.start()
    while len(node.ticks) < 50:
        stop.wait(0.05)
    stop.set()
    host.join(5.0)
    assert node.ticks[-1] == pytest.approx(0.05 * (len(node.ticks) - 1))


def test_a_node_in_real_time_ticks_at_its_period() -> None:
    stop, node, late = threading.Event(), Talker("node", (), 0.02), list[float]()
    host = threading.Thread(target=serve, args=(node, Wire(), "real", stop), kwargs={"late": late.append})
    host.start()
    while len(node.ticks) < 10:
        stop.wait(0.01)
    stop.set()
    host.join(5.0)
    assert node.ticks[-1] == pytest.approx(0.02 * (len(node.ticks) - 1), abs=1.0)
    assert len(late) == len(node.ticks)
    assert min(late) >= 0.0


def test_a_sheet_may_say_how_good_its_instruments_are() -> None:
    assert instruments_of(pool_sheet(**{"heading.bias": 3.0})).heading_bias == 3.0
    with pytest.raises(ValueError, match=r"heading\.bias is -1"):
        instruments_of(pool_sheet(**{"heading.bias": -1.0}))


def test_who_goes_by_the_bus_ends_when_nobody_tells_the_time_any_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(hosting, "CLOCK_SILENT", 0.3)
    node = Talker("node", ())
    wire = Wire([clock_frame(0.0), clock_frame(0.1)])
    with pytest.raises(hosting.ClockSilentError, match=r"no time received for 0\.3 s"):
        serve(node, wire, "bus")
    assert node.ticks == [0.0, 0.1]


def test_a_node_speaks_in_time_however_much_others_say() -> None:
    class Flood(Wire):
        def receive(self, timeout: float) -> Frame | None:
            return Frame(0x123, b"")

    node, wire, stop = Talker("node", (7,), 0.02), Flood(), threading.Event()
    host = threading.Thread(target=serve, args=(node, wire, "real", stop), daemon=True)
    host.start()
    given_up = time.monotonic() + 20.0
    while len(wire.sent) <= 10 and time.monotonic() < given_up:
        time.sleep(0.05)
    stop.set()
    host.join(5.0)
    assert not host.is_alive()
    assert len(wire.sent) > 10


def test_a_clock_that_leaves_out_stalls_counts_what_a_node_can_catch_up_with() -> None:
    real = iter([10.0, 10.05, 10.25, 10.95, 11.0])
    awake = Awake(0.25, lambda: next(real))
    assert [awake.now() for _ in range(4)] == pytest.approx([0.05, 0.25, 0.5, 0.55])
    assert awake.stalled == pytest.approx(0.45)


class Stalling(Wire):
    """A port, and its clock, of a process that is commanded all the time and was stalled once."""

    def __init__(self, seconds: float, stop: threading.Event) -> None:
        super().__init__()
        self.now, self.left, self._seconds, self._stop = 0.0, seconds, seconds, stop
        self._codec, self._said, self._waiting = Codec(pool_sheet()), 0, deque[Frame]()

    def clock(self) -> float:
        self.now += 0.0001
        return self.now

    def receive(self, timeout: float) -> Frame | None:
        if self._waiting:
            return self._waiting.popleft()
        if self.now >= self._said * 0.05:
            self._said += 1
            self._waiting.extend(self._words())
            return self._waiting.popleft()
        if timeout > 0.0:
            self.now += timeout
            if self.now > 2.0 and self.left:
                self.now, self.left = self.now + self.left, 0.0
        if self.now > 4.0 + self._seconds:
            self._stop.set()
        return None

    def _words(self) -> list[Frame]:
        encode = self._codec.encode
        return [
            encode("Depth", Depth=2.0, Uncertainty=0.1, Trusted=True),
            encode("WrenchForce", Surge=5.0, Sway=0.0, Heave=0.0, Enable=True),
            encode("WrenchMoment", Roll=0.0, Pitch=0.0, Yaw=0.0),
        ]


@pytest.mark.parametrize("seconds", [0.7, 3.0, 60.0])
def test_a_process_that_was_stalled_does_not_take_that_for_silence_of_others(
    seconds: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    actuators, stop = Actuators(pool_sheet(), Codec(pool_sheet())), threading.Event()
    wire = Stalling(seconds, stop)
    monkeypatch.setattr("time.monotonic", wire.clock)
    serve(actuators, wire, "real", stop)
    monkeypatch.undo()
    assert wire.left == 0.0
    assert actuators.emergency is None
    assert not {frame.id for frame in wire.sent} & set(EMERGENCIES.values())
    assert max(map(abs, actuators.thrusts)) > 1.0


class Timed(Wire):
    """A port, and its clock: time goes by only while it waits, and ends at some second."""

    def __init__(self, frames: Sequence[Frame], end: float, stop: threading.Event) -> None:
        super().__init__(frames)
        self.now, self._end, self._stop = 0.0, end, stop

    def receive(self, timeout: float) -> Frame | None:
        if (frame := super().receive(0.0)) is None:
            self.now += timeout
            if self.now > self._end:
                self._stop.set()
        return frame


def test_a_host_says_which_message_has_two_senders(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    node, stop = Talker("Movement", (), 0.02), threading.Event()
    codec = Codec(pool_sheet())
    said = [codec.encode("WrenchForce", Surge=0.0, Sway=0.0, Heave=0.0, Enable=False) for _ in range(4)]
    wire = Timed(said, 0.29, stop)
    monkeypatch.setattr("time.monotonic", lambda: wire.now)
    serve(node, wire, "real", stop, say=told.append)
    monkeypatch.undo()
    assert told == [
        "another node says WrenchForce (0x080), which only this one is to say: the dive is given up"
    ]
    assert len([each for each in wire.sent if each.id == EMERGENCIES["MovementEmergency"]]) == 3
    assert set(EMERGENCIES.values()) & {id for _, id in node.heard}
