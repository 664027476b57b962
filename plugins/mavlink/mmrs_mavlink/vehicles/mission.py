"""The uploaded mission: flown run by run, as long as it is not replaced.

A run begins where the program wants it, with any autopilot. A PX4 accepts what it can store, and looks at
it afterwards: at its fence, at the distance to the first place (MIS_DIST_1WP), at what it wants missions
to begin and end with (MIS_TKO_LAND_REQ). What is not feasible counts as no mission at all
(``mavlink_mission.cpp``, ``update_mission_state``; since 1.15), and it never goes into AUTO with it, which
would otherwise be noticed in the air.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from math import nan

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import NO_PROGRESS, FaultError, RefusedError

from ..links.link import Link
from ..profiles import modes
from ..profiles.autopilot import Autopilot
from ..program import Geographic, Look, Place
from ..services import parameters
from ..services.commands import command
from ..services.exchanges import mark_of
from ..services.items import CHANGE_SPEED, LOITER, WAYPOINT, Item
from ..services.uploads import Uploads
from . import preparation
from .corridor import width_for
from .following import Following
from .mode_control import ModeControl
from .pointing import gimbal_looks, look_ahead, look_at_place
from .steering import PATIENCE_SECONDS
from .telemetry import Telemetry

GIMBAL_LOOKS = (
    "a gimbal may turn to what the vehicle's front is to look at on missions: those are flown leg by leg,"
    " which takes longer than planned; mavlink.gimbal says that a device is on it"
)
BEFORE_ID = 6
"""Bytes of MISSION_CURRENT before the id of the mission."""


class Mission:
    """The program's mission on a vehicle; there is none until it is uploaded."""

    def __init__(self, link: Link, telemetry: Telemetry, mode_control: ModeControl) -> None:
        """Take a vehicle that has none of the program's."""
        self._link, self._telemetry, self._mode_control = link, telemetry, mode_control
        self._items: Sequence[Item] = ()
        self._id = 0
        self._width: float | None = None
        self._looks: Look | None = None
        self._gimbal_looks = False

    def upload(self, uploads: Uploads) -> Iterator[str]:
        """Replace mission, fence and rally points of a vehicle, and read them back.

        Yields:
            What was changed so that each run begins with its own first item, and which runs it cannot fly.

        Raises:
            RefusedError: something is not accepted, or read back differently, or runs would begin elsewhere.
        """
        self._items, begun = uploads.mission, self._link.clock.now()
        items = items_for(self._link.profile.autopilot, uploads.mission)
        self._id = preparation.replace_all(self._link, items, uploads.fence, uploads.rally)
        if items and self._link.profile.autopilot.missions.judged:
            check_feasible(self._link, self._telemetry, begun)
        self._width = width_for(self._link)
        if self._items and (changed := keep_place(self._link)):
            yield changed
        fronts = any(each.look is not None and not each.look.gimbal for each in uploads.flights.values())
        self._gimbal_looks = fronts and gimbal_looks(self._link)
        if self._gimbal_looks:
            yield GIMBAL_LOOKS

    def can_look(self, look: Look | None) -> bool:
        """Return whether the vehicle looks at a place all along a run; None: where it goes."""
        return look is None or look.gimbal or not self._gimbal_looks

    def fly(
        self, first: int, last: int, reached: Callable[[int], None], look: Look | None = None
    ) -> Place | None:
        """Fly a run of items, and report each one passed; the vehicle then waits at the end of the run.

        Args:
            first, last: numbers of the items.
            reached: called with the number of each item that is passed.
            look: where the vehicle, or a gimbal on it, looks all along; None: where it goes.

        Returns:
            Where that is; None where no item defines it.

        Raises:
            RefusedError: the vehicle has another mission by now, or does not begin with that item.
            FaultError: no item was reached for too long, or the mission was set ahead or back externally.
        """
        self._check()
        self._select(first)
        with self._telemetry.trail() as trail:
            places = self._places(last)
            run = {seq: place for seq, place in places.items() if seq >= first}
            following = Following(trail, run, self._item, first, self._width)
            self._mode_control.enter(modes.AUTO)
            if (speed := speed_for(self._link, self._items, first)) is not None:
                command(self._link, mavlink.MAV_CMD_DO_CHANGE_SPEED, 1, speed, -1)
            self.look(look)
            self._follow(first, last, following, reached)
        self.look()
        return places[max(places)] if places else None

    def look(self, look: Look | None = None) -> None:
        """Look at a place from now on; None: ahead, also where a run that was broken off looked at one."""
        if look is not None:
            look_at_place(self._link, self._mode_control.guidance, look)
        elif self._looks is not None:
            look_ahead(self._link, self._looks)
        self._looks = look

    def _check(self) -> None:
        """Check that the mission was not replaced, where the vehicle has given it an id.

        Raises:
            RefusedError: it was.
        """
        current = self._link.latest("MISSION_CURRENT")
        found = mark_of(current, BEFORE_ID) if current is not None else 0
        if self._id and found and found != self._id:
            raise RefusedError(
                "the vehicle has another mission than was uploaded: it was replaced externally"
            )

    def _select(self, seq: int) -> None:
        """Continue the mission at an item, or at the first after it that is flown to.

        Raises:
            RefusedError: the vehicle does not confirm that it will.
        """
        flown = first_flown(self._items, seq)
        self._mode_control.guidance.select(seq - self._left_out)
        patience = self._link.clock.patience(self._link.profile.timing.mode)
        if not self._link.wait(lambda: seq <= self._item() <= flown, patience, while_received=True):
            raise RefusedError(f"the vehicle does not go to item {seq} of its mission")

    def _item(self) -> int:
        """Return the item of the program's mission that the vehicle is at; less than 0: not known."""
        found = self._telemetry.item()
        return found + self._left_out if found >= 0 else -1

    @property
    def _left_out(self) -> int:
        """Return how many items before the first one the vehicle does not have: home."""
        return 0 if self._link.profile.autopilot.missions.begins_with_home else 1

    def _places(self, last: int) -> dict[int, Place]:
        """Return where the items up to one are, by their number, as far as they are anywhere."""
        return {
            seq: Geographic(item.x * 1e-7, item.y * 1e-7, item.z)
            for seq, item in enumerate(self._items[: last + 1])
            if item.x or item.y
        }

    def _follow(self, first: int, last: int, following: Following, reached: Callable[[int], None]) -> None:
        """Report each item of a run that the vehicle reaches, up to the last."""
        done = first - 1
        while done < last:
            now = self._await_item_after(done + 1, following)
            for seq in range(done + 1, now):
                reached(seq)
            done = now - 1

    def _await_item_after(self, seq: int, following: Following) -> int:
        def behind() -> int | None:
            self._check()
            now = following.look()
            return now if now > seq else None

        found = self._link.wait(behind, 10 * PATIENCE_SECONDS, while_received=True)
        self._mode_control.check()
        if found is None:
            raise FaultError(NO_PROGRESS, f"item {seq} of the mission was not reached")
        return found


