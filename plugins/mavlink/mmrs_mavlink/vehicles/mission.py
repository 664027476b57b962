"""The uploaded mission: flown run by run, as long as it is not replaced."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import nan

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import NO_PROGRESS, FaultError, RefusedError

from ..links.link import Link
from ..profiles import modes
from ..profiles.autopilot import Autopilot
from ..program import Geographic, Place
from ..services.commands import command
from ..services.exchanges import mark_of
from ..services.items import LOITER, WAYPOINT, Item
from ..services.uploads import Uploads
from . import preparation
from .corridor import width_for
from .feasibility import check_feasible
from .following import Following
from .mode_control import MODE_SECONDS, ModeControl
from .runs import first_flown, keep_place, speed_for
from .steering import PATIENCE_SECONDS
from .telemetry import Telemetry

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

    def upload(self, uploads: Uploads) -> str:
        """Replace mission, fence and rally points of a vehicle, and read them back.

        Returns:
            What was changed so that each run begins with its own first item; empty where nothing was.

        Raises:
            RefusedError: something is not accepted, or read back differently, or runs would begin elsewhere.
        """
        self._items, begun = uploads.mission, self._link.clock.now()
        items = items_for(self._link.profile.autopilot, uploads.mission)
        self._id = preparation.replace_all(self._link, items, uploads.fence, uploads.rally)
        if items and self._link.profile.autopilot.missions.judged:
            check_feasible(self._link, self._telemetry, begun)
        self._width = width_for(self._link)
        return keep_place(self._link) if self._items else ""

    def fly(self, first: int, last: int, reached: Callable[[int], None]) -> Place | None:
        """Fly a run of items, and report each one passed; the vehicle then waits at the end of the run.

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
            self._follow(first, last, following, reached)
        return places[max(places)] if places else None

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
        patience = self._link.clock.patience(MODE_SECONDS)
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
