"""Looking on: the slots of robots that other processes run, and why these cannot be reached."""

from __future__ import annotations

import time
from collections.abc import Sequence

import zenoh

from ..messages import digest
from .diagnosis import why_not
from .sessions import Endpoints, closed, configuration, opened, papers_of


def states_of(
    mission: str, run: str, endpoints: Endpoints, seconds: float, robots: Sequence[str] = ()
) -> dict[str, str]:
    """Return names of robots and the state of their slots as JSON, by digest of the name.

    Args:
        mission, run: of the robots.
        endpoints: how they are reached.
        seconds: how long to wait for answers; less where all wanted robots have answered.
        robots: wanted robots; empty for all that answer.

    Raises:
        OSError: the bus cannot be opened.
    """
    key, found = f"mmrs/{digest(mission)}/{digest(run)}/*/state", dict[str, str]()
    wanted = {digest(robot) for robot in robots}
    until = time.monotonic() + seconds
    config = configuration(endpoints)
    if not endpoints.listen:
        config.insert_json5("listen/endpoints", "[]")  # peers need not find who only asks
    session = opened(config)
    try:
        while time.monotonic() < until and not (wanted and wanted <= set(found)):
            # Peers may not be in touch yet: what they keep is asked for again and again.
            for reply in session.get(key, timeout=seconds, target=zenoh.QueryTarget.ALL):
                if reply.ok is not None and len(parts := str(reply.ok.key_expr).split("/")) == 5:
                    found[parts[3]] = reply.ok.payload.to_bytes().decode("utf-8", "replace")
            time.sleep(0.05)
    finally:
        closed(session)
    return found


def reasons(endpoints: Endpoints) -> list[str]:
    """Return why peers cannot be reached, each with its endpoint; those that can be are left out."""
    papers = papers_of(endpoints.file)
    reported = ((each, "".join(why_not(each, papers))) for each in endpoints.connect)
    return [f"{each}: {why}" for each, why in reported if why]
