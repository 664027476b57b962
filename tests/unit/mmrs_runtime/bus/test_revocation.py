"""The revocation list: whom it shuts out, and which lists are refused."""

import base64
import json
import shutil
from datetime import UTC, datetime, timedelta

import pytest
from cryptography import x509
from cryptography.hazmat.primitives.serialization import Encoding

from mmrs_core.cli.bus_access import Holder
from mmrs_core.cli.bus_certificates import make_keys, revoke
from mmrs_core.cli.running import run_command
from mmrs_runtime.bus.carriers.renewal import Renewal
from mmrs_runtime.bus.carriers.revocation import REVOKED, read_list, serial_of, valid_name
from mmrs_runtime.bus.carriers.sessions import Endpoints, admitted, configuration, papers_of
from mmrs_runtime.bus.threads import Net

NOW = datetime.now(UTC)
ALL = ["a", "b", "observer"]


def certify(folder, now=NOW):
    make_keys(folder, [Holder(robot, (robot,)) for robot in "ab"], ["127.0.0.1"], now, 10)
    return folder


@pytest.fixture
def keys(tmp_path):
    return certify(tmp_path / "keys")


@pytest.fixture
def theirs(tmp_path):
    return certify(tmp_path / "theirs")


def endpoints(keys, robot="a"):
    return Endpoints(file=keys / robot / "bus.json5")


def let_in(keys, robot="a"):
    return admitted(configuration(endpoints(keys, robot)))


def listed(keys):
    return x509.load_pem_x509_crl((keys / REVOKED).read_bytes())


def certificate(folder):
    return x509.load_pem_x509_certificate((folder / "certificate.pem").read_bytes())


def in_pem(content):
    return b"-----BEGIN X509 CRL-----\n" + base64.encodebytes(content) + b"-----END X509 CRL-----\n"


def test_a_revoked_certificate_is_not_let_in_and_the_next_one_is(keys):
    assert let_in(keys) == ALL
    revoke(keys, "b", NOW)
    assert let_in(keys) == ["a", "b 2", "observer"]
    certify(keys)
    assert certificate(keys / "b").subject.rfc4514_string() == "CN=b 2"
    assert let_in(keys, "b") == ["a", "b 2", "observer"]


def test_the_list_names_the_certificate_that_was_revoked(keys):
    stolen = certificate(keys / "b")
    revoke(keys, "b", NOW)
    assert listed(keys).get_revoked_certificate_by_serial_number(stolen.serial_number) is not None
    certify(keys)
    assert (
        listed(keys).get_revoked_certificate_by_serial_number(certificate(keys / "b").serial_number) is None
    )
    lists = [(keys / each / REVOKED).read_bytes() for each in ("", *ALL)]
    assert len(set(lists)) == 1


def test_whoever_is_revoked_twice_is_revoked_once(keys):
    revoke(keys, "b", NOW)
    revoke(keys, "b", NOW)
    assert len(listed(keys)) == 1


def test_a_certificate_whose_folder_is_gone_is_revoked_when_another_one_is_made(keys):
    shutil.rmtree(keys / "b")
    certify(keys)
    assert let_in(keys) == ["a", "b 2", "observer"]
    certify(keys)
    assert let_in(keys) == ["a", "b 2", "observer"]


def test_a_process_does_not_start_with_a_revoked_certificate(keys):
    revoke(keys, "a", NOW)
    with pytest.raises(OSError, match=r"a/certificate\.pem: this certificate is revoked by .*revoked\.pem"):
        configuration(endpoints(keys))


def test_a_process_with_certificates_does_not_start_without_a_list(keys):
    (keys / "a" / REVOKED).unlink()
    with pytest.raises(OSError, match=r"a/revoked\.pem: No such file or directory; mmrs bus keys writes it"):
        configuration(endpoints(keys))


@pytest.mark.parametrize("content", [b"", b"nonsense", in_pem(b"\0\0\0"), in_pem(b"")])
def test_what_is_no_list_is_refused(keys, content):
    (keys / "a" / REVOKED).write_bytes(content)
    with pytest.raises(OSError, match=r"a/revoked\.pem: refused: "):
        configuration(endpoints(keys))


def test_a_list_of_another_authority_is_refused(keys, theirs):
    shutil.copy(theirs / REVOKED, keys / "a" / REVOKED)
    with pytest.raises(OSError, match=r"a/revoked\.pem: refused: CRL signature failure"):
        configuration(endpoints(keys))


def test_a_list_from_which_someone_is_struck_off_is_refused(keys):
    revoke(keys, "b", NOW)
    found = listed(keys).public_bytes(Encoding.DER)
    other = serial_of("observer").to_bytes(20)
    (keys / "a" / REVOKED).write_bytes(in_pem(found.replace(serial_of("b").to_bytes(20), other)))
    with pytest.raises(OSError, match="CRL signature failure"):
        configuration(endpoints(keys))


def test_what_stands_behind_the_signed_part_revokes_nothing(keys):
    found = listed(keys).public_bytes(Encoding.DER) + b"\x02\x14" + serial_of("b").to_bytes(20)
    (keys / "a" / REVOKED).write_bytes(in_pem(found))
    assert let_in(keys) == ALL


