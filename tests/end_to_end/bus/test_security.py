"""The bus with certificates: who has none is not heard, and nobody speaks for another."""

import json
import socket
import stat
import time

import pytest
from cryptography import x509

from mmrs_core.cli.running import run_command
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints

pytestmark = pytest.mark.real_time("buses")

LONG_ENOUGH = 1.5


def _has_ipv6():
    try:
        socket.create_server(("::1", 0), family=socket.AF_INET6).close()
    except OSError:
        return False
    return True


@pytest.fixture
def secured(ends, until):
    """Return ends with certificates, those of 'a' and 'b' open and in touch."""
    ends.certify()
    a, b = ends.open("a"), ends.open("b")
    until(lambda: not a.missing(["b"]) and not b.missing(["a"]))
    return ends, a, b


def test_robots_with_certificates_notify_each_other(secured, notify):
    _, a, b = secured
    assert notify(a, "a", "b")
    assert notify(b, "b", "a")
    assert b.state(("b", "go")).active


@pytest.mark.thorough
def test_a_third_robot_reaches_both(secured, until, notify):
    ends, a, b = secured
    c = ends.open("c")
    until(lambda: not c.missing(["a", "b"]) and not a.missing(["c"]) and not b.missing(["c"]))
    assert notify(c, "c", "a")
    assert notify(c, "c", "b")


def test_a_peer_without_certificate_is_neither_heard_nor_seen(secured, notify, tmp_path):
    ends, a, _ = secured
    trusting = {"root_ca_certificate": str(ends.keys / "authority.pem"), "verify_name_on_connect": False}
    nothing_to_show = tmp_path / "bare.json5"
    nothing_to_show.write_text(json.dumps({"transport": {"link": {"tls": trusting}}}))
    stranger = ends.open("c", certificate="observer", listens=False)
    ends.keys = None
    ways = tuple(f"tls/127.0.0.1:{ends.ports[robot]}" for robot in ("a", "b"))
    endpoints = Endpoints((), ways, nothing_to_show)
    carrier = ZenohCarrier("mission", "run-0", ("a", "b", "c"), endpoints)
    bare = type(a)([stranger._members["c"]], "run-0", carrier=carrier)
    try:
        time.sleep(LONG_ENOUGH)
        assert set(bare.missing(["a", "b"])) == {"a", "b"}
        assert not notify(bare, "c", "a", seconds=LONG_ENOUGH)
        assert a.missing(["c"]) == ("c",)
    finally:
        bare.close()


def test_keys_of_another_robot_are_refused_before_anything_moves(ends):
    ends.certify()
    endpoints = Endpoints((), (), ends.keys / "b" / "bus.json5")
    with pytest.raises(OSError, match=r"bus\.json5: its certificate speaks for 'b', not for 'a'"):
        ends.open_at("a", endpoints)


def test_what_zenoh_refuses_is_told_without_the_lines_of_its_sources(ends):
    ends.certify()
    endpoints = Endpoints(("tls/192.0.2.1:7447",), (), ends.keys / "a" / "bus.json5")
    with pytest.raises(OSError, match=r"bus: cannot be opened: .*192\.0\.2\.1") as raised:
        ends.open_at("a", endpoints)
    assert ".rs" not in str(raised.value)


def test_a_certificate_does_not_speak_for_another_robot(secured, until, notify):
    ends, a, b = secured
    b.close()
    until(lambda: a.lost(["b"]))
    forger = ends.open("b", certificate="c", listens=False)
    until(lambda: not forger.missing(["a"]))
    assert not notify(forger, "b", "a", seconds=LONG_ENOUGH)
    assert not a.state(("a", "go")).active
    assert a.missing(["b"]) == ("b",), "its sign of life was believed"


def looking_on(ends, *more):
    """Return the arguments with which an observer asks for the slots of all robots."""
    config = ends.keys / "observer" / "bus.json5"
    ways = (word for way in ends.endpoints("c", "observer").connect for word in ("--connect", way))
    return ["bus", "state", "mission", "--config", str(config), *ways, *more]


def test_an_observer_sees_slots_and_cannot_set_them(secured, notify, capsys):
    ends, a, _ = secured
    assert notify(a, "a", "b")
    assert run_command(looking_on(ends, "--json", "--robot", "b"), "mmrs") == 0
    assert json.loads(capsys.readouterr().out)["slots"]["b"]["go"]["active"]
    observer = ends.open("c", certificate="observer", listens=False)
    assert not notify(observer, "c", "a", seconds=LONG_ENOUGH)


