"""Without keys and addresses: processes of one computer meet, and are not reached from others."""

from contextlib import suppress
from ipaddress import ip_address
from pathlib import Path

import pytest
from ports import free_port

from mmrs_runtime.bus.carriers import over_zenoh, sessions
from mmrs_runtime.bus.carriers import queries as looking
from mmrs_runtime.bus.carriers.sessions import Endpoints, exposed

pytestmark = pytest.mark.real_time("buses")

SOCKETS = Path("/proc/self/net")
LISTENS = {"tcp": "0A", "tcp6": "0A", "udp": "07", "udp6": "07"}


@pytest.fixture
def met(ends, monkeypatch):
    monkeypatch.setattr(sessions, "MEETING", f"tcp/127.0.0.1:{free_port()}")
    return lambda robot: ends.open_at(robot, Endpoints())


def addresses():
    """Return where sockets of this process take what comes in, by their number."""
    found = {}
    own = set()
    for each in Path("/proc/self/fd").iterdir():
        with suppress(OSError):  # closed meanwhile
            own.add(str(each.readlink()).removeprefix("socket:[").removesuffix("]"))
    for table, state in LISTENS.items():
        for line in (SOCKETS / table).read_text().splitlines()[1:]:
            words = line.split()
            if words[3] == state and words[9] in own:
                found[words[9]] = ip_address(_turned(words[1].partition(":")[0]))
    return found


def _turned(text):
    """Return an address from the words of 32 bits that the kernel shows, each with its last byte first."""
    content = bytes.fromhex(text)
    return b"".join(content[at : at + 4][::-1] for at in range(0, len(content), 4))


def test_processes_of_one_computer_meet_also_when_the_first_of_them_has_ended(met, until):
    a, b = met("a"), met("b")
    until(lambda: not a.missing("b") and not b.missing("a"))
    a.close()
    c = met("c")
    until(lambda: not b.missing("c") and not c.missing("b"))


@pytest.mark.skipif(not SOCKETS.exists(), reason="this system does not say where sockets listen")
def test_no_other_computer_reaches_a_process_without_keys_and_addresses(met):
    before = addresses()
    met("a")
    assert {each for number, each in addresses().items() if number not in before} == {ip_address("127.0.0.1")}


def test_a_process_without_keys_that_others_reach_says_so_in_one_line(ends, monkeypatch):
    lines = []
    monkeypatch.setattr(over_zenoh, "tell_people", lines.append)
    ends.open("a")
    assert lines == []
    port = free_port()
    ends.open_at("b", Endpoints((f"tcp/0.0.0.0:{port}",)))
    where = f"tcp/0.0.0.0:{port}"
    assert lines == [f"without keys it listens at {where}: any host that reaches it can read and set slots"]


def test_who_only_looks_on_listens_nowhere(monkeypatch):
    used = []

    def opened(config):
        used.append(config)
        return sessions.opened(config)

    monkeypatch.setattr(looking, "opened", opened)
    endpoints = Endpoints(connect=("tcp/192.0.2.1:7447",))
    assert looking.states_of("mission", "run-0", endpoints, 0.1) == {}
    assert [exposed(config) for config in used] == [()]
