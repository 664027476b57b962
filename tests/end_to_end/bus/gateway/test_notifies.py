"""What programs without Zenoh do over a gateway: one line of JSON, one answer."""

import json
from pathlib import Path

import pytest

from mmrs_runtime.bus.messages import MOST_FINDS

pytestmark = pytest.mark.real_time("buses")

PAGE = Path(__file__).parents[4] / "docs" / "how-to" / "bus.md"
SESSION = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith(("> {", "< {"))]

NONSENSE = [
    ({"do": "fly"}, "'fly': nothing that can be done here"),
    ({"do": "prepare", "number": 1, "slots": [], "active": True}, "slots: none"),
    ({"do": "prepare", "number": 1, "slots": ["go"], "active": True}, "slots: no lists"),
    ({"do": "prepare", "number": 1, "slots": 5, "active": True}, "slots: no list of 1 to"),
    ({"do": "prepare", "number": 1, "slots": None, "active": True}, "slots: no list of 1 to"),
    ({"do": "prepare", "number": 1, "slots": {"b": "go"}, "active": True}, "slots: no list of 1 to"),
    ({"do": "prepare", "number": 1, "slots": [["Nobody", "go"]], "active": True}, "'a' never sets any of"),
    ({"do": "prepare", "number": -1, "slots": [["b", "go"]], "active": True}, "number: no whole"),
    ({"do": "send", "number": 9, "lamport": 3}, "number 9: no such notify"),
    ({"do": "pass", "slots": ["nothing"], "lamport": 3}, "'a' has no slot 'nothing'"),
    ([], "not an object"),
]


def setting_go(number: int, **more: object) -> dict:
    """Return the line that prepares a notify which sets the slot 'go' of 'b', or what is said instead."""
    return {"do": "prepare", "number": number, "slots": [["b", "go"]], "active": True, **more}


def test_a_program_sets_slots_and_is_told_step_by_step(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    client.ask(setting_go(1), "asked")
    granted = client.hear("granted")
    assert not peer.state(("b", "go")).active
    client.ask({"do": "send", "number": 1, "lamport": granted["lamport"] + 3}, "sent")
    assert client.hear("acknowledged")["number"] == 1
    assert peer.state(("b", "go")).active
    assert peer.state(("b", "go")).lamport == granted["lamport"] + 3


def test_a_program_waits_for_its_slots_and_is_told_of_news(client, peer, until, set_ready):
    until(lambda: not peer.missing(["a"]))
    assert not client.ask({"do": "state"}, "state")["slots"]["ready"]["active"]
    set_ready()
    found = client.ask({"do": "state"}, "state")["slots"]["ready"]
    assert found["active"]
    client.ask({"do": "pass", "slots": ["ready"], "lamport": found["lamport"]}, "held")
    client.ask({"do": "pass", "slots": ["ready"], "lamport": found["lamport"] + 1}, "passed")


def test_what_was_detected_goes_with_notifies_over_the_bus_and_through_the_gateway(
    client, peer, until, set_ready
):
    until(lambda: not peer.missing(["a"]))
    client.ask(setting_go(1, finds=[["buoy", [1.0, 2.0, -3.0]]]), "asked")
    client.ask({"do": "send", "number": 1, "lamport": client.hear("granted")["lamport"]}, "sent")
    client.hear("acknowledged")
    assert peer.finds("b") == (("buoy", (1.0, 2.0, -3.0)),)

    set_ready(("wreck", None))
    assert client.ask({"do": "state"}, "state")["finds"] == [["wreck", None]]


def test_of_more_that_was_detected_than_a_notify_carries_the_last_go_with_it(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    many = [[f"buoy {number}", None] for number in range(MOST_FINDS + 20)]
    client.ask(setting_go(1, finds=many), "asked")
    client.ask({"do": "send", "number": 1, "lamport": client.hear("granted")["lamport"]}, "sent")
    client.hear("acknowledged")
    assert [name for name, _ in peer.finds("b")] == [name for name, _ in many[20:]]


def test_a_program_is_told_for_whom_its_notify_waits_and_gives_it_up(client):
    client.ask(setting_go(1), "asked")
    assert client.hear("waiting") == {"is": "waiting", "number": 1, "for": ["b"]}
    client.ask({"do": "abort", "number": 1}, "aborted")


def test_what_makes_no_sense_is_answered_and_the_program_stays(client):
    for line, why in NONSENSE:
        assert why in client.ask(line, "wrong")["why"]
    client.ask({"do": "state"}, "state")


def test_what_is_answered_wrong_has_no_effect(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    for number, lamport in ((1, 1 << 52), (2, 1 << 30)):
        client.ask(setting_go(number), "asked")
        granted = client.hear("granted")["lamport"]
        assert granted < 1 << 21
        client.ask({"do": "send", "number": number, "lamport": lamport}, "wrong")
        client.ask({"do": "pass", "slots": ["ready"], "lamport": lamport}, "wrong")
        client.ask({"do": "send", "number": number, "lamport": granted}, "sent")
        client.hear("acknowledged")


def test_a_number_is_never_used_again(client, peer, until):
    until(lambda: not peer.missing(["a"]))
    client.ask(setting_go(5), "asked")
    granted = client.hear("granted")
    client.ask({"do": "send", "number": 5, "lamport": granted["lamport"]}, "sent")
    client.hear("acknowledged")
    for number in (5, 4):
        assert "not greater than 5" in client.ask(setting_go(number, active=False), "wrong")["why"]


def test_a_notify_that_is_sent_before_it_was_granted_is_told_as_that(client):
    client.ask(setting_go(1), "asked")
    early = client.ask({"do": "send", "number": 1, "lamport": 9}, "wrong")
    assert early["why"] == "number 1: is not granted yet"


def test_a_line_that_is_too_long_has_one_answer_and_no_tail(client):
    client.socket.sendall(b"x" * 200_000 + b'{"do":"leave"}\n')
    assert "longer than any message" in client.hear("wrong")["why"]
    client.ask({"do": "state"}, "state")


def test_the_session_on_the_page_goes_as_it_says(gateway, peer, until, set_ready):
    """Each line that the page says to send is sent, and each that it says comes is awaited."""
    with gateway.connect() as client:
        for line in SESSION:
            content = json.loads(line[2:].replace("TOKEN", gateway.token))
            if line.startswith(">"):
                client.say(content)
            else:
                assert client.hear(content["is"]) == content
            if content.get("is") == "welcome":
                until(lambda: not peer.missing(["a"]))
                peer.use(3)
                set_ready()
    assert peer.state(("b", "go")).active