def test_an_observer_who_knows_no_robot_is_told_their_names(secured, notify, capsys):
    ends, a, _ = secured
    assert notify(a, "a", "b")
    assert run_command(looking_on(ends), "mmrs") == 0
    assert capsys.readouterr().out == "'a': 1 slot\n  go: inactive\n'b': 1 slot\n  go: active, set by 'a'\n"


def test_an_observer_of_a_mission_that_nobody_flies_is_told_so(secured, capsys):
    asked = [*looking_on(secured[0], "--seconds", "0.5")]
    asked[2] = "another"
    assert run_command(asked, "mmrs") == 5
    assert "no robot answered for mission 'another', run 'run-0'" in capsys.readouterr().err


def test_keys_are_readable_by_their_owner_only_and_kept_when_a_robot_is_added(tmp_path, capsys):
    folder = tmp_path / "keys"
    assert run_command(["bus", "keys", str(folder), "--robot", "a", "--robot", "ground=b,c"], "mmrs") == 0
    key = folder / "a" / "key.pem"
    before = key.read_bytes()
    assert stat.S_IMODE(key.stat().st_mode) == 0o600
    again = ["bus", "keys", str(folder), "--robot", "a", "--robot", "ground=b,c", "--robot", "d"]
    assert run_command(again, "mmrs") == 0
    assert key.read_bytes() == before
    known = json.loads((folder / "a" / "bus.json5").read_text())["access_control"]["subjects"]
    names = [name for subject in known for name in subject["cert_common_names"]]
    assert names == ["a", "ground", "d", "observer"]


def test_whoever_has_a_certificate_and_is_not_named_is_not_shut_out_silently(tmp_path, capsys):
    folder = tmp_path / "keys"
    assert run_command(["bus", "keys", str(folder), "--robot", "a", "--robot", "b"], "mmrs") == 0
    before = (folder / "observer" / "bus.json5").read_bytes()
    assert run_command(["bus", "keys", str(folder), "--robot", "c"], "mmrs") == 3
    assert "'a', 'b' would not be let in any more" in capsys.readouterr().err
    assert (folder / "observer" / "bus.json5").read_bytes() == before


def test_keys_are_for_names_and_for_addresses_of_either_kind(tmp_path, capsys):
    folder = tmp_path / "keys"
    hosts = [
        word for each in ("Heron-2.local", "10.0.0.1", "[fd00::1]", "fd00::2") for word in ("--host", each)
    ]
    assert run_command(["bus", "keys", str(folder), "--robot", "a", *hosts], "mmrs") == 0
    made = x509.load_pem_x509_certificate((folder / "a" / "certificate.pem").read_bytes())
    known = made.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    assert known.get_values_for_type(x509.DNSName) == ["Heron-2.local"]
    addresses = [str(each) for each in known.get_values_for_type(x509.IPAddress)]
    assert addresses == ["10.0.0.1", "fd00::1", "fd00::2"]


@pytest.mark.parametrize("host", ["10.0.0.1:7447", "tls/10.0.0.1", "a b", "[heron", ""])
def test_a_host_that_is_none_is_refused(tmp_path, capsys, host):
    assert run_command(["bus", "keys", str(tmp_path / "keys"), "--robot", "a", "--host", host], "mmrs") == 2
    assert "no name, nor an address" in capsys.readouterr().err.replace("\n", " ")


@pytest.mark.parametrize(("way", "listen"), [("tls", "localhost"), ("tls", "[::]"), ("tcp", "[::1]")])
def test_peers_meet_by_names_and_by_addresses_of_either_kind(ends, until, way, listen):
    """By TLS they connect to names only, where those that listen do so by IPv6."""
    if listen != "localhost" and not _has_ipv6():
        pytest.skip("this machine has no IPv6")
    if way == "tls":
        ends.certify()
    file = {robot: ends.keys / robot / "bus.json5" if ends.keys else None for robot in ("a", "b")}
    port, connect = ends.ports["a"], "localhost" if way == "tls" else listen
    ends.open_at("a", Endpoints((f"{way}/{listen}:{port}",), (), file["a"]))
    there = ends.open_at("b", Endpoints((), (f"{way}/{connect}:{port}",), file["b"]))
    until(lambda: not there.missing(["a"]))


@pytest.mark.parametrize("name", ["../x", "a/b", "observer", ""])
def test_a_name_that_is_no_folder_is_refused(tmp_path, capsys, name):
    assert run_command(["bus", "keys", str(tmp_path / "keys"), "--robot", name], "mmrs") == 2


def test_a_robot_with_two_certificates_is_refused(tmp_path, capsys):
    assert (
        run_command(["bus", "keys", str(tmp_path / "keys"), "--robot", "a", "--robot", "ground=b,a"], "mmrs")
        == 2
    )
    assert "given twice" in capsys.readouterr().err
