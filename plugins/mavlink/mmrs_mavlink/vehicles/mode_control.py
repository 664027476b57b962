"""Who has the vehicle: its mode, whether it is armed, and how long it may take to obey."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from itertools import count
from math import inf

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import NO_PROGRESS, TAKEN_OVER, FaultError, RefusedError, UnansweredError

from ..links.link import Link
from ..profiles import modes
from ..services.commands import ask, command
from .guidance import Guidance, guidance_of
from .readiness import REPEATED_SECONDS
from .requests import Requests
from .telemetry import HEARING_SECONDS, Telemetry

MODE_TRIES = 3
REFUSED_SECONDS = 1.0
"""Between two requests for a mode where the first is refused."""

TAKE_OFF_TRIES = 3
ARM_TRIES = 3
WORDS_SECONDS = 0.5
"""After which a vehicle that refuses has said why."""


class ModeControl:
    """Keeps a vehicle in the mode that the program needs.

    Modes count when heartbeats show them, never by acknowledgement alone. A mode that
    was not requested here means that a pilot has taken over: the program then ends and leaves the
    vehicle alone. One that was requested lately is not a pilot's, although another was requested
    since: it is only late, or a copy of the request was.

    Attributes:
        alone: modes of failsafes that were set, in addition to the default ones.
        explains: finds the cause of another mode during a mode change.
        insists: whether a mode is commanded again that the vehicle has left during a mode change.
    """

    def __init__(self, link: Link, telemetry: Telemetry) -> None:
        """Control a vehicle; change nothing yet."""
        self._link = link
        self._telemetry = telemetry
        self._accepted: frozenset[int] = frozenset()
        self._mode: str | None = None
        self._speed: float | None = None
        self._reported = 0
        self._guidance: Guidance | None = None
        self._requests = Requests(link)
        self._asked_again = -inf
        self._arming = False
        self.alone: frozenset[int] = frozenset()
        self.explains: Callable[[FaultError], FaultError] = lambda left: left
        self.insists: Callable[[FaultError], bool] = lambda fault: False

    @property
    def guidance(self) -> Guidance:
        """Return how the vehicle is steered, once its heartbeat has told what it is."""
        if self._guidance is None:
            self._guidance = guidance_of(self._link, self._telemetry)
        return self._guidance

    @property
    def _modes(self) -> Mapping[str, modes.Mode]:
        return self._link.profile.modes

    def has(self, mode: str) -> bool:
        """Return whether the vehicle has such a mode."""
        return mode in self._modes

    def mode(self) -> str:
        """Return the vehicle's mode in the runtime's words, or its number where there is none."""
        return self._link.profile.mode_name(self._telemetry.mode())

    def enter(self, mode: str) -> None:
        """Change the mode; the vehicle forgets the commanded speed.

        Raises:
            RefusedError: the vehicle does not enter the mode.
            FaultError: it enters a third one, or leaves the wanted one again: it is under external control.
        """
        wanted, left = self._modes[mode], self._mode or self.mode()
        self._obey_late(left)
        known = self._accepted or frozenset({self._telemetry.mode()})
        self._mode, self._accepted = None, known | {wanted.number}
        for left_over in reversed(range(MODE_TRIES)):
            self._begin(mode)
            before = self._telemetry.mode()
            if not self._takes(wanted, last=not left_over):
                continue
            self._link.wait(
                lambda: self._telemetry.mode() == wanted.number or self._strays(),
                self._link.clock.patience(self._link.profile.timing.mode),
                while_received=True,
            )
            self._obey_late(left)
            if self._telemetry.mode() == wanted.number:
                self._requests.is_back()
                if before != wanted.number:
                    self._requests.shows(wanted.number)
                self._mode, self._speed, self._accepted = mode, None, frozenset({wanted.number})
                if mode != modes.GUIDED:
                    self.guidance.end_guiding()
                return
        raise RefusedError(f"the vehicle does not go into mode {mode}")

    def _takes(self, wanted: modes.Mode, *, last: bool) -> bool:
        """Request a mode; return whether the vehicle accepts it, after a pause where it does not.

        An ArduSub refuses GUIDED for a moment after it has become ready.

        Raises:
            RefusedError: it does not accept it the last time, or does not answer.
        """
        try:
            command(self._link, mavlink.MAV_CMD_DO_SET_MODE, *wanted.params)
        except RefusedError as error:
            if last or isinstance(error, UnansweredError):
                raise
            self._link.wait(lambda: None, REFUSED_SECONDS)
            return False
        return True

    def regain(self) -> None:
        """Enter the mode again that the vehicle has left without a command.

        Raises:
            RefusedError: the vehicle does not enter it. FaultError: it is under external control.
        """
        mode = self._mode
        self.let_go()
        if mode is not None:
            self.enter(mode)

    def let_go(self) -> None:
        """Accept whatever mode the vehicle goes into, as after landing."""
        self._mode, self._accepted = None, frozenset()

    def accept(self, own: Collection[int]) -> None:
        """Accept a mode of a failsafe: one of these, or the present one."""
        self._mode, self._accepted = None, frozenset({*own, self._telemetry.mode()})

    def check(self) -> None:
        """Check that the vehicle is not under external control.

        Raises:
            FaultError: the vehicle has left the mode; TAKEN_OVER, or the event that its failsafe answered.
        """
        number, mode = self._telemetry.mode(), self._mode or "take-off"
        if (glimpse := self._glimpse()) not in (None, number):
            raise self._overtaken(glimpse, mode)
        if not self._accepted or number in self._accepted or self._restored(number):
            self._requests.is_back()
        elif not self._strays():
            self._ask_again(number)
        elif self._link.since("HEARTBEAT") < self._link.clock.patience(3.0):
            raise self._left(number, mode)

    def _strays(self) -> bool:
        """Return whether the vehicle is in a mode that was not commanded here."""
        number = self._telemetry.mode()
        if not self._accepted or number in self._accepted or self._restored(number):
            return False
        return not self._requests.own(number)

    def _restored(self, number: int) -> bool:
        """Return whether a vehicle may have entered the mode of a number by disarming."""
        profile = self._link.profile
        restores = profile.autopilot.restores_mode and not self._telemetry.armed()
        return restores and not profile.is_pilots(number)

    def _glimpse(self) -> int | None:
        """Return a mode that only a pilot chooses, if one was shown since the last call.

        A command at that moment may have put it into another since.
        """
        known = self._accepted | self.alone
        shown = [number for number in self._requests.shown() if number not in known]
        pilots = filter(self._link.profile.is_pilots, shown)
        return next(pilots, None) if self._accepted else None

    def _ask_again(self, number: int) -> None:
        """Request the mode once more, where an earlier request of the program, being late, was obeyed.

        If no mode is required, as after a failsafe, the one that it obeyed is accepted.
        There is no wait for the acknowledgement: this is called in the middle of other waits.
        """
        now = self._link.clock.now()
        if self._mode is None:
            self._accepted = self._accepted | {number}
            return
        if now - self._asked_again < self._link.patience:
            return
        self._asked_again = now
        ask(self._link, mavlink.MAV_CMD_DO_SET_MODE, *self._modes[self._mode].params)

    def _begin(self, mode: str) -> None:
        if mode == modes.GUIDED:
            self.guidance.begin_guiding()

    def _obey_late(self, before: str) -> None:
        """Check that the vehicle is not under external control while it is commanded to leave a mode.

        Raises:
            FaultError: it is, or an event that its failsafe has answered is to be answered.
        """
        glimpse = self._glimpse()
        if self._strays():
            self._explain(before)
        elif glimpse is not None:
            raise self.explains(self._overtaken(glimpse, before))

    def _overtaken(self, number: int, mode: str) -> FaultError:
        """Return that a pilot had chosen a mode before the vehicle received its command."""
        self.guidance.end_guiding()
        return FaultError(
            TAKEN_OVER,
            f"the vehicle left mode {mode} for {self._link.profile.mode_name(number)}: it is under"
            f" external control; a command at that moment has put it into mode {self.mode()}",
        )

    def _explain(self, before: str) -> None:
        """Accept the mode of a failsafe, where the wanted one is to be commanded again.

        Raises:
            FaultError: it is under external control, or the event that its failsafe has answered is to be
                answered.
        """
        fault = self.explains(self._left(self._telemetry.mode(), before))
        if not self.insists(fault):
            raise fault
        self._accepted = self._accepted | {self._telemetry.mode()}

    def _left(self, number: int, mode: str) -> FaultError:
        """Return what it means that the vehicle has left a mode for that of a number; steer no more."""
        self.guidance.end_guiding()
        cause = self._telemetry.failsafe()
        said = tuple(text.text for event, text in self._telemetry.announcements.recent() if event == cause)
        if cause is not None and number in self._link.profile.failsafe_for(cause, said):
            return FaultError(
                cause, f"the vehicle left mode {mode} without a command, for mode {self.mode()}"
            )
        return FaultError(
            TAKEN_OVER, f"the vehicle left mode {mode} for {self.mode()}: it is under external control"
        )

    def until(self, test: Callable[[], bool], seconds: float, doing: str) -> None:
        """Wait until a test holds; time in which the vehicle is silent does not count.

        Raises:
            FaultError: it does not in that time; `doing` names the activity.
        """
        if not self._link.wait(test, self._link.clock.patience(seconds, 2.0), while_received=True):
            raise FaultError(NO_PROGRESS, f"the vehicle takes too long {doing}")

    def arm(self) -> None:
        """Enter GUIDED and arm.

        Raises:
            RefusedError: the vehicle does not arm; with its reason, if it gives one.
        """
        self._be_in(modes.GUIDED)
        self.start_motors()

    def start_motors(self) -> None:
        """Arm, if the vehicle is not armed; again where it disarms itself at once, as one that missed us.

        Raises:
            RefusedError: it does not arm; it says why, where the vehicle does.
            FaultError: it does not stay armed.
        """
        if self._telemetry.armed():
            return
        begun, patience = self._link.clock.now(), self._link.clock.patience(self._link.profile.timing.arming)
        for _ in range(ARM_TRIES):
            self._ask_to_arm()
            if self._link.wait(self._telemetry.armed, patience, while_received=True):
                self._arming = False
                return
        said = "; ".join(dict.fromkeys(text.text for text in self._telemetry.texts.since(begun)))
        raise FaultError(NO_PROGRESS, f"the vehicle takes too long to arm{': ' if said else ''}{said}")

    def _ask_to_arm(self) -> None:
        self._arming = True
        try:
            self._switch_motors(1)
        except RefusedError as error:
            self._arming = isinstance(error, UnansweredError)
            self._link.wait(lambda: None, WORDS_SECONDS)
            beginnings = self._link.profile.autopilot.refusals
            said = self._telemetry.texts.starting_with(beginnings, REPEATED_SECONDS)
            why = "; ".join(said or self._telemetry.lacks())
            raise RefusedError(f"{error}{': ' if why else ''}{why}") from error

    def leave_ground(self, height: float) -> None:
        """Arm and take off, again where the vehicle has disarmed itself in between.

        As one does when the command is lost: it is then asked as often as anything may be lost.

        Raises:
            RefusedError: the vehicle does not arm or take off.
        """
        for attempt in count(1):
            self._be_in(self.guidance.climbs_in)
            self.start_motors()
            # The vehicle may report a mode of its climb before it acknowledges the command.
            self._accepted = self._accepted | frozenset(self.guidance.climbing())
            try:
                command(self._link, mavlink.MAV_CMD_NAV_TAKEOFF, *self.guidance.take_off(height))
                self._follow_climb()
                return
            except RefusedError:
                # It refuses also when it has left the ground already, and its first answer was lost.
                if self._link.wait(
                    self._telemetry.airborne, self._link.profile.timing.arming, while_received=True
                ):
                    self._follow_climb()
                    return
                lost = 0 if self._telemetry.armed() else self._link.retries.tries
                if attempt >= max(TAKE_OFF_TRIES, lost):
                    raise

    def disarm(self, force: float = 0.0) -> None:
        """Stop the motors; one that flies refuses, unless it is forced to.

        Args:
            force: second parameter of the command, by which the autopilot lets itself be forced.

        Raises:
            RefusedError: the vehicle does not disarm.
        """
        self._switch_motors(0, force)
        self.until(lambda: not self._telemetry.armed(), self._link.profile.timing.mode, "to disarm")

    def _switch_motors(self, on: int, force: float = 0.0) -> None:
        """Arm or disarm; a vehicle that reports that it has changed owes no answer."""
        before = self._telemetry.armed()
        try:
            command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, on, force)
        except UnansweredError:
            patience = self._link.clock.patience(self._link.profile.timing.arming)
            if before == bool(on) or not self._link.wait(
                lambda: self._telemetry.armed() == bool(on), patience, while_received=True
            ):
                raise

    def motors_may_run(self) -> bool:
        """Return whether the vehicle is armed, or was commanded to arm, and may be by now."""
        return self._telemetry.armed() or self._arming

    def stops_motors(self) -> bool:
        """Stop the motors of a vehicle on the ground; return whether they are off.

        One that is leaving the ground, although it did not say so yet, refuses.
        """
        try:
            self.disarm()
        except RefusedError:
            return False
        self._arming = False
        return True

    def pace_next(self, speed: float | None) -> None:
        """Set another speed than that of the last target before the next one is sent.

        A vehicle plans the whole leg with the speed that holds as it receives its target.

        Raises:
            RefusedError: the vehicle takes no such speed.
        """
        if self._speed not in (None, speed):
            self.pace(speed)

    def pace(self, speed: float | None, *, again: bool = False) -> None:
        """Set the speed, metres per second, towards the target just sent and later ones; None: unchanged.

        With the first target that it receives in a mode, or after a take-off, an ArduCopter returns to its
        default speed (``ModeGuided::pva_control_start``), and a Rover obeys no speed before one
        (``ModeGuided::set_desired_speed``). As any target may be lost, the speed is sent several
        times.

        Args:
            speed: of the target.
            again: whether the target was sent again.

        Raises:
            RefusedError: the vehicle takes no such speed.
        """
        if speed is None or self._link.profile.autopilot.streams:
            return
        if again or speed != self._speed:
            self._speed, self._reported = speed, 0
        if self._reported == self._link.profile.speed_repeats:
            return
        self._reported += 1
        try:
            command(self._link, mavlink.MAV_CMD_DO_CHANGE_SPEED, 1, speed, -1)
        except UnansweredError:
            raise
        except RefusedError:
            if self._reported == self._link.profile.speed_repeats:
                self._await_heartbeat()
                raise

    def _await_heartbeat(self) -> None:
        """Wait for a heartbeat: a vehicle refuses that has left its mode, and the guard raises what for."""
        with self._link.inbox("HEARTBEAT", component=self._link.component) as beats:
            self._link.wait(lambda: beats or None, self._link.clock.patience(HEARING_SECONDS))

    def _be_in(self, mode: str) -> None:
        """Enter a mode, whatever was chosen while the mode was not controlled here."""
        if self._mode != mode or not (self._telemetry.armed() or self._is_in(mode)):
            self.enter(mode)

    def _is_in(self, mode: str) -> bool:
        return self._telemetry.mode() == self._modes[mode].number

    def _follow_climb(self) -> None:
        """Accept the modes that a take-off passes through; none here is entered then."""
        through = self.guidance.climbing()
        if through:
            self._mode, self._accepted = None, frozenset(through)
