"""Nothing that comes over the network, and no disk, deafens a robot for good."""

import json
import time

import pytest
import zenoh
from cut_proxy import CutProxy

from mmrs_runtime.bus.carriers import over_zenoh, sessions
from mmrs_runtime.bus.carriers.queries import states_of
from mmrs_runtime.bus.carriers.sessions import Endpoints
from mmrs_runtime.bus.messages import digest

pytestmark = pytest.mark.real_time("buses")


@pytest.fixture
def pair(ends, until):
    a, b = ends.open("a"), ends.open("b")
    until(lambda: not a.missing(["b"]) and not b.missing(["a"]))
    return a, b


@pytest.fixture
def tool(ends, pair):
    """Return a session of Zenoh that knows nothing of robots, in touch with both."""
    config = zenoh.Config()
    config.insert_json5("scouting/multicast/enabled", "false")
    ways = [f"tcp/127.0.0.1:{ends.ports[robot]}" for robot in ("a", "b")]
    config.insert_json5("connect/endpoints", json.dumps(ways))
    with zenoh.open(config) as session:
        time.sleep(0.5)
        yield session


RUN_KEY = f"mmrs/{digest('mission')}/{digest('run-0')}"
ODD_KEYS = (
    "mmrs/**",
    "**",
    f"{RUN_KEY}/**",
    f"{RUN_KEY}/*/from/*",
    f"{RUN_KEY}/{digest('a')}/from/*",
    f"{RUN_KEY}/{digest('a')}/here/**",
)


def test_whoever_looks_at_everything_on_the_bus_deafens_nobody(tool, pair, notify):
    a, b = pair
    for key in ODD_KEYS:
        for payload in (None, b"\xff\xfe{", b"[" * 50_000):
            list(tool.get(key, payload=payload, timeout=0.1))
    assert notify(a, "a", "b")
    assert notify(b, "b", "a")


def test_presence_under_keys_of_any_form_deafens_nobody(tool, pair, notify):
    a, b = pair
    tokens = [tool.liveliness().declare_token(key) for key in ODD_KEYS]
    time.sleep(0.3)
    assert notify(a, "a", "b")
    for token in tokens:
        token.undeclare()
    time.sleep(0.3)
    assert notify(b, "b", "a")


def test_answers_of_any_form_do_not_keep_the_state_of_slots_from_being_seen(tool, pair, ends):
    def answer(query):
        with query:
            query.reply(query.key_expr, b"\xff\xfe nonsense")

    tool.declare_queryable("mmrs/**", answer)
    found = states_of("mission", "run-0", Endpoints(connect=ends.endpoints("c").connect), 2.0, ["a", "b"])
    told = json.loads(found[digest("a")])
    assert told["robot"] == "a"
    assert not told["slots"]["go"]["active"]


@pytest.fixture
def full(ends):
    """Return functions after which the journal of 'b' can no longer be written, and can again."""
    path = next(ends.folder.glob("b *")) / "b.ndjson"
    aside = path.with_suffix(".aside")

    def fill():
        path.rename(aside)
        path.mkdir()

    def free():
        path.rmdir()
        aside.rename(path)

    return fill, free


def test_a_robot_whose_disk_cannot_be_written_is_lost_until_it_can(pair, until, notify, request, ends):
    a, b = pair
    told = []
    ends.tell = told.append
    fill, free = request.getfixturevalue("full")
    assert notify(a, "a", "b", 1)
    fill()
    assert not notify(a, "a", "b", 2, active=False, seconds=1.0)
    assert b.trouble("b").startswith("its slots cannot be kept")
    until(lambda: a.lost(["b"]), 5.0)
    assert told[0].startswith("'b' does not answer until its slots can be kept again: ")
    free()
    until(lambda: not a.lost(["b"]) and not b.trouble("b"), 5.0)
    assert notify(a, "a", "b", 3, active=False)
    assert not b.state(("b", "go")).active


@pytest.fixture
def ways(ends):
    """Return proxies to two robots."""
    made = {robot: CutProxy(ends.ports[robot]) for robot in ("a", "b")}
    yield made
    for proxy in made.values():
        proxy.close()


def test_a_link_that_only_one_side_has_noticed_to_break_is_renewed(
    ends, ways, tmp_path, until, notify, monkeypatch
):
    lines = []
    monkeypatch.setattr(over_zenoh, "tell_people", lines.append)
    monkeypatch.setattr(over_zenoh, "RETURN_SECONDS", 0.3)
    monkeypatch.setattr(sessions, "LEASE_MILLISECONDS", 8000)
    file = tmp_path / "no-gossip.json5"
    file.write_text('{"scouting": {"gossip": {"enabled": false}}}')
    a, b = (
        ends.open_at(
            robot, Endpoints((f"tcp/127.0.0.1:{ends.ports[robot]}",), (f"tcp/127.0.0.1:{way}",), file)
        )
        for robot, way in (("a", ways["b"].port), ("b", ways["a"].port))
    )
    until(lambda: all(len(end._carrier._session.info.links()) == 2 for end in (a, b)))
    until(lambda: not a.missing(["b"]) and not b.missing(["a"]))
    failures, opened = [OSError("the address is in use")], over_zenoh.opened
    monkeypatch.setattr(
        over_zenoh, "opened", lambda config: _raise(failures.pop()) if failures else opened(config)
    )
    ways["b"].end_unnoticed()
    ways["a"].heal()
    until(lambda: {"'a': link is half-open; reconnecting", "the address is in use"} <= set(lines))
    assert notify(b, "b", "a")
    assert notify(a, "a", "b")


def _raise(error):
    raise error
