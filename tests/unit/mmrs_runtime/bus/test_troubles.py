"""An end of the bus goes on whatever goes wrong there, and tells people."""

import pytest
from hub import Hub, HubCarrier

from mmrs_runtime.bus import CommandId, Member, Node, Owned

RUN = "run-0"


class Disk:
    """A journal on a disk that is full, or has room."""

    def __init__(self):
        self.full = False

    def lines(self):
        return iter(())

    def keep(self, line):
        if self.full:
            raise OSError(28, "No space left on device")


class Pair:
    """Robots 'a' and 'b', each at an end of its own; 'b' has the slot that 'a' sets. Time stands still."""

    def __init__(self):
        self.time, self.disk, self.told = 0.0, Disk(), []
        hub = Hub()
        self.a = self._end(hub, Member(Owned("a", (), {}, {}), frozenset({"b"})))
        self.b = self._end(hub, Member(Owned("b", ("go",), {"go": ("a",)}, {"go": ("a",)})), self.disk)

    def _end(self, hub, member, journal=None):
        return Node(
            [member],
            RUN,
            carrier=hub.plug(),
            journals=lambda robot: journal or Disk(),
            now=lambda: self.time,
            threaded=False,
            tell=self.told.append,
        )

    def go_on(self, seconds=2.0):
        for _ in range(int(seconds / 0.1)):
            self.time += 0.1
            self.a.pump()
            self.b.pump()

    def notify(self, number, active=True):
        """Have the slot set as far as it goes; return whether its owner has acknowledged."""
        delivery = self.a.prepare(CommandId(RUN, "a", "", number), (("b", "go"),), active)
        self.go_on()
        if delivery.lamport is not None:
            delivery.send(delivery.lamport)
            self.go_on()
        return delivery.is_over


@pytest.fixture
def pair():
    made = Pair()
    yield made
    made.a.close()
    made.b.close()


def test_a_full_disk_acknowledges_nothing_and_is_out_of_reach_until_there_is_room(pair):
    pair.disk.full = True
    assert not pair.notify(1)
    assert pair.b.trouble("b") == "its slots cannot be kept: No space left on device"
    assert pair.a.lost(["b"]) == ("b",)
    pair.disk.full = False
    pair.go_on()
    assert pair.b.trouble("b") == ""
    assert pair.a.lost(["b"]) == ()
    assert pair.b.state(("b", "go")).active, "what was sent meanwhile is not applied"


def test_people_are_told_of_a_full_disk_each_time_that_it_gets_full(pair):
    for number in (1, 2):
        pair.disk.full = True
        pair.notify(number)
        pair.disk.full = False
        pair.go_on()
    assert pair.told == ["'b' does not answer until its slots can be kept again: No space left on device"] * 2


def test_a_robot_that_has_ended_does_not_come_back_when_there_is_room(pair):
    pair.disk.full = True
    pair.notify(1)
    pair.b.leave("b")
    pair.go_on(5.0)
    pair.disk.full = False
    pair.go_on()
    assert pair.a.lost(["b"]) == ("b",)


def test_one_that_ends_has_ended_also_where_that_cannot_be_kept(pair):
    pair.disk.full = True
    pair.a.leave("a")
    pair.go_on(1.0)
    assert pair.b.lost(["a"]) == ("a",)


def test_what_fails_when_it_hears_of_a_change_keeps_nobody_from_being_served(pair):
    def fail():
        raise RuntimeError("cannot draw")

    heard = []
    pair.b.on_change(fail)
    pair.b.on_change(lambda: heard.append(1))
    assert pair.notify(1)
    assert heard
    assert pair.told == ["telling of a change: fails, and continues: RuntimeError('cannot draw')"]


def test_an_owner_that_fails_says_so_to_whoever_asks(pair, monkeypatch):
    owner = pair.b._owners._owners["b"]
    monkeypatch.setattr(owner, "prepare", lambda *given, **more: {}["missing"])
    delivery = pair.a.prepare(CommandId(RUN, "a", "", 1), (("b", "go"),), True)
    assert delivery.refusals == {"b": "'b' cannot answer: KeyError('missing')"}
    assert "cannot answer" in pair.told[0]


def test_a_carrier_that_fails_is_asked_again(pair, monkeypatch):
    asked = []

    def fail(*given):
        asked.append(given)
        raise RuntimeError("session closed")

    with monkeypatch.context() as patched:
        patched.setattr(HubCarrier, "ask", fail)
        delivery = pair.a.prepare(CommandId(RUN, "a", "", 1), (("b", "go"),), True)
        pair.go_on()
    assert len(asked) > 1
    pair.go_on()
    assert delivery.lamport is not None
