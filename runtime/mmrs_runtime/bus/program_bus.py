"""The bus of robots that several processes run, as their program has it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..program import Notify, Program, SlotId
from ..records.steps import StepRecord, log_name
from .carriers.carrier import Carrier
from .journal import FileJournal
from .meeting import Incomplete, begin_together
from .messages import CommandId, Find, SlotState
from .node import Node
from .outgoing import BusDelivery
from .owner import Owned
from .owners import Member, Recorded
from .watching import SETTLING_SECONDS

if TYPE_CHECKING:
    from ..slots import Slots


class ProgramBus:
    """The slots of robots of a program, those of this process kept here.

    Attributes:
        node: this process's end of the bus.
    """

    def __init__(self, node: Node, program: Program) -> None:
        """Use an end of the bus for the robots of a program."""
        self.node = node
        self._here = frozenset(node.robots)
        self._known = {(robot.id, slot) for robot in program.robots for slot in robot.slots}

    def prepare(
        self, id: CommandId, slots: tuple[SlotId, ...], active: bool, finds: tuple[Find, ...] = ()
    ) -> BusDelivery:
        """Ask the owners of slots for setting them; owners of this process have answered at return.

        Raises:
            ValueError: if a slot is one that no robot has.
        """
        for slot in slots:
            self._refuse_unknown(slot)
        return self.node.prepare(id, slots, active, finds)

    def finds(self, robot: str) -> tuple[Find, ...]:
        """Return what those that notified a robot of this process had detected."""
        return self.node.finds(robot)

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot of this process's robots.

        Raises:
            ValueError: if none of them has it.
        """
        self._refuse_unknown(slot)
        if slot[0] not in self._here:
            raise ValueError(f"{slot[0]}.{slot[1]}: belongs to a robot of another process")
        return self.node.state(slot)

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for own slots is passed at that logical time, and keep it if so."""
        return self.node.passed(slots, lamport)

    def lost(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have ended or can no longer be reached."""
        return self.node.lost(robots)

    def unseen(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have never been here: not come yet, or gone before."""
        return self.node.unseen(robots)

    def trouble(self, robot: str) -> str:
        """Return why what others tell a robot of this process cannot be kept now; empty: it can."""
        return self.node.trouble(robot)

    def leave(self, robot: str) -> None:
        """Announce that a robot has ended."""
        self.node.leave(robot)

    def on_change(self, callback: Callable[[], None]) -> None:
        """Register a function to call when something may have changed."""
        self.node.on_change(callback)

    def close(self) -> None:
        """Leave the bus; robots that have not ended are lost to the others."""
        self.node.close()

    def _refuse_unknown(self, slot: SlotId) -> None:
        if slot not in self._known:
            raise ValueError(f"{slot[0]}.{slot[1]}: no such slot in the program")


def shared_bus(
    program: Program,
    robots: Sequence[str],
    run: str,
    folder: Path,
    carrier: Carrier,
    records: Iterable[StepRecord] | None = None,
) -> ProgramBus:
    """Return the bus of a process that runs some robots of a program.

    Args:
        program: of all robots; its fingerprint tells its plan from others.
        robots: of this process.
        run: identifier of the run.
        folder: for what must survive this process; slots lie beside the logs there.
        carrier: to the other processes.
        records: the steps that these robots made before; None: they are not started again.

    Raises:
        Unwelcome: if another process runs one of these robots.
        OSError: if the folder cannot be written, or the carrier cannot begin.
        ValueError: if the folder holds slots of another run, or of an earlier start.
    """
    recorded = None if records is None else recorded_of(program, robots, tuple(records))
    return ProgramBus(node_of(program, robots, run, folder, carrier, recorded), program)


def node_of(
    program: Program,
    robots: Sequence[str],
    run: str,
    folder: Path,
    carrier: Carrier,
    recorded: Mapping[str, Recorded] | None,
) -> Node:
    """Return a process's end of the bus; arguments and errors are those of `shared_bus`.

    Args:
        recorded: by robot, what the logs of those say that are started again.
    """
    folder.mkdir(parents=True, exist_ok=True)
    members = members_of(program)
    paths = {robot: slots_path(folder / log_name(robot)) for robot in robots}
    return Node(
        [members[robot] for robot in robots],
        run,
        plan=program.fingerprint,
        team=tuple(members),
        carrier=carrier,
        journals=lambda robot: FileJournal(paths[robot]),
        recorded=recorded,
        settle=SETTLING_SECONDS,
    )


def members_of(program: Program) -> dict[str, Member]:
    """Return by robot what the bus must know of it."""
    senders: dict[tuple[SlotId, bool], dict[str, None]] = {}
    for robot in program.robots:
        for notify in robot.notifies:
            for slot in notify.slots:
                senders.setdefault((slot, notify.active), {})[robot.id] = None
    volatile = {slot for slot, active in senders if not active}
    sets = {
        robot.id: frozenset(slot for notify in robot.notifies for slot in notify.slots)
        for robot in program.robots
    }
    return {
        robot.id: Member(
            Owned(
                robot.id,
                robot.slots,
                {name: tuple(senders.get(((robot.id, name), True), ())) for name in robot.slots},
                {name: tuple(senders.get(((robot.id, name), False), ())) for name in robot.slots},
            ),
            frozenset(owner for owner, _ in sets[robot.id]),
            sets[robot.id] - volatile,
        )
        for robot in program.robots
    }


def begin_all(
    bus: Slots,
    program: Program,
    robots: Iterable[str],
    resumed: Sequence[StepRecord],
    patience: float | None,
    say: Callable[[str], None],
) -> Callable[[Callable[[], None]], Mapping[str, str]]:
    """Return a function that starts robots of this process at one instant with all others.

    It takes a function that looks at other events, and may raise; it returns in words how accurately each
    began. It raises `Incomplete` where not all have come in time.

    Args:
        robots: of this process.
        resumed: the steps that they made before; who made any has begun already.
        patience: real seconds to wait; None skips the wait.
        say: reports to the operator which robots are awaited, and how accurately all began.
    """
    begun = {record.robot for record in resumed}
    here = tuple(robot for robot in robots if robot not in begun)

    def begin(look: Callable[[], None]) -> Mapping[str, str]:
        if patience is None or not here or not isinstance(bus, ProgramBus):
            return {}
        reported: set[str] = set()

        def guard(why: str) -> None:
            look()
            if why and why not in reported:
                reported.add(why)
                say(f"waits for the others, {patience:g} s at most: {why}")

        everybody = [robot.id for robot in program.robots]
        try:
            found = begin_together(bus.node, here[0], everybody, guard, beside=here[1:], patience=patience)
        except Incomplete as error:
            raise Incomplete(f"{error}; nothing has begun, --resume tries again") from error
        say(f"begins together with the others, {found}")
        return dict.fromkeys(here, str(found))

    return begin


def strangers_of(program: Program, here: Iterable[str]) -> tuple[str, ...]:
    """Return the robots of other processes that robots of this one set slots of or wait for, by name."""
    own, members = set(here), members_of(program)
    return tuple(sorted({each for robot in own for each in members[robot].contacts} - own))


def slots_path(log: Path) -> Path:
    """Return where the slots of a robot are kept, given the path of its log of steps."""
    return log.with_name(f"{log.stem}.slots.ndjson")


def recorded_of(
    program: Program, robots: Iterable[str], records: Sequence[StepRecord]
) -> Mapping[str, Recorded]:
    """Return by robot what the bus must know when they are started again, from the steps they made."""
    found = {}
    for robot in robots:
        lamport, notifies = 0, {}
        for record in (each for each in records if each.robot == robot):
            lamport = record.lamport
            if record.label == "ntf":
                notify = program.by_id[robot].by_id[record.move].action(record.detail)
                assert isinstance(notify, Notify)
                notifies.update({slot: (notify.active, lamport) for slot in notify.slots})
        found[robot] = Recorded(lamport, notifies)
    return found
