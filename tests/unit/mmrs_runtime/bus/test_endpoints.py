"""Endpoints that are none are told before anything is opened."""

import pytest

from mmrs_core.cli.running import run_command
from mmrs_runtime.bus.carriers.endpoints import first_fault

pytestmark = pytest.mark.real_time("parts of flights")

GOOD = ("tcp/10.0.0.2:7447", "tls/[::1]:0", "udp/drone.local:1?rel=0#iface=eth0", "unixsock-stream//run/bus")
WRONG = (
    "nonsense",
    "foo/bar",
    "foo/10.0.0.2:1",
    "tcp/",
    "tcp/10.0.0.2",
    "tcp/1.2.3.4:99999",
    "tcp/a b:1",
    "",
)


@pytest.mark.parametrize("endpoint", GOOD)
def test_endpoints_are_taken(endpoint):
    assert first_fault([endpoint]) == ""


@pytest.mark.parametrize("endpoint", WRONG)
def test_what_is_no_endpoint_is_told(endpoint):
    assert first_fault([GOOD[0], endpoint]) == f"{endpoint}: no endpoint, such as tcp/10.0.0.2:7447"


def test_a_command_with_an_endpoint_that_is_none_is_wrong_usage(capsys):
    assert run_command(["bus", "state", "mission", "--connect", "nonsense"], "mmrs") == 2
    assert "--connect nonsense: no endpoint" in capsys.readouterr().err.replace("\n", " ")
