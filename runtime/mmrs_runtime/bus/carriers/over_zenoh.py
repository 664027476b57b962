"""A carrier between processes and machines, by Zenoh (``pip install eclipse-zenoh``), peer to peer.

Keys hold digests, so that no name can reach beyond its own mission and run:
``mmrs/MISSION/RUN/OWNER/from/SENDER`` for requests, ``…/ROBOT/here/START`` for presence,
``…/ROBOT/state`` for the state of slots. With certificates, access control binds SENDER and ROBOT to
the certificate of the peer.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Sequence
from functools import partial
from queue import SimpleQueue
from typing import Any

import zenoh

from ..messages import LONGEST, digest
from ..threads import Net, tell_people
from .carrier import Answered, Station
from .diagnosis import Doubts
from .renewal import Renewal
from .sessions import Endpoints, closed, configuration, exposed, opened, papers_of, speaks_for

ANSWER_SECONDS = 5.0
"""How long an answer is of use; what is not answered is asked again sooner."""

RETURN_SECONDS = 3.0
"""After so long a link to a peer that is back without its robots counts as half-open."""

_There = dict[tuple[str, bool], dict[str, bool]]
"""Starts of robots, each with whether it is there, by name and whether it flies by the same plan."""


class ZenohCarrier:
    """Carries requests as queries, which the network answers from the owner itself."""

    def __init__(
        self, mission: str, run: str, robots: Sequence[str], endpoints: Endpoints, plan: str = ""
    ) -> None:
        """Keep what is needed to begin.

        Args:
            mission: name of the mission, the same in every process.
            run: identifier of the run.
            robots: all of the mission that this process may have to do with, its own included.
            endpoints: how peers are reached.
            plan: what tells this plan of the mission from others.
        """
        self._net = Net(tell_people)
        self._prefix = f"mmrs/{digest(mission)}/{digest(run)}"
        self._names = {digest(robot): robot for robot in robots}
        self._endpoints = endpoints
        self._plan = digest(plan)
        self._start, self._starts = "", set[str]()
        self._station: Station | None = None
        self._speaks_for: frozenset[str] | None = None
        self._own: set[str] = set()
        self._session: Any = None
        self._declared: list[Any] = []
        self._tokens: dict[str, Any] = {}
        self._there: _There = {}
        self._config: Any = None
        self._links: dict[str, Any] = {}
        self._rejoining = threading.Lock()
        self._work: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._worker = threading.Thread(target=self._serve_all, name="bus answers", daemon=True)
        self._closing = threading.Lock()
        self._over = threading.Event()
        self._doubts: Doubts | None = None
        self._renewing: Renewal | None = None

    def open(self, station: Station) -> None:
        """Open a session, and watch who is there.

        Raises:
            OSError: it cannot be opened, or its configuration is not readable.
        """
        self._station, file = station, self._endpoints.file
        config = configuration(self._endpoints)
        if file is not None and (speaks := speaks_for(file)) is not None:
            self._speaks_for = speaks
            self._renewing = Renewal(self._endpoints, file, self._rejoin, self._net)
        if reached := exposed(config):
            self._net.tell(
                f"without keys it listens at {', '.join(reached)}:"
                " any host that reaches it can read and set slots"
            )
        self._config = config
        self._join()
        self._worker.start()
        self._doubts = Doubts(self._endpoints.connect, papers_of(file), self._count_peers, self._net)
        self._doubts.start()
        if self._renewing is not None:
            self._renewing.start()

    def _join(self) -> None:
        """Open a session, and show in it the robots that are shown.

        Raises:
            OSError: it cannot be opened.
        """
        session = opened(self._config)
        with self._closing:
            if not self._over.is_set():
                self._session = session
                # By another key than the session before, whose end may be noticed later.
                self._start = f"{session.info.zid()}-{self._plan}"
                self._starts.add(self._start)
                see = self._later(partial(self._see, self._there))
                meet = self._later(partial(self._meet, self._there))
                self._declared.append(session.info.declare_transport_events_listener(meet))
                watched = session.liveliness().declare_subscriber(
                    f"{self._prefix}/*/here/*", see, history=True
                )
                self._declared.append(watched)
                self._tokens = {robot: self._token(robot) for robot in self._tokens}
                return
        closed(session)

    def _rejoin(self, config: Any = None) -> None:
        """Open a session instead of the one there is; meanwhile no robot of another process is there.

        Args:
            config: None: the same as before.

        Raises:
            OSError: it cannot be opened; then this process is off the bus.
        """
        with self._rejoining:
            self._part()
            there, self._there, self._links = self._there, {}, {}
            self._work.put(lambda: self._lose(there))
            self._config = self._config if config is None else config
            self._join()

    def _part(self) -> None:
        """Close the session, if there is one."""
        with self._closing:
            session, self._session = self._session, None
            declared, self._declared = self._declared, []
            self._tokens = dict.fromkeys(self._tokens)
            self._own.clear()
        if session is not None:
            for each in declared:
                each.undeclare()
            closed(session)

    def _count_peers(self) -> int:
        with self._closing:
            return 0 if self._session is None else len(self._session.info.peers_zid())

    def ask(self, sender: str, owner: str, request: str, answered: Answered) -> None:
        """Send a query; Zenoh's own thread hands over the answer."""

        def take(reply: Any) -> None:
            if reply.ok is not None:
                self._work.put(lambda: answered(reply.ok.payload.to_string()))

        key = self._key(owner, "from", sender)
        handler = zenoh.handlers.Callback(take, indirect=False)
        with self._closing:
            if self._session is not None:
                self._session.get(
                    key,
                    handler,
                    payload=request,
                    timeout=ANSWER_SECONDS,
                    consolidation=zenoh.ConsolidationMode.NONE,
                    express=True,
                )

    def appear(self, robot: str) -> None:
        """Answer for a robot, and tell that it is there; also again after `vanish`.

        Raises:
            OSError: the certificate of this process speaks for other robots.
        """
        if self._speaks_for is not None and robot not in self._speaks_for:
            whose = ", ".join(map(repr, sorted(self._speaks_for))) or "no robot"
            raise OSError(f"{self._endpoints.file}: its certificate speaks for {whose}, not for {robot!r}")
        with self._closing:
            if self._over.is_set() or robot in self._tokens:
                return
            self._tokens[robot] = None if self._session is None else self._token(robot)
        self.publish(robot)

    def _token(self, robot: str) -> Any:
        """Answer for a robot, and return what tells that it is there."""
        if robot not in self._own:
            self._own.add(robot)
            serve, show = self._later(self._serve), self._later(lambda query: self._show(robot, query))
            self._declared.append(self._session.declare_queryable(self._key(robot, "from", None), serve))
            self._declared.append(self._session.declare_queryable(self._key(robot, "state"), show))
        return self._session.liveliness().declare_token(f"{self._key(robot, 'here')}/{self._start}")

    def vanish(self, robot: str) -> None:
        """Announce that a robot is no longer present; it still answers."""
        with self._closing:
            token = self._tokens.pop(robot, None)
        if token is not None:
            token.undeclare()

    def publish(self, robot: str) -> None:
        """Publish the state of a robot's slots to observers."""
        if self._station is None:
            return
        shown = _shown(self._station, robot)
        with self._closing:
            if self._session is not None:
                self._session.put(self._key(robot, "state"), shown)

    def close(self) -> None:
        """Close the session; idempotent."""
        self._over.set()
        for each in (self._doubts, self._renewing):
            if each is not None:
                each.stop()
        for robot in list(self._tokens):
            self.vanish(robot)
        self._part()
        if self._worker.is_alive():
            self._work.put(None)
            self._worker.join()

    def _later(self, work: Callable[[Any], None]) -> Any:
        """Return a handler that leaves its work to this carrier's own thread, in order.

        Zenoh's threads, which read from the network, must not wait for locks and disks.
        """
        return zenoh.handlers.Callback(lambda given: self._work.put(lambda: work(given)), indirect=False)

    def _serve_all(self) -> None:
        """Do what there is to do until `close`; nothing of it keeps the rest from being done."""
        try:
            while (work := self._work.get()) is not None:
                with self._net.under("something that came over the bus"):
                    work()
        finally:
            # Whoever answers nobody must not look as if it would.
            for robot in list(self._tokens):
                self.vanish(robot)

    def _serve(self, query: Any) -> None:
        with query:
            owner, sender = self._parts(query.key_expr)
            robot, asker = self._names.get(owner), self._names.get(sender)
            if robot is None or asker is None or query.payload is None or self._station is None:
                return
            content = query.payload.to_bytes()
            text = "" if len(content) > LONGEST else content.decode("utf-8", "replace")
            if answer := self._station.serve(robot, asker, text):
                query.reply(query.key_expr, answer)

    def _show(self, robot: str, query: Any) -> None:
        """Answer a query for states; its key may stand for those of many robots."""
        with query:
            if self._station is not None:
                query.reply(self._key(robot, "state"), _shown(self._station, robot))

    def _see(self, there: _There, sample: Any) -> None:
        """Take note of who is there, in the session that has this record of it."""
        robot, start = self._parts(sample.key_expr)
        name = self._names.get(robot)
        if name is None or start in self._starts or self._station is None or there is not self._there:
            return
        fits = start.endswith(f"-{self._plan}")
        starts = there.setdefault((name, fits), {})
        starts[start] = sample.kind == zenoh.SampleKind.PUT
        (self._station.noticed if fits else self._station.stranger)(name, any(starts.values()))

    def _meet(self, there: _There, event: Any) -> None:
        """Take note of a link to a peer; where its robots were there before, check whether they return."""
        if there is self._there:
            peer = str(event.transport.zid)
            self._links[peer] = event
            if event.kind == zenoh.SampleKind.PUT and self._robots_at(peer):
                self._after(RETURN_SECONDS, partial(self._doubt, peer, event))

    def _doubt(self, peer: str, event: Any) -> None:
        """Open another session where a link to a peer is back, but its robots are not.

        Where two peers connect to each other, one of them may notice an interruption and connect again while
        the other still holds its old link. Zenoh 1.10 adds the new link to what the other holds, which then
        announces nothing again and drops messages because their numbers start again: the two never recover.
        """
        robots = self._robots_at(peer)
        if self._links.get(peer) is event and not any(robots.values()):
            self._net.tell(f"{', '.join(map(repr, sorted(robots)))}: link is half-open; reconnecting")
            self._reopen(self._there)

    def _reopen(self, there: _There) -> None:
        """Open another session instead of the one there is, or later where it cannot be opened now."""
        if there is self._there and not self._over.is_set():
            try:
                self._rejoin()
            except OSError as error:
                self._net.tell(str(error))
                self._after(RETURN_SECONDS, partial(self._reopen, self._there))

    def _robots_at(self, peer: str) -> dict[str, bool]:
        """Return the robots that were there by a peer, each with whether it still is."""
        return {
            name: here
            for (name, _), starts in self._there.items()
            for start, here in starts.items()
            if start.startswith(f"{peer}-")
        }

    def _after(self, seconds: float, work: Callable[[], None]) -> None:
        """Leave work to this carrier's own thread, some time later."""
        timer = threading.Timer(seconds, self._work.put, (work,))
        timer.daemon = True
        timer.start()

    def _lose(self, there: _There) -> None:
        """Mark all present peers as gone."""
        if self._station is not None:
            for (name, fits), starts in there.items():
                if any(starts.values()):
                    (self._station.noticed if fits else self._station.stranger)(name, False)

    def _parts(self, key: Any) -> tuple[str, str]:
        """Return whose key it is and what it ends with; empty where it is none of ours or stands for many."""
        parts = str(key).split("/")
        if len(parts) != 6 or "/".join(parts[:3]) != self._prefix:
            return "", ""
        return parts[3], parts[5]

    def _key(self, robot: str, what: str, other: str | None = "") -> str:
        """Return a key; `other` None: any robot, empty: none."""
        ending = "" if other == "" else f"/{'*' if other is None else digest(other)}"
        return f"{self._prefix}/{digest(robot)}/{what}{ending}"


def _shown(station: Station, robot: str) -> str:
    """Return the state of a robot's slots with its name, for those who look on and know the key only."""
    return json.dumps({"robot": robot, "slots": json.loads(station.shown(robot))})
