"""Without keys, a process is reached from its own computer only, unless an address is given."""

import json

import pytest

from mmrs_core.cli.bus_access import Holder
from mmrs_core.cli.bus_access import configuration as secured
from mmrs_runtime.bus.carriers.sessions import Endpoints, configuration, exposed

pytestmark = pytest.mark.real_time("parts of flights")


def listens(*listen, connect=()):
    return json.loads(configuration(Endpoints(listen, connect)).get_json("listen/endpoints"))


def test_with_no_address_it_listens_on_this_computer_only_and_takes_part_in_no_multicast():
    config = configuration(Endpoints())
    assert listens() == ["tcp/127.0.0.1:7446", "tcp/127.0.0.1:0"]
    assert json.loads(config.get_json("scouting/multicast/enabled")) is False
    assert exposed(config) == ()


@pytest.mark.parametrize("to", ["tcp/127.0.0.1:7447", "tcp/[::1]:7447?rel=1", "tcp/localhost:7447"])
def test_who_connects_to_this_computer_listens_there_only(to):
    assert listens(connect=(to,)) == ["tcp/127.0.0.1:0"]


@pytest.mark.parametrize("listen", ["tcp/127.0.0.1:7447", "tcp/[::1]:7447", "unixsock-stream//run/bus"])
def test_an_endpoint_of_this_computer_is_not_exposed(listen):
    assert listens(listen) == [listen]
    assert exposed(configuration(Endpoints((listen,)))) == ()


@pytest.mark.parametrize(
    "listen", ["tcp/0.0.0.0:7447", "tcp/[::]:7447", "udp/10.0.0.1:1", "tcp/drone.local:1"]
)
def test_an_address_that_is_given_is_exposed(listen):
    assert exposed(configuration(Endpoints((listen,)))) == (listen,)


def test_who_connects_to_another_computer_may_be_connected_to():
    config = configuration(Endpoints(connect=("tcp/10.0.0.2:7447",)))
    assert exposed(config) == ("tcp/[::]:0",)


def test_who_wants_certificates_is_not_exposed(tmp_path):
    holder = Holder("a", ("a",))
    made = {**secured(holder, [holder]), "metadata": {}}
    (tmp_path / "bus.json5").write_text(json.dumps(made))
    config = configuration(Endpoints(("tls/0.0.0.0:7447",), (), tmp_path / "bus.json5"))
    assert exposed(config) == ()


def test_a_configuration_without_certificates_is_exposed(tmp_path):
    (tmp_path / "bus.json5").write_text("{}")
    assert exposed(configuration(Endpoints(file=tmp_path / "bus.json5"))) == ("tcp/[::]:0",)
