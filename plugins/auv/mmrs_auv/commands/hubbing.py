"""Runs a hub until it is to end, and does what is typed meanwhile."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from errno import EADDRINUSE
from typing import TextIO

from auv_vessel.wire.frame import Frame
from auv_vessel.wire.hub import Hub, Troubles, log_line
from mmrs_core.cli.typed import listen
from mmrs_core.errors import LinkLostError

ORDERS = "loss SHARE, delay SECONDS, corruption SHARE, cut, clear, quit"


def run_hub(
    host: str,
    port: int,
    troubles: Troubles,
    seed: int,
    log: TextIO | None,
    seconds: float,
    say: Callable[[str], None],
    spared: Callable[[Frame], bool] = lambda frame: False,
) -> Hub:
    """Run a hub; return it when it has ended.

    Args:
        seconds: after which it ends; 0: when it is ordered to, or interrupted.
        say: receives where it listens, and the answers to lines that are typed.
        spared: which frames have no troubles.

    Raises:
        LinkLostError: it cannot listen there.
    """
    hub = Hub(troubles, seed, _logging(log, say), spared)
    asyncio.run(_run(hub, host, port, troubles, seconds, say))
    return hub


def _logging(log: TextIO | None, say: Callable[[str], None]) -> Callable[[float, str, Frame], None] | None:
    """Return what writes a frame to the log; it ends, and says so once, where that cannot be written."""
    if log is None:
        return None
    failed = False

    def write(now: float, channel: str, frame: Frame) -> None:
        nonlocal failed
        if failed:
            return
        try:
            log.write(log_line(now, channel, frame))
        except OSError as error:
            failed = True
            say(f"no log from here on: {error.strerror}")

    return write


def reason_of(error: OSError) -> str:
    """Return why a port cannot be listened on, and what helps."""
    if error.errno == EADDRINUSE:
        return "address already in use; choose another port with --port"
    return error.strerror or str(error)


async def _run(
    hub: Hub, host: str, port: int, usual: Troubles, seconds: float, say: Callable[[str], None]
) -> None:
    loop, ended = asyncio.get_running_loop(), asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, ended.set)
    try:
        found = await hub.start(host, port)
    except OSError as error:
        raise LinkLostError(f"no hub at {host}:{port}: {reason_of(error)}") from error
    say(f"hub at {host}:{found}; python-can: interface=socketcand host={host} port={found} channel=can0")

    def order(line: str) -> None:
        if line == "quit":
            ended.set()
        elif line:
            say(_done(hub, usual, line))

    # Once the hub has ended, its loop raises RuntimeError.
    listen(lambda line: loop.call_soon_threadsafe(order, line.strip()))
    with suppress(TimeoutError):
        await asyncio.wait_for(ended.wait(), seconds or None)
    await hub.stop()


def _done(hub: Hub, usual: Troubles, line: str) -> str:
    """Return the answer to a line that was typed."""
    try:
        match line.split():
            case ["cut"]:
                hub.troubles = replace(hub.troubles, loss=1.0)
            case ["clear"]:
                hub.troubles = usual
            case ["loss" | "delay" | "corruption" as what, value]:
                hub.troubles = replace(hub.troubles, **{what: float(value)})
            case _:
                return f"{line}: expected {ORDERS}"
    except ValueError as error:
        return f"{line}: {error}"
    now = hub.troubles
    return f"loss {now.loss:g}, delay {now.delay:g} s, corruption {now.corruption:g}"
