"""Revoked keys: processes that run refuse them as soon as the authority's list says so."""

import shutil
from datetime import UTC, datetime

import pytest

from mmrs_core.cli.bus_certificates import revoke
from mmrs_runtime.bus.carriers import over_zenoh, renewal
from mmrs_runtime.bus.watching import Unwelcome

pytestmark = pytest.mark.real_time("buses")

LONG_ENOUGH = 1.5


@pytest.fixture
def told(ends, monkeypatch):
    """Return what processes tell, which have certificates and look all the time for changes."""
    lines = []
    monkeypatch.setattr(renewal, "LOOK_SECONDS", 0.05)
    monkeypatch.setattr(over_zenoh, "tell_people", lines.append)
    ends.certify()
    return lines


@pytest.fixture
def pair(ends, told, until):
    a, b = ends.open("a"), ends.open("b")
    until(lambda: not a.missing("b") and not b.missing("a"))
    return a, b


def test_a_stolen_key_is_refused_without_a_restart_once_it_is_revoked(ends, pair, told, until, notify):
    a, b = pair
    shutil.copytree(ends.keys / "c", ends.keys / "stolen")
    thief = ends.open("c", certificate="stolen", listens=False)
    until(lambda: not thief.missing("ab") and not a.missing("c") and not b.missing("c"))
    assert notify(thief, "c", "a")
    revoke(ends.keys, "c", datetime.now(UTC))
    until(lambda: a.missing("c") and b.missing("c") and thief.missing("ab") == ("a", "b"))
    until(lambda: not a.missing("b") and not b.missing("a"))
    assert not notify(thief, "c", "a", 2, active=False, seconds=LONG_ENOUGH)
    assert a.state(("a", "go")).active, "the stolen key has reset a slot"
    assert thief.missing("ab") == ("a", "b"), "the stolen key still hears others"
    assert notify(a, "a", "b"), "valid keys no longer work"
    ends.certify()
    with pytest.raises(Unwelcome, match="'c' was started before in this run"):  # it is heard, and hears
        ends.open("c", settle=5.0)
    assert "keys have changed; reopened, accepting the certificates a, b, c 2, observer" in told