def items_for(autopilot: Autopilot, items: Sequence[Item]) -> Sequence[Item]:
    """Return a mission that begins with home as an autopilot wants it.

    Where 0 would count, as a heading north, headings are left to the vehicle.
    """
    wanted = items if autopilot.missions.begins_with_home else items[1:]
    return [_unheaded(item) for item in wanted] if autopilot.missions.zero_counts else wanted


def _unheaded(item: Item) -> Item:
    return replace(item, params=(*item.params[:3], nan)) if item.command in (WAYPOINT, LOITER) else item


LOOK_SECONDS = 1.0
"""After which it has looked at what came last."""

FEASIBLE_SECONDS = 5.0


def check_feasible(link: Link, telemetry: Telemetry, begun: float) -> None:
    """Make sure that a PX4 would fly the mission that it has; one that does not say is believed.

    Args:
        link: to the vehicle.
        telemetry: of the vehicle.
        begun: second of the run at which the upload was begun.

    Raises:
        RefusedError: it would not.
    """
    looked = link.clock.now() + LOOK_SECONDS
    link.wait(lambda: link.clock.now() >= looked, LOOK_SECONDS)

    def has_one() -> bool:
        current = link.latest("MISSION_CURRENT")
        return current is None or current.mission_state != mavlink.MISSION_STATE_NO_MISSION

    if not link.wait(has_one, link.clock.patience(FEASIBLE_SECONDS), while_received=True):
        warnings = (
            text.text
            for text in telemetry.texts.since(begun)
            if text.severity <= mavlink.MAV_SEVERITY_WARNING
        )
        said = "".join(f"; it says '{text}'" for text in dict.fromkeys(warnings))
        raise RefusedError(f"mission: the vehicle has accepted it, and would not fly it{said}")


LAST_TO_FLY = int(mavlink.MAV_CMD_NAV_LAST)
"""Items with higher commands are carried out on the way; the vehicle goes nowhere for them."""

AT_ONCE = 1
"""The value by which a vehicle begins a run elsewhere, or without a command."""

USUAL_SPEED = -1.0
"""With which DO_CHANGE_SPEED makes a vehicle take the speed of its parameters."""


def first_flown(mission: Sequence[Item], seq: int) -> int:
    """Return the number of the first item from `seq` on that the vehicle flies to."""
    return next(index for index in range(seq, len(mission)) if mission[index].command <= LAST_TO_FLY)


def speed_for(link: Link, mission: Sequence[Item], seq: int) -> float | None:
    """Return the speed to command to a vehicle that begins AUTO at an item; None: none is needed.

    Where the speed of an earlier run is restored, less than 0 makes the vehicle take its default.
    """
    said = speed_before(mission, seq)
    if said is not None or mission[seq].command == CHANGE_SPEED:
        return said
    if not link.profile.autopilot.missions.keeps_speed:
        return None
    return USUAL_SPEED if any(item.command == CHANGE_SPEED for item in mission[:seq]) else None


def speed_before(mission: Sequence[Item], seq: int) -> float | None:
    """Return the speed that its run has said before an item, metres per second; None: none yet."""
    for item in reversed(mission[:seq]):
        if item.command == LOITER:
            return None
        if item.command == CHANGE_SPEED:
            return item.params[1]
    return None


def keep_place(link: Link) -> str:
    """Make the vehicle begin AUTO at the commanded item.

    Returns:
        What was changed, in words; empty where nothing was.

    Raises:
        RefusedError: it would begin runs elsewhere, or without a command.
    """
    name, trouble = link.profile.autopilot.missions.starts_itself
    if not name or round(parameters.read(link, [name]).get(name, 0)) != AT_ONCE:
        return ""
    if not parameters.write(link, name, 0.0):
        raise RefusedError(f"{name} = 1: {trouble}, and does not confirm 0")
    return f"{name} = 0, which was 1: each run begins with its own first place"
