"""What a vehicle does for each movement and action of a program, as jobs for its worker."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.geodesy import at_height, ends_of
from mmrs_runtime.controllers.user_functions import Locator, look_at, place_of
from mmrs_runtime.faults import DEVICE_SILENT, FaultError, UnansweredError
from mmrs_runtime.policies import VALUE_SECONDS, seconds_of
from mmrs_runtime.screen import words_of

from ..program import (
    Action,
    GoTo,
    Hold,
    Land,
    Look,
    Measure,
    NoEffect,
    Object,
    Operate,
    Place,
    Recharge,
    Report,
    Robot,
    Step,
    Stop,
    TakeOff,
    Then,
    Turn,
)
from ..services.uploads import UploadedRun
from ..steps.responses import policy_for
from ..vehicles.corners import goes_through
from ..vehicles.vehicle import Vehicle
from .charging import Charging
from .worker import Job

IN_THE_AIR = 1.0
"""Metres above home from which on a vehicle climbs by going up, not by taking off."""

Log = Callable[[str, str, Mapping[str, object]], None]


class Moves:
    """Knows how a vehicle moves and acts.

    Attributes:
        track: places passed since the last take-off, with the moves that ended there.
        charging: the last stay at a charger; None: there was none.
    """

    def __init__(
        self,
        robot: Robot,
        vehicle: Vehicle,
        clock: Clock,
        locators: Mapping[str, Locator],
        log: Log,
        passed: Callable[[Place], None] = lambda place: None,
        guard: Callable[[], None] = lambda: None,
    ) -> None:
        """Move that vehicle.

        Args:
            robot: its program.
            vehicle: of the robot.
            clock: of the run.
            locators: what finds objects, by description.
            log: called with what was reported or measured: kind, name, content.
            passed: called with each place that it has come to.
            guard: called in waits for what locators find.
        """
        self.track: list[tuple[str, Place]] = []
        self.charging: Charging | None = None
        self._found: dict[GoTo, Place] = {}
        self._steps = {step.move: step for step in robot.steps}
        self._robot, self._home, self._level = robot.id, robot.home, robot.profile.level
        policy = policy_for(DEVICE_SILENT, robot)
        self._silence = seconds_of(policy)
        self._silence_of_values = seconds_of(policy, {DEVICE_SILENT: VALUE_SECONDS})
        self._vehicle, self._clock, self._locators, self._log = vehicle, clock, locators, log
        self._passed, self._guard = passed, guard

    def movement(self, move: str, *, through: bool = False) -> Job:
        """Return what is to be done for a move; `through`: without a stop at its end."""
        movement = self._steps[move].movement
        if isinstance(movement, TakeOff):
            return Job(partial(self.climb, move, movement.height))
        if isinstance(movement, Land):
            return Job(self._vehicle.land)
        if isinstance(movement, GoTo):
            return self._go(move, movement, through)
        if isinstance(movement, Hold):
            return Job(self._rest(movement.seconds))
        if isinstance(movement, Recharge):
            return self._recharge(movement.seconds)
        if isinstance(movement, Turn):
            return Job(lambda: self._turn(movement.look))
        return Job(self._vehicle.finish) if isinstance(movement, Stop) else Job()

    def run(self, flight: UploadedRun, passed: Callable[[str], None]) -> Job:
        """Return the flight of an uploaded run; `passed` is called with every move of it but the last."""
        return Job(_Flight(self, flight, passed))

    def action(self, action: Action) -> Job:
        """Return the carrying out of an action."""
        if isinstance(action, Operate):
            return Job(lambda: self._operate(action), self._rest(action.seconds))
        if isinstance(action, Measure):
            return Job(lambda: self._measure(action), self._rest(action.seconds))
        if isinstance(action, Report):
            return Job(lambda: self._report(action))
        if isinstance(action, NoEffect):
            return Job(lambda: self._log("text", action.name, {"text": f"not supported: {action.why}"}))
        return Job()

    def kind(self, move: str) -> type[object]:
        """Return what sort of movement a move is."""
        return type(self._steps[move].movement)

    def above_home(self, height: float) -> Place:
        """Return the position at that height above home."""
        return at_height(self._home, height)

    def _pass(self, move: str, place: Place) -> None:
        self.track.append((move, place))
        self._passed(place)

    def target_of(self, movement: GoTo) -> Place:
        """Return the target of a movement, without the distance that it keeps.

        Raises:
            FaultError: it leads to an object that cannot be found.
        """
        return self._found.get(movement) or self._find(movement)

    def knows(self, move: str) -> bool:
        """Return whether the target of a move is known without looking for an object."""
        movement = self._steps[move].movement
        is_sought = isinstance(movement, GoTo) and isinstance(movement.at, Object)
        return not is_sought or movement in self._found

    def _find(self, movement: GoTo) -> Place:
        found = self._level(place_of(movement.at, self._locators, self._vehicle.state(), self._guard))
        self._found[movement] = found
        return found

    def speed_of(self, move: str) -> float | None:
        """Return how fast a move is, metres per second; None: as the vehicle likes."""
        movement = self._steps[move].movement
        return movement.speed if isinstance(movement, GoTo) else None

    def climb(self, move: str, height: float) -> None:
        """Take off, or climb on where the vehicle is in the air already."""
        state = self._vehicle.state()
        if state.armed and state.place.height > IN_THE_AIR:
            self._vehicle.go_to(at_height(state.place, height), None, None, False)
        else:
            self.track = []
            self._vehicle.take_off(height)
        self._pass(move, at_height(self._vehicle.state().place, height))

    def step(self, move: str) -> None:
        """Go where a move of a run leads to, and stop there."""
        movement = self._steps[move].movement
        assert isinstance(movement, GoTo)
        self._go(move, movement, through=False).run()

    def fly(self, flight: UploadedRun, passed: Callable[[str], None]) -> None:
        """Fly an uploaded run."""

        def reached(seq: int) -> None:
            move = flight.ends.get(seq)
            if move is not None:
                self.note(move)
                if move != flight.run.moves[-1]:
                    passed(move)

        self._vehicle.fly(flight.first, flight.last, reached, flight.look)

    def can_look(self, flight: UploadedRun) -> bool:
        """Return whether the vehicle looks where it is to on an uploaded run."""
        return self._vehicle.can_look(flight.look)

    def note(self, move: str) -> None:
        """Record that the position at the end of a run's move was passed."""
        movement = self._steps[move].movement
        assert isinstance(movement, GoTo)
        self._pass(move, place_of(movement.at, {}, self._vehicle.state()))

    def _go(self, move: str, movement: GoTo, through: bool) -> Job:
        job = Job()

        def look_up() -> None:
            if not self.track:
                self._pass(move, self._vehicle.state().place)
            state = self._vehicle.state()
            here = at_height(state.place, self.track[-1][1].height)
            target = self._find(movement)
            look = look_at(movement.look, self._locators, state, self._guard)
            ends = ends_of(here, target, movement.legs, movement.distance)
            on = through and goes_through(self._steps[move], self._following(move), here)
            job.then(*(self._leg(move, end, movement, look, on and end == ends[-1]) for end in ends))

        job.append(look_up)
        return job

    def _following(self, move: str) -> Step | None:
        then = self._steps[move].then
        return self._steps[then.move] if isinstance(then, Then) else None

    def _leg(
        self, move: str, end: Place, movement: GoTo, look: Look | None, through: bool
    ) -> Callable[[], None]:
        def go() -> None:
            self._vehicle.go_to(end, movement.speed, look, through)
            self._pass(move, end)

        return go

    def _operate(self, action: Operate) -> None:
        """Carry out a device action; a silent device is asked for as long as policies tolerate it."""
        begun = self._clock.now()
        while True:
            try:
                self._vehicle.operate(action.command, action.params, confirmed=action.confirmed)
                for command, params in action.more:
                    self._vehicle.operate(command, params)
            except UnansweredError as error:
                if self._clock.now() - begun >= self._silence:
                    raise FaultError(DEVICE_SILENT, f"{action.device}: {error}") from error
            else:
                return

    def _turn(self, look: Look) -> None:
        found = look_at(look, self._locators, self._vehicle.state(), self._guard)
        assert found is not None
        self._vehicle.turn(found)

    def _measure(self, action: Measure) -> None:
        try:
            found = self._vehicle.measure(action.value, self._silence_of_values)
        except UnansweredError as error:
            raise FaultError(DEVICE_SILENT, f"{action.device}: {error}") from error
        self._log("measured", action.value, {"device": action.device, "result": found})

    def _report(self, action: Report) -> None:
        self._vehicle.tell_ground(words_of(self._robot, action.name, dict(action.pairs)))
        self._log("reported", action.name, dict(action.pairs))

    def _rest(self, seconds: float) -> Callable[[], None]:
        left = seconds

        def rest() -> None:
            nonlocal left
            begun = self._clock.now()
            try:
                self._vehicle.rest(max(0.0, left))
            finally:
                left -= self._clock.now() - begun

        return rest

    def _recharge(self, seconds: float) -> Job:
        self.charging = charging = Charging(self._vehicle, self._clock, seconds, self._tell_charging)

        def finish() -> None:
            self.track = []
            charging.begin()
            self._vehicle.finish()

        return Job(finish, charging.stay)

    def _tell_charging(self, text: str) -> None:
        self._log("text", "charging", {"text": text})


class _Flight:
    """A run that goes up as a mission; what is left of it after an interruption is stepped."""

    def __init__(self, moves: Moves, flight: UploadedRun, passed: Callable[[str], None]) -> None:
        self._moves, self._flight, self._passed = moves, flight, passed
        self._left = list(flight.run.moves)
        self._stepped = not moves.can_look(flight)

    def __call__(self) -> None:
        if not self._stepped:
            self._stepped = True
            self._moves.fly(self._flight, self._pass)
            return
        while self._left:
            move = self._left[0]
            self._moves.step(move)
            if len(self._left) > 1:
                self._pass(move)
            else:
                return

    def _pass(self, move: str) -> None:
        self._left.remove(move)
        self._passed(move)
