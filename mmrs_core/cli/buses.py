"""The bus of a run: within this process, or with robots that other processes run."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import typer

from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.cli.output import tell
from mmrs_core.errors import LinkLostError, UnreadableError, UnsupportedError
from mmrs_core.flight.bus import Doubled
from mmrs_core.flight.bus.carrier import Carrier
from mmrs_core.flight.bus.endpoints import first_fault
from mmrs_core.runtime.orders import Orders
from mmrs_core.runtime.resuming import restore
from mmrs_core.runtime.slots import InProcessBus, ProgramBus, members_of, shared_bus


@dataclass(frozen=True, slots=True)
class BusWishes:
    """What the command line says of the bus.

    Attributes:
        used: whether robots of other processes are to be reached.
        listen, connect: endpoints, such as ``tcp/0.0.0.0:7447``.
        config: file of Zenoh's configuration.
        sync: whether all robots begin at one instant.
    """

    used: bool = False
    listen: tuple[str, ...] = ()
    connect: tuple[str, ...] = ()
    config: Path | None = None
    sync: bool = False

    @property
    def shared(self) -> bool:
        """Return whether there is anything but this process."""
        return self.used or self.sync or bool(self.listen or self.connect or self.config)


def bus_for(
    program: Program,
    here: Sequence[str],
    run: str,
    folder: Path,
    wishes: BusWishes,
    resumed: tuple[StepRecord, ...] | None,
    wrap: Callable[[Carrier], Carrier] = lambda carrier: carrier,
) -> ProgramBus:
    """Return the bus of this process.

    Args:
        here: the robots of this process.
        folder: of the logs.
        resumed: the steps of these robots before the run was broken off; None: it was not.
        wrap: puts something in front of what carries messages to other processes.

    Raises:
        typer.BadParameter: if an endpoint is none, or robots wait for robots of other processes, and
            no bus is asked for.
        LinkLostError: if another process runs one of these robots.
        UnreadableError: if what the folder holds belongs to another run.
        UnsupportedError: if Zenoh is not installed.
    """
    if not wishes.shared:
        _refuse_strangers(program, here)
        bus = InProcessBus(program)
        restore(bus, program, resumed or ())
        return bus
    try:
        from mmrs_core.flight.bus.over_zenoh import Endpoints, ZenohCarrier
    except ModuleNotFoundError as error:
        raise UnsupportedError("--bus: needs Zenoh; pip install 'mmrs-core[bus]'") from error
    refuse_endpoints("--bus-listen", wishes.listen)
    refuse_endpoints("--bus-connect", wishes.connect)
    endpoints = Endpoints(wishes.listen, wishes.connect, wishes.config)
    carrier = ZenohCarrier(program.name, run, sorted(robot.id for robot in program.robots), endpoints)
    try:
        return shared_bus(program, here, run, folder, wrap(carrier), resumed)
    except Doubled as error:
        raise LinkLostError(str(error)) from error
    except ValueError as error:
        raise UnreadableError(f"{folder}: {error}") from error


def refuse_endpoints(option: str, endpoints: Sequence[str]) -> None:
    """Refuse what is no endpoint.

    Raises:
        typer.BadParameter: if one of them is none.
    """
    if why := first_fault(endpoints):
        raise typer.BadParameter(f"{option} {why}")


def begin_all(
    bus: ProgramBus, program: Program, here: Sequence[str], run: str, orders: Orders
) -> Callable[[], None]:
    """Return what waits until all robots of all processes are ready, and begin at one instant."""

    def begin() -> None:
        threads = [
            threading.Thread(target=_begin, args=(bus, program, robot, run, orders), daemon=True)
            for robot in here
        ]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            threads[0].join(0.05)
            threads = [thread for thread in threads if thread.is_alive()] or threads[:1]
        if orders.waiting:
            raise KeyboardInterrupt

    return begin


def _begin(bus: ProgramBus, program: Program, robot: str, run: str, orders: Orders) -> None:
    from mmrs_core.flight.bus import begin_together

    told: list[str] = []

    def guard(why: str) -> None:
        if orders.waiting:
            raise SystemExit
        if why and why not in told:
            told.append(why)
            tell(f"'{robot}': waits for the others: {why}")

    all_robots = [each.id for each in program.robots]
    found = begin_together(bus.node, robot, run, all_robots, guard)
    tell(f"'{robot}': begins together with the others, at most {1000 * found.skew:.1f} ms apart")


def _refuse_strangers(program: Program, here: Sequence[str]) -> None:
    members = members_of(program)
    strangers = sorted({each for robot in here for each in members[robot].contacts} - set(here))
    if strangers:
        raise typer.BadParameter(
            f"--robot: {', '.join(strangers)} of another process must be reached, too: say --bus"
        )
