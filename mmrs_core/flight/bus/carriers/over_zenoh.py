"""A carrier between processes and machines, by Zenoh (``pip install eclipse-zenoh``), peer to peer.

Keys hold digests, so that no name can reach beyond its own mission and run:
``mmrs/MISSION/RUN/OWNER/from/SENDER`` for requests, ``…/ROBOT/here/START`` for who is there,
``…/ROBOT/state`` for the state of slots. With certificates, access control binds SENDER and ROBOT to
the certificate of whoever speaks.
"""

from __future__ import annotations

import atexit
import json
import os
import re
import threading
import uuid
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import zenoh

from ..troubles import Net, tell_people
from ..words import LONGEST, digest
from .carrier import Answered, Station
from .doubts import Doubts, Papers
from .endpoints import first_fault

LEASE_MILLISECONDS = 1500
"""After so long without a sign a frozen peer counts as lost."""

ANSWER_SECONDS = 5.0
"""How long an answer is of use; what is not answered is asked again sooner."""

CLOSING_SECONDS, LAST_SECONDS = 1.0, 2.0
"""How long closing may take, and how much longer when the process ends."""

READERS = 64
"""Threads that read from the network. Zenoh blocks two of them for ten seconds with every machine that goes
out of reach (it closes sockets that linger); without one that is free, nobody else is heard either."""

_FILES = (
    "root_ca_certificate",
    "listen_private_key",
    "listen_certificate",
    "connect_private_key",
    "connect_certificate",
)
_SHOWN = ("root_ca_certificate", "connect_certificate", "connect_private_key")
_SOURCES = re.compile(r" at \S+\.rs:\d+\.?")
_TLS_TO_IPV6 = re.compile(r"(tls|quic|quic_datagram)/\[")
RETRY = {"period_init_ms": 100, "period_max_ms": 1000, "period_increase_factor": 2}


@dataclass(frozen=True, slots=True)
class Endpoints:
    """How peers are reached.

    Attributes:
        listen: endpoints to listen at, such as ``tcp/0.0.0.0:7447``. connect: endpoints of others; with
            none of either, and none in the file, others are found by multicast.
        file: of Zenoh's configuration, with certificates for example; None: there is none.
    """

    listen: tuple[str, ...] = ()
    connect: tuple[str, ...] = ()
    file: Path | None = None


