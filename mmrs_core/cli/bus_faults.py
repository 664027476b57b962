"""Faults of the bus that ``mmrs run --inject`` makes on purpose; the backend makes all others."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack

import typer

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.execution import Clock
from mmrs_runtime.bus.carriers.carrier import Carrier
from mmrs_runtime.engine.clocks import FollowingClock
from mmrs_runtime.injection import Rehearsal, injections


def bus_faults(
    text: str, program: Program, shared: bool, clock: Clock, stack: ExitStack
) -> Callable[[Carrier], Carrier]:
    """Return what puts the faults of the bus in front of its carrier, and begin them at their times.

    Args:
        text: as in ``--inject``.
        program: of all robots.
        shared: whether there are robots in other processes.
        clock: of the run.
        stack: ends the faults.

    Raises:
        typer.BadParameter: if a fault makes no sense.
    """
    if "bus-" not in text:
        return lambda carrier: carrier

    robots = [robot.id for robot in program.robots]
    try:
        faults = injections([text], {robot: robot for robot in robots}, alone=not shared)
    except ValueError as error:
        raise typer.BadParameter(f"--inject {error}") from error
    rehearsal = Rehearsal(faults.of_bus(), FollowingClock(clock), lambda line: None)
    stack.callback(rehearsal.close)
    rehearsal.start()
    return lambda carrier: rehearsal.wrap_carrier(carrier, robots)
