"""What a robot does when its program is broken off, or has ended: how it responds, and what is seen of it."""

from __future__ import annotations

from collections.abc import Callable

from mmrs_runtime.faults import BATTERY_LOW, FAILURES, LINK_LOST, TAKEN_OVER, FaultError
from mmrs_runtime.policies import HOLD, NOTHING

from ..program import Robot
from ..steps.obeying import obeying, undone
from ..steps.responding import HINDRANCES, comes_down_alone, respond_or_less
from ..steps.responses import instead_of
from ..steps.watch import Decide, Watch
from ..vehicles.vehicle import Vehicle
from .moves import Moves
from .worker import Interrupted, Job

KEPT_UP = "hands off until it is disarmed; it still receives heartbeats, so end this later"


class Response:
    """Carries out responses with a vehicle, from any state.

    Attributes:
        name: of the last commanded response; empty: it follows its program.
        holds: whether it holds position while armed, so that an operator must watch it.
        hands_off: whether the vehicle is under external control.
        failed: called with exceptions of faulty or foreign code.
    """

    def __init__(
        self,
        robot: Robot,
        vehicle: Vehicle,
        watch: Watch,
        moves: Moves,
        say: Callable[[str], None],
        near_home: float,
    ) -> None:
        """Respond to nothing yet; within `near_home` metres from home, it has come home."""
        self.name = ""
        self.holds = self.hands_off = False
        self._robot, self._vehicle, self._watch, self._moves, self._say = robot, vehicle, watch, moves, say
        self._near_home = near_home
        self._handled: set[str] = set()
        self._shown: Callable[[], bool] = lambda: False
        self._instead = ""
        self._decide: Decide = lambda event, why, response: None
        self.failed: Callable[[BaseException], None] = lambda error: None

    def begin(self, name: str, found: FaultError | None, decide: Decide, *, restored: bool) -> Job | None:
        """Return the response to a fault; None where the vehicle cannot be commanded.

        Args:
            name: of the response, a literal of PolicyResponse or NOTHING.
            found: None for an order.
            decide: called with the response that replaces it.
            restored: whether the link was lost and is restored.
        """
        self.name, self.holds, self._instead, self._shown = name, False, "", lambda: False
        self._decide = decide
        self._handled.add("" if found is None else found.event)
        self._watch.relax(self._handled, name)
        event = "" if found is None else found.event
        if event == LINK_LOST and not restored:
            return None
        if name == NOTHING or event == TAKEN_OVER:
            return self._let_go()
        if instead := instead_of(name, event, self._robot):
            decide(event, f"{name} needs a position", instead)
            self._instead, name = f"without a position, it does {instead}", instead
        self._shown = obeying(name, self._robot, self._vehicle, self._moves.track)
        return Job(lambda: self._carry_out(name, event))

    def forget(self) -> None:
        """Prepare for the next fault: the program continues."""
        self.name = ""
        self._handled.clear()

    @property
    def is_shown(self) -> bool:
        """Return whether the vehicle was seen to do it since it was commanded."""
        return self._shown()

    @property
    def undone(self) -> str:
        """Return why the vehicle has not done it, although nothing is left to do; empty where it has."""
        return self._instead or undone(self.name, self._robot, self._vehicle, self._near_home)

    def _let_go(self) -> Job:
        self.hands_off = True
        self._say(KEPT_UP)
        self._watch.let_go()
        return Job()

    def _carry_out(self, name: str, event: str) -> None:
        self._watch.check_hands(event)
        self.holds = self._respond(name, low=event == BATTERY_LOW)
        self._watch.moving = self.holds

    def _respond(self, name: str, *, low: bool) -> bool:
        """Carry out the response, a simpler one, or, where the program itself fails, a halt.

        Returns:
            Whether it must be watched, because it follows no command, and would not land
            without this program either.
        """
        robot, vehicle, track = self._robot, self._vehicle, self._moves.track
        try:
            return respond_or_less(
                name, robot, vehicle, track, lambda movement: movement(), self._do_less, low=low
            )
        except Interrupted:
            raise
        except FaultError as fault:
            if fault.event not in HINDRANCES or comes_down_alone(robot, vehicle, self._watch.current()):
                raise
            self._instead = self._instead or f"{name} cannot be carried out: {fault}"
            self._say(f"cannot carry out {name}: {fault}; take over by hand")
            self._watch.relax(self._handled, HOLD)
            return True
        except FAILURES as error:
            self.failed(error)
            self._instead = f"the program itself fails: {error!r}: it does {HOLD}"
            return self._vehicle.hold()

    def _do_less(self, name: str, why: FaultError, less: str) -> None:
        """Report that a simpler response replaces the commanded one."""
        self._instead = f"{name} cannot be carried out: {why}: it does {less}"
        self._decide(why.event, f"{name} cannot be carried out: {why}", less)
        self._say(f"cannot carry out {name}: {why}; response: {less}")
        self._watch.relax(self._handled, less)
