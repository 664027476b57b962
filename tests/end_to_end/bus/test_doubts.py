"""What people are told of peers that cannot be reached."""

import shutil
from datetime import UTC, datetime, timedelta

import pytest
from ports import free_port

from mmrs_core.cli.bus_access import Holder
from mmrs_core.cli.bus_certificates import make_keys
from mmrs_core.cli.running import run_command
from mmrs_runtime.bus.carriers import diagnosis as doubts
from mmrs_runtime.bus.carriers.diagnosis import Papers, why_not
from mmrs_runtime.bus.carriers.sessions import Endpoints

pytestmark = pytest.mark.real_time("buses")


def papers(folder, holder="b"):
    own = folder / holder
    return Papers(own / "authority.pem", own / "certificate.pem", own / "key.pem")


def keys(folder, since=None, days=2):
    holders = [Holder(robot, (robot,)) for robot in ("a", "b", "c")]
    make_keys(folder, holders, ["127.0.0.1"], since or datetime.now(UTC), days)
    return papers(folder)


@pytest.fixture
def listening(ends):
    """Return the endpoint of a robot that shows a certificate and wants one."""
    ends.certify()
    ends.open("a")
    return f"tls/127.0.0.1:{ends.ports['a']}"


def test_nothing_is_the_matter_where_both_certificates_are_of_one_authority(ends, listening):
    assert why_not(listening, papers(ends.keys)) == ("", "")


def test_a_robot_of_another_fleet_is_told_as_that(listening, tmp_path):
    heard, refused = why_not(listening, keys(tmp_path / "others"))
    assert heard == ""
    assert refused.startswith("its certificate is not accepted here: another authority made it")


def test_an_authority_that_knows_both_is_told_that_the_other_one_does_not(ends, listening, tmp_path):
    theirs = keys(tmp_path / "others")
    mixed = Papers(papers(ends.keys).authority, theirs.certificate, theirs.key)
    expected = "this process's certificate is not accepted there: another authority made it"
    assert why_not(listening, mixed) == ("", expected)


def test_a_certificate_that_has_expired_is_told_as_that(ends, listening):
    shutil.rmtree(ends.keys / "b")
    late = keys(ends.keys, since=datetime.now(UTC) - timedelta(days=9))
    _, refused = why_not(listening, late)
    assert refused == (
        "this process's certificate is not accepted there: it has expired, or is not valid yet, by the clock"
        " there"
    )


def test_a_certificate_that_is_not_valid_yet_is_told_with_what_the_clock_says(ends, tmp_path):
    ends.keys = tmp_path / "keys"
    early = keys(ends.keys, since=datetime.now(UTC) + timedelta(days=400))
    ends.open("a", certificate="b")
    _, refused = why_not(f"tls/127.0.0.1:{ends.ports['a']}", early)
    assert f"the clock here says {datetime.now(UTC):%Y-%m}" in refused
    assert "not yet valid" in refused


def test_an_endpoint_without_a_listener_is_told_apart_from_one_without_a_machine():
    assert why_not(f"tcp/127.0.0.1:{free_port()}", None) == ("no listener there yet", "")
    assert why_not("tcp/no-such-host.invalid:7447", None)[0]
    assert why_not("serial//dev/ttyUSB0", None) == ("", "")


def test_people_are_told_once_what_keeps_a_robot_from_the_others(
    ends, listening, tmp_path, capsys, monkeypatch, until
):
    monkeypatch.setattr(doubts, "FIRST_SECONDS", 0.1)
    monkeypatch.setattr(doubts, "THEN_SECONDS", 0.1)
    keys(tmp_path / "others")
    ends.open_at("b", Endpoints((), (listening,), tmp_path / "others" / "b" / "bus.json5"))
    said = ""

    def told():
        nonlocal said
        said += capsys.readouterr().err
        return f"bus: {listening}: its certificate is not accepted here" in said

    until(told)
    ends.nodes[-1].await_change(0.5)
    assert told()
    assert said.count("not accepted here") == 1


def test_whoever_looks_on_in_vain_is_told_why(ends, listening, tmp_path, capsys):
    keys(tmp_path / "others")
    config = tmp_path / "others" / "observer" / "bus.json5"
    words = ["bus", "state", "mission", "--connect", listening, "--config", str(config), "--seconds", "0.3"]
    assert run_command(words, "mmrs") == 5
    said = capsys.readouterr().err
    assert f"{listening}: its certificate is not accepted here: another authority made it" in said


def test_certificates_that_are_missing_are_told_before_anything_moves(ends):
    with pytest.raises(OSError, match=r"tls/127\.0\.0\.1:1: needs certificates"):
        ends.open_at("a", Endpoints((), ("tls/127.0.0.1:1",)))


def test_an_address_that_would_be_tried_in_vain_by_tls_is_told_before_anything_moves(ends):
    ends.certify()
    with pytest.raises(OSError, match=r"tls/\[::1\]:1: IPv6 addresses are not reached by TLS"):
        ends.open_at("a", Endpoints((), ("tls/[::1]:1",), ends.keys / "a" / "bus.json5"))


def test_an_endpoint_that_the_configuration_does_not_allow_is_told_before_anything_moves(ends):
    ends.certify()
    with pytest.raises(OSError, match=r"tcp/127\.0\.0\.1:1: .*bus\.json5 allows tls only"):
        ends.open_at("a", Endpoints((), ("tcp/127.0.0.1:1",), ends.keys / "a" / "bus.json5"))
