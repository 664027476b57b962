"""The bus of a run: within this process, or with robots that other processes run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import typer

from mmrs_core.behaviour.program import Program
from mmrs_core.errors import LinkLostError, UnreadableError, UnsupportedError
from mmrs_runtime.bus import Unwelcome
from mmrs_runtime.bus.carriers.carrier import Carrier
from mmrs_runtime.bus.carriers.endpoints import first_fault
from mmrs_runtime.bus.program_bus import ProgramBus, shared_bus, strangers_of
from mmrs_runtime.engine.resuming import restore
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.slots import LocalSlots


@dataclass(frozen=True, slots=True)
class BusOptions:
    """Options of the bus.

    Attributes:
        used: whether robots of other processes are to be reached.
        listen, connect: endpoints, such as ``tcp/0.0.0.0:7447``.
        config: file of Zenoh's configuration.
        sync: real seconds to wait for all robots, which then begin at one instant; None: no wait.
    """

    used: bool = False
    listen: tuple[str, ...] = ()
    connect: tuple[str, ...] = ()
    config: Path | None = None
    sync: float | None = None

    @property
    def shared(self) -> bool:
        """Return whether there is anything but this process."""
        return self.used or self.sync is not None or bool(self.listen or self.connect or self.config)


def bus_for(
    program: Program,
    here: Sequence[str],
    run: str,
    folder: Path,
    wanted: BusOptions,
    resumed: tuple[StepRecord, ...] | None,
    wrap: Callable[[Carrier], Carrier],
) -> ProgramBus | LocalSlots:
    """Return the slots of all robots, as this process reaches them.

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
    if not wanted.shared:
        _refuse_strangers(program, here)
        slots = LocalSlots(program.executable)
        restore(slots, program.executable, resumed or ())
        return slots
    try:
        from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
        from mmrs_runtime.bus.carriers.sessions import Endpoints
    except ModuleNotFoundError as error:
        raise UnsupportedError("--bus: needs Zenoh; pip install 'mmrs-core[bus]'") from error
    refuse_endpoints("--bus-listen", wanted.listen)
    refuse_endpoints("--bus-connect", wanted.connect)
    endpoints = Endpoints(wanted.listen, wanted.connect, wanted.config)
    names = sorted(robot.id for robot in program.robots)
    carrier = ZenohCarrier(program.name, run, names, endpoints, plan=program.fingerprint)
    try:
        return shared_bus(program.shared, here, run, folder, wrap(carrier), resumed)
    except Unwelcome as error:
        raise LinkLostError(str(error)) from error
    except ValueError as error:
        raise UnreadableError(f"{folder}: {error}") from error


def refuse_endpoints(option: str, endpoints: Sequence[str]) -> None:
    """Refuse invalid endpoints.

    Raises:
        typer.BadParameter: if one of them is invalid.
    """
    if why := first_fault(endpoints):
        raise typer.BadParameter(f"{option} {why}")


def _refuse_strangers(program: Program, here: Sequence[str]) -> None:
    strangers = strangers_of(program.executable, here)
    if strangers:
        raise typer.BadParameter(
            f"--robot: {', '.join(strangers)} of another process must be reached, too: say --bus"
        )
