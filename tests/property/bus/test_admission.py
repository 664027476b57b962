"""No word of another run, plan or sender, nor one from an impossible time, changes or learns anything."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

import pytest
from hub import Hub
from hypothesis import given
from hypothesis import strategies as st

from mmrs_runtime.bus import Member, Node, Owned
from mmrs_runtime.bus.messages import (
    Abort,
    Answer,
    Begin,
    CommandId,
    Commit,
    Ended,
    Leave,
    Meet,
    Prepare,
    Request,
    written,
)
from mmrs_runtime.bus.owners import AHEAD, LATE, STRANGE

RUN, PLAN = "harvest", "4f2a91"
THIS = f"{RUN} of plan {PLAN}"


class Book:
    """A journal in memory."""

    def __init__(self) -> None:
        """Hold nothing."""
        self.kept: list[Mapping[str, Any]] = []

    def lines(self) -> Iterator[Mapping[str, Any]]:
        """Yield what was kept."""
        yield from self.kept

    def keep(self, line: Mapping[str, Any]) -> None:
        """Keep a line."""
        self.kept.append(line)


def end(book: Book) -> Node:
    owned = Owned("owner", ("go",), {"go": ("peer",)}, {"go": ("peer",)})
    return Node(
        [Member(owned)],
        RUN,
        plan=PLAN,
        team=("owner", "peer", "third"),
        carrier=Hub().plug(),
        journals=lambda robot: book,
        threaded=False,
        tell=lambda line: None,
    )


def words(id: CommandId, lamport: int, robot: str = "third") -> list[Request]:
    """Return one word of each kind."""
    return [
        Prepare(id, 1, ("go",), False, lamport),
        Commit(id, ("go",), True, lamport),
        Abort(id, 1),
        Begin(id, (("go", True, lamport),)),
        Leave(id, lamport),
        Ended(id, ((robot, lamport),)),
        Meet(id, 1),
    ]


def seen(node: Node, book: Book) -> object:
    """Return all that can be seen of a process's end of the bus."""
    robots = ("peer", "third", "stranger")
    told = (node.lost(robots), node.unseen(robots), node.missing(robots), node.lamport)
    return json.dumps(book.kept), node.shown("owner"), told


wrong_runs = st.sampled_from(["", RUN, PLAN, f"{RUN} of plan 000000", f"other of plan {PLAN}", THIS + " "])
wrong_runs |= st.text(max_size=30).filter(lambda text: text != THIS)
times = st.integers(0, AHEAD // 2)


@given(run=wrong_runs, kind=st.integers(0, 6), lamport=times, start=st.text(max_size=9))
def test_a_word_of_another_run_or_plan_changes_nothing_and_learns_nothing(run, kind, lamport, start):
    book = Book()
    node = end(book)
    before = seen(node, book)
    answer = node.serve("owner", "peer", written(words(CommandId(run, "peer", start, 1), lamport)[kind]))
    assert seen(node, book) == before
    assert json.loads(answer) == {"is": "refused", "why": STRANGE}


@pytest.mark.parametrize("kind", range(7))
def test_a_word_of_no_robot_of_the_mission_changes_nothing(kind):
    book = Book()
    node = end(book)
    before = seen(node, book)
    word = words(CommandId(THIS, "stranger", "1", 1), 5)[kind]
    assert json.loads(node.serve("owner", "stranger", written(word)))["why"] == STRANGE
    assert seen(node, book) == before


def test_nobody_tells_that_a_robot_has_ended_which_the_mission_does_not_have():
    book = Book()
    node = end(book)
    before = seen(node, book)
    tidings = words(CommandId(THIS, "peer", "1", 1), 5, robot="stranger")[5]
    assert json.loads(node.serve("owner", "peer", written(tidings)))["why"] == STRANGE
    assert seen(node, book) == before


TIMED = ("prepare", "commit", "begin", "leave", "ended")


def forged(do: str, lamport: object) -> str:
    """Return a word of this run with something in the place of its logical time."""
    id = CommandId(THIS, "peer", "1", 1)
    (word,) = (w for w in words(id, 424242) if type(w).__name__.lower() == do)
    return written(word).replace("424242", json.dumps(lamport))


@pytest.mark.parametrize("do", TIMED)
@given(
    lamport=st.integers(AHEAD + 10, 1 << 80)
    | st.integers(max_value=-1)
    | st.floats()
    | st.booleans()
    | st.text(max_size=5)
    | st.none()
    | st.lists(st.integers(), max_size=2)
)
def test_an_impossible_logical_time_changes_nothing(do, lamport):
    book = Book()
    node = end(book)
    before = seen(node, book)
    assert json.loads(node.serve("owner", "peer", forged(do, lamport)))["is"] == "refused"
    assert seen(node, book) == before


@pytest.mark.parametrize("do", TIMED)
def test_a_word_from_as_far_ahead_as_a_robot_can_be_is_obeyed(do):
    book = Book()
    node = end(book)
    before = seen(node, book)
    assert json.loads(node.serve("owner", "peer", forged(do, AHEAD)))["is"] in ("granted", "applied", "done")
    assert seen(node, book) != before


@pytest.mark.parametrize("lamport", [AHEAD + 1, 1 << 52])
def test_the_bound_is_told_without_the_time_here(lamport):
    node = end(Book())
    assert json.loads(node.serve("owner", "peer", forged("leave", lamport))) == {"is": "refused", "why": LATE}


def test_a_grant_from_an_impossible_time_is_as_good_as_none():
    hub = Hub()

    class Liar:
        def noticed(self, robot, here):
            pass

        def serve(self, owner, sender, request):
            said = json.loads(request)["do"]
            return written(Answer("granted", 1 << 51) if said == "prepare" else Answer("done"))

    hub.stations["liar"] = Liar()
    node = Node(
        [Member(Owned("me", (), {}, {}), frozenset({"liar"}))],
        RUN,
        plan=PLAN,
        carrier=hub.plug(),
        threaded=False,
        tell=lambda line: None,
    )
    delivery = node.prepare(CommandId(RUN, "me", "", 1), (("liar", "go"),), True)
    assert delivery.lamport is None
    assert delivery.waiting == ("liar",)