class ZenohCarrier:
    """Carries requests as queries, which the network answers from the owner itself."""

    def __init__(
        self,
        mission: str,
        run: str,
        robots: Sequence[str],
        endpoints: Endpoints,
        plan: str = "",
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
        self._start = f"{uuid.uuid4().hex[:12]}-{self._plan}"
        self._station: Station | None = None
        self._speaks_for: frozenset[str] | None = None
        self._own: set[str] = set()
        self._session: Any = None
        self._declared: list[Any] = []
        self._tokens: dict[str, Any] = {}
        self._there: dict[tuple[str, bool], set[str]] = {}
        self._work: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._worker = threading.Thread(target=self._serve_all, name="bus answers", daemon=True)
        self._closing = threading.Lock()
        self._doubts: Doubts | None = None

    def open(self, station: Station) -> None:
        """Open a session, and watch who is there.

        Raises:
            OSError: it cannot be opened, or its configuration is not readable.
        """
        self._station = station
        self._session = opened(self._endpoints)
        self._speaks_for = _speaks_for(self._endpoints.file)
        self._worker.start()
        watched = self._session.liveliness().declare_subscriber(
            f"{self._prefix}/*/here/*", self._later(self._see), history=True
        )
        self._declared.append(watched)
        papers = papers_of(self._endpoints.file)
        self._doubts = Doubts(self._endpoints.connect, papers, self._count_peers, self._net)
        self._doubts.start()

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
        here = f"{self._key(robot, 'here')}/{self._start}"
        with self._closing:
            if self._session is None or robot in self._tokens:
                return
            if robot not in self._own:
                self._answer_for(robot)
            self._tokens[robot] = self._session.liveliness().declare_token(here)
        self.publish(robot)

    def _answer_for(self, robot: str) -> None:
        self._own.add(robot)
        serve, show = self._later(self._serve), self._later(lambda query: self._show(robot, query))
        self._declared.append(self._session.declare_queryable(self._key(robot, "from", None), serve))
        self._declared.append(self._session.declare_queryable(self._key(robot, "state"), show))

    def vanish(self, robot: str) -> None:
        """Tell that a robot is no longer there; it still answers."""
        with self._closing:
            token = self._tokens.pop(robot, None)
        if token is not None:
            token.undeclare()

    def publish(self, robot: str) -> None:
        """Tell whoever looks on the state of a robot's slots."""
        if self._station is None:
            return
        shown = _shown(self._station, robot)
        with self._closing:
            if self._session is not None:
                self._session.put(self._key(robot, "state"), shown)

    def close(self) -> None:
        """Close the session; idempotent."""
        if self._doubts is not None:
            self._doubts.stop()
        for robot in list(self._tokens):
            self.vanish(robot)
        while self._declared:
            self._declared.pop().undeclare()
        with self._closing:
            session, self._session = self._session, None
        if session is not None:
            closed(session)
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

    def _see(self, sample: Any) -> None:
        robot, start = self._parts(sample.key_expr)
        name = self._names.get(robot)
        if name is None or start == self._start or self._station is None:
            return
        fits = start.endswith(f"-{self._plan}")
        there = self._there.setdefault((name, fits), set())
        if sample.kind == zenoh.SampleKind.DELETE:
            there.discard(start)
        else:
            there.add(start)
        (self._station.noticed if fits else self._station.stranger)(name, bool(there))

    def _parts(self, key: Any) -> tuple[str, str]:
        """Return whose key it is and what it ends with; empty where it is none of ours or stands for many."""
        parts = str(key).split("/")
        if len(parts) != 6 or "/".join(parts[:3]) != self._prefix:
            return "", ""
        return parts[3], parts[5]

    def _key(self, robot: str, what: str, other: str | None = "") -> str:
        """Return a key; `other` None: whoever it is, empty: nobody."""
        ending = "" if other == "" else f"/{'*' if other is None else digest(other)}"
        return f"{self._prefix}/{digest(robot)}/{what}{ending}"


def configuration(endpoints: Endpoints) -> Any:
    """Return Zenoh's configuration.

    Raises:
        OSError: the file cannot be read, or is none of Zenoh's configurations; or an endpoint is none.
    """
    if why := first_fault((*endpoints.listen, *endpoints.connect)):
        raise OSError(why)
    config = zenoh.Config() if endpoints.file is None else _from_file(endpoints.file)
    _refuse_ways(endpoints, json.loads(config.get_json("transport/link/protocols")))
    _insert(config, "transport/link/tx/lease", LEASE_MILLISECONDS)
    _insert(config, "connect/retry", RETRY)
    if endpoints.listen:
        _insert(config, "listen/endpoints", list(endpoints.listen))
    if endpoints.connect:
        _insert(config, "connect/endpoints", list(endpoints.connect))
    if endpoints.listen or endpoints.connect or endpoints.file is not None:
        _insert(config, "scouting/multicast/enabled", False)
        # A peer that is not there yet is looked for again and again, and nobody waits for it.
        _insert(config, "connect/timeout_ms", -1)
        _insert(config, "connect/exit_on_failure", False)
    return config


def _refuse_ways(endpoints: Endpoints, allowed: Sequence[str] | None) -> None:
    """Refuse endpoints that Zenoh would try in vain, and without a word.

    Raises:
        OSError: one needs certificates and there are none, the file does not allow it, or Zenoh, which takes
            an IPv6 address for a name, does not reach it by TLS.
    """
    for each in endpoints.connect:
        if _TLS_TO_IPV6.match(each):
            raise OSError(f"{each}: IPv6 addresses are not reached by TLS: say a name that stands for it")
    for each in (*endpoints.listen, *endpoints.connect):
        way = each.partition("/")[0]
        if endpoints.file is None and way in ("tls", "quic"):
            raise OSError(f"{each}: needs certificates, and the configuration with them (mmrs bus keys)")
        if allowed and way not in allowed:
            raise OSError(f"{each}: {endpoints.file} allows {', '.join(allowed)} only")


def papers_of(file: Path | None) -> Papers | None:
    """Return what a configuration says of certificates; None: nothing, or not all of it."""
    if file is None:
        return None
    config = _from_file(file)
    found = [json.loads(config.get_json(f"transport/link/tls/{name}")) for name in _SHOWN]
    return Papers(*map(Path, found)) if all(isinstance(each, str) for each in found) else None


def _from_file(path: Path) -> Any:
    """Return the configuration in a file; names of files in it are those of files beside it."""
    try:
        config = zenoh.Config.from_file(str(path))
    except zenoh.ZError as error:
        raise OSError(f"{path}: cannot be read as a configuration of Zenoh: {_plain(error)}") from error
    for name in _FILES:
        found = json.loads(config.get_json(f"transport/link/tls/{name}"))
        if isinstance(found, str) and not Path(found).is_absolute():
            _insert(config, f"transport/link/tls/{name}", str((path.parent / found).absolute()))
    return config


def _insert(config: Any, name: str, value: object) -> None:
    config.insert_json5(name, json.dumps(value))


def _shown(station: Station, robot: str) -> str:
    """Return the state of a robot's slots with its name, for those who look on and know the key only."""
    return json.dumps({"robot": robot, "slots": json.loads(station.shown(robot))})


def closed(session: Any) -> None:
    """Close a session, but do not wait for peers that are frozen: Zenoh would, for ten seconds."""

    def close() -> None:
        # What fails here is that a peer does not say goodbye; there is nobody left to be told.
        with suppress(zenoh.ZError):
            session.close()

    closing = threading.Thread(target=close, name="bus closing", daemon=True)
    closing.start()
    closing.join(CLOSING_SECONDS)
    if closing.is_alive():
        # A thread that comes back from Zenoh while the interpreter ends would abort the process.
        atexit.register(closing.join, LAST_SECONDS)


def opened(endpoints: Endpoints) -> Any:
    """Return a session.

    Raises:
        OSError: it cannot be opened, or its configuration is not readable.
    """
    # Read when the first session of a process is opened, and nowhere else can it be said.
    os.environ.setdefault("ZENOH_RUNTIME", f"(rx: (worker_threads: {READERS}))")
    try:
        return zenoh.open(configuration(endpoints))
    except zenoh.ZError as error:
        raise OSError(f"bus: cannot be opened: {_plain(error)}") from error


def _plain(error: zenoh.ZError) -> str:
    """Return what Zenoh says, without the lines of its sources."""
    return _SOURCES.sub("", str(error)).strip()


def _speaks_for(file: Path | None) -> frozenset[str] | None:
    """Return the robots for which the certificate of a configuration speaks; None where it does not say.

    Raises:
        OSError: the file cannot be read, or is none of Zenoh's configurations.
    """
    told = json.loads(_from_file(file).get_json("metadata")) if file is not None else None
    robots = told.get("robots") if isinstance(told, dict) else None
    return frozenset(map(str, robots)) if isinstance(robots, list) else None