def test_a_second_list_or_an_authority_in_the_file_is_refused(keys, theirs):
    for more in ((theirs / REVOKED), (theirs / "authority.pem")):
        (keys / "a" / REVOKED).write_bytes((keys / REVOKED).read_bytes() + more.read_bytes())
        with pytest.raises(OSError, match="it is not one revocation list"):
            configuration(endpoints(keys))


@pytest.mark.parametrize(("days", "why"), [(-20, "CRL has expired"), (20, "CRL is not yet valid")])
def test_a_list_is_refused_while_it_is_not_valid(tmp_path, days, why):
    other = certify(tmp_path / "other", NOW + timedelta(days=days))
    with pytest.raises(OSError, match=f"{why}; .* valid now, {NOW:%Y-%m}"):
        configuration(endpoints(other))


def test_a_certificate_that_has_expired_hides_no_list_of_another_authority(tmp_path, theirs):
    keys = certify(tmp_path / "keys", NOW)
    shutil.rmtree(keys / "a")
    certify(keys, NOW - timedelta(days=11))
    own = papers_of(keys / "a" / "bus.json5")
    assert valid_name("a", read_list(keys / "a" / REVOKED, own)) == "a 2"
    with pytest.raises(OSError, match="CRL signature failure"):
        read_list(theirs / REVOKED, own)


class Renewed:
    """What a process with the keys of 'a' does when it looks for changes."""

    def __init__(self, keys):
        self.told, self.opened = [], []
        self.fails = False
        self.renewing = Renewal(endpoints(keys), keys / "a" / "bus.json5", self.renew, Net(self.told.append))

    def renew(self, config):
        if self.fails:
            raise OSError("address in use")
        self.opened.append(admitted(config))


def test_a_session_is_opened_anew_once_where_a_list_has_changed(keys):
    process = Renewed(keys)
    process.renewing.look()
    assert process.opened == []
    revoke(keys, "b", NOW)
    process.renewing.look()
    process.renewing.look()
    assert process.opened == [["a", "b 2", "observer"]]
    assert process.told == ["keys have changed; reopened, accepting the certificates a, b 2, observer"]


def test_a_forged_list_changes_nothing_while_a_process_runs_and_is_told(keys, theirs):
    process = Renewed(keys)
    revoke(theirs, "b", NOW)
    shutil.copy(theirs / REVOKED, keys / "a" / REVOKED)
    process.renewing.look()
    process.renewing.look()
    assert process.opened == []
    (said,) = process.told
    assert said.startswith(f"{keys / 'a' / REVOKED}: refused: CRL signature failure")
    assert said.endswith("the previous keys stay in use")


def test_an_older_list_lets_nobody_in_again_while_a_process_runs(keys):
    process, before = Renewed(keys), (keys / REVOKED).read_bytes()
    revoke(keys, "b", NOW)
    process.renewing.look()
    (keys / "a" / REVOKED).write_bytes(before)
    process.renewing.look()
    assert len(process.opened) == 1


def test_a_session_that_cannot_be_opened_anew_is_tried_again(keys):
    process, before = Renewed(keys), (keys / REVOKED).read_bytes()
    process.fails = True
    revoke(keys, "b", NOW)
    with pytest.raises(OSError, match="address in use"):
        process.renewing.look()
    (keys / "a" / REVOKED).write_bytes(before)
    process.fails = False
    process.renewing.look()
    assert process.opened == [["a", "b 2", "observer"]]


def test_a_robot_that_joins_is_let_in_without_a_restart(keys):
    process = Renewed(keys)
    make_keys(keys, [Holder(robot, (robot,)) for robot in "abd"], ["127.0.0.1"], NOW, 10)
    process.renewing.look()
    (names,) = process.opened
    (name,) = [each for each in names if each.startswith("d")]
    assert certificate(keys / "d").subject.rfc4514_string() == f"CN={name}"


def test_the_command_revokes_and_says_where_the_list_is(keys, capsys):
    assert run_command(["bus", "revoke", str(keys), "b", "--json"], "mmrs") == 0
    said = json.loads(capsys.readouterr().out)
    assert said == {"revoked": "b", "lists": [str(keys / each / REVOKED) for each in ("", *ALL)]}
    assert let_in(keys) == ["a", "b 2", "observer"]


@pytest.mark.parametrize("name", ["nobody", "authority"])
def test_a_name_without_a_certificate_cannot_be_revoked(keys, capsys, name):
    before = (keys / REVOKED).read_bytes()
    assert run_command(["bus", "revoke", str(keys), name], "mmrs") == 3
    assert "holds no certificate" in capsys.readouterr().err
    assert (keys / REVOKED).read_bytes() == before


def test_keys_are_not_made_where_the_list_is_lost_or_of_another_authority(keys, theirs, capsys):
    words = ["bus", "keys", str(keys), "--robot", "a", "--robot", "b"]
    shutil.copy(theirs / REVOKED, keys / REVOKED)
    assert run_command(words, "mmrs") == 3
    assert "not signed by authority.pem" in capsys.readouterr().err
    (keys / REVOKED).unlink()
    assert run_command(words, "mmrs") == 3
    assert "revoked certificates would be valid again" in capsys.readouterr().err.replace("\n", " ")


def test_a_robot_that_is_revoked_need_not_be_named_any_more(keys, capsys):
    revoke(keys, "b", NOW)
    assert run_command(["bus", "keys", str(keys), "--robot", "a"], "mmrs") == 0
    assert let_in(keys) == ["a", "observer"]
