"""Peers on a machine whose only interface is loopback: those that only connect meet, too."""

import subprocess

import pytest
from warm_python import python

from mmrs_core.cli import run

pytestmark = pytest.mark.real_time("parts of flights")

PEERS = """
import sys, time
from pathlib import Path
from mmrs_runtime.bus.carriers.sessions import Endpoints, closed, configuration, opened

way, *files = sys.argv[1:]
host, unreachable = f"{way}/127.0.0.1:17447", f"{way}/10.0.0.2:7447"
ways = [((host,), ()), ((), (host, unreachable)), ((), (host, unreachable))]
paths = [Path(each) for each in files] or [None, None, None]
sessions = [opened(configuration(Endpoints(*each, path))) for each, path in zip(ways, paths)]
until = time.monotonic() + 20.0
while time.monotonic() < until:
    met = [len(each.info.peers_zid()) for each in sessions]
    if met == [2, 2, 2]:
        break
    time.sleep(0.02)
print(*met)
for each in sessions:
    closed(each)
"""


def alone(*command: str) -> subprocess.CompletedProcess[str]:
    """Run a command on a machine of its own, whose only interface is loopback."""
    script = ["sh", "-c", 'ip link set lo up && exec "$@"', "sh"]
    words = ["unshare", "--map-root-user", "--net", *script, *command]
    return subprocess.run(words, capture_output=True, text=True, timeout=60)


@pytest.fixture(scope="module", autouse=True)
def machine():
    try:
        tried = alone("true")
    except FileNotFoundError:
        pytest.skip("a machine of its own needs unshare")
    if tried.returncode != 0:
        pytest.skip(f"no machine of its own can be made here: {tried.stderr.strip()}")


@pytest.fixture(scope="module")
def keys(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bus") / "keys"
    robots = [word for name in ("one", "two", "three") for word in ("--robot", name)]
    assert run(["bus", "keys", str(folder), *robots, "--host", "127.0.0.1"]) == 0
    return [str(folder / name / "bus.json5") for name in ("one", "two", "three")]


@pytest.mark.parametrize("way", ["tcp", "tls"])
def test_two_peers_that_only_connect_to_a_third_meet(way, keys):
    done = alone(python(), "-c", PEERS, way, *(keys if way == "tls" else ()))
    assert (done.stdout, done.stderr) == ("2 2 2\n", "")
