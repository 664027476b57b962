"""The bus of a run: within this process, or with robots that other processes run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import typer

from mmrs_core.behaviour.program import Program
from mmrs_core.cli.output import tell
from mmrs_core.errors import LinkLostError, UnreadableError, UnsupportedError
from mmrs_core.runtime.slots import ProgramBus, members_of, shared_bus
from mmrs_runtime.bus import Incomplete, Unwelcome, begin_together
from mmrs_runtime.bus.carriers.carrier import Carrier
from mmrs_runtime.bus.carriers.endpoints import first_fault
from mmrs_runtime.engine.resuming import restore
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.slots import LocalSlots


@dataclass(frozen=True, slots=True)
class BusWishes:
    """What the command line says of the bus.

    Attributes:
        used: whether robots of other processes are to be reached.
        listen, connect: endpoints, such as ``tcp/0.0.0.0:7447``.
        config: file of Zenoh's configuration.
        sync: real seconds to wait for all robots, which then begin at one instant; None: they need not.
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
    wishes: BusWishes,
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
    if not wishes.shared:
        _refuse_strangers(program, here)
        slots = LocalSlots(program.executable)
        restore(slots, program.executable, resumed or ())
        return slots
    try:
        from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
        from mmrs_runtime.bus.carriers.sessions import Endpoints
    except ModuleNotFoundError as error:
        raise UnsupportedError("--bus: needs Zenoh; pip install 'mmrs-core[bus]'") from error
    refuse_endpoints("--bus-listen", wishes.listen)
    refuse_endpoints("--bus-connect", wishes.connect)
    endpoints = Endpoints(wishes.listen, wishes.connect, wishes.config)
    names = sorted(robot.id for robot in program.robots)
    carrier = ZenohCarrier(program.name, run, names, endpoints, plan=program.fingerprint)
    try:
        return shared_bus(program, here, run, folder, wrap(carrier), resumed)
    except Unwelcome as error:
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
    bus: ProgramBus | LocalSlots, program: Program, robots: Iterable[str], patience: float | None
) -> Callable[[Callable[[], None]], Mapping[str, str]]:
    """Return what has robots of this process begin at one instant with those of all others.

    It is given a look at what else happens, which may raise, and returns in words how well each began.

    Args:
        robots: of this process, that begin anew.
        patience: real seconds to wait; None: nobody waits.
    """
    here = tuple(robots)

    def begin(look: Callable[[], None]) -> Mapping[str, str]:
        if patience is None or not here or isinstance(bus, LocalSlots):
            return {}
        told: set[str] = set()

        def guard(why: str) -> None:
            look()
            if why and why not in told:
                told.add(why)
                tell(f"waits for the others, {patience:g} s at most: {why}")

        everybody = [robot.id for robot in program.robots]
        try:
            found = begin_together(bus.node, here[0], everybody, guard, beside=here[1:], patience=patience)
        except Incomplete as error:
            raise LinkLostError(f"{error}; nothing has begun, --resume tries again") from error
        tell(f"begins together with the others, {found}")
        return dict.fromkeys(here, str(found))

    return begin


def _refuse_strangers(program: Program, here: Sequence[str]) -> None:
    members = members_of(program)
    strangers = sorted({each for robot in here for each in members[robot].contacts} - set(here))
    if strangers:
        raise typer.BadParameter(
            f"--robot: {', '.join(strangers)} of another process must be reached, too: say --bus"
        )
