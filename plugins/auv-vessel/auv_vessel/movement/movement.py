"""The movement component: takes goals of the decision centre, and asks for a wrench that leads there."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite

import numpy as np

from auv_vessel.control.allocation import DEGREES, Allocation, Array
from auv_vessel.control.failsafe import EMERGENCY_PERIOD_LATER
from auv_vessel.goals import GOAL_PERIOD, Goal, goal_of, within_rating
from auv_vessel.movement.abilities import abilities_of
from auv_vessel.movement.guidance import Guidance, Progress
from auv_vessel.movement.loops import Loops, Motion
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import (
    BEAT_PERIOD,
    COMMAND_PERIOD,
    EMERGENCIES,
    FORCE_ID,
    MOMENT_ID,
    MOST_UPTIME,
    MOVEMENT,
    by_id,
    messages_of,
)
from auv_vessel.wire.codec import Codec, Received
from auv_vessel.wire.frame import Frame

GOAL_SILENT = 5.0 * GOAL_PERIOD
"""Seconds without a goal after which the decision centre counts as silent: the vehicle holds its place."""

PATIENCE = 10.0
"""Seconds for which it holds, before it surfaces by thrust (`Sheet.extra`: ``movement.patience``)."""

CLEARANCE, ALTITUDE_SILENT = 0.2, 1.0
"""Metres between keel and bottom (`Sheet.extra`: ``bottom.clearance``, of the vehicle's middle); seconds for
which it goes by a height above the bottom."""

STATE_SILENT = 0.3
"""Seconds without a state that is to be trusted after which it asks for no thrust."""

PROGRESS_PERIOD = 0.1
FARTHEST = 655.35


class Movement:
    """Brings the vehicle to its goal and keeps it there, and reports its progress.

    It asks for no thrust without a goal, without a state that may be trusted, and after an emergency. When
    the decision centre falls silent it holds place and depth for a while, then surfaces by thrust, until a
    goal is received again. Once it has surfaced that way the dive has ended: an emergency aborts it, so that
    thrusters stay idle for the recovery, and a vehicle that would sink lets go of its drop weight.
    While its height above the bottom is known it goes no deeper than leaves it clear.

    Attributes:
        motion: the state it goes by.
        goal: that it is given; None: none yet.
    """

    name = MOVEMENT
    period = COMMAND_PERIOD

    def __init__(self, sheet: Sheet, codec: Codec) -> None:
        self._sheet, self._codec = sheet, codec
        self._abilities = abilities_of(sheet)
        served = Allocation(sheet).served([True] * len(sheet.thrusters))
        self._loops = Loops(self._abilities, served)
        self._patience = sheet.extra.get("movement.patience", PATIENCE)
        self._clearance = sheet.extra.get("bottom.clearance", sheet.height / 2.0 + CLEARANCE)
        self._most = {
            field.name: field.high
            for each in messages_of(sheet)
            for field in each.fields
            if each.id in (FORCE_ID, MOMENT_ID)
        }
        self._hearers = by_id({
            "Position": self._hear_state, "Depth": self._hear_depth, "Pose": self._hear_state,
            "Velocity": self._hear_state, "Turning": self._hear_turning, "Current": self._hear_current,
            "Reach": self._hear_reach, "GoalPlace": self._hear_place, "GoalPose": self._hear_pose,
            **dict.fromkeys(EMERGENCIES, self._hear_emergency), "Altitude": self._hear_altitude,
        })  # fmt: skip
        self.motion = Motion()
        self.goal: Goal | None = None
        self._place: Received | None = None
        self._guidance: Guidance | None = None
        self._progress: Progress | None = None
        self._emergency: str | None = None
        self._ended = False
        self._emergency_due = 0.0
        self._sinks = sheet.weight_in_water >= 0.0
        self._fallback: str | None = None
        self._trusted_at = self._goal_at = self._bottom_at = float("-inf")
        self._bottom = float("inf")
        self._began: float | None = None
        self._due = {"Progress": 0.0, "Beat": 0.0}

    def hear(self, frame: Frame, now: float) -> None:
        """Take the state, a goal, or an emergency."""
        hearer = self._hearers.get(frame.id)
        if hearer is not None and (found := self._codec.decode(frame)) is not None:
            hearer(found, now)

    def tick(self, now: float) -> list[Frame]:
        """Ask for a wrench; tell progress."""
        self._began = now if self._began is None else self._began
        self._look_after_decision(now)
        wrench = self._wrench(now)
        self._end_afloat()
        return [*self._ending(now), *self._asked(wrench), *self._tell(now)]

    def _end_afloat(self) -> None:
        """Give the dive up, for good, once the vehicle is up without a decision centre."""
        up = self._fallback == "SURFACE" and self._progress is not None and self._progress.state == "REACHED"
        if up and self._emergency is None:
            self._emergency, self._ended = "COMMANDS_SILENT", True

    def _ending(self, now: float) -> list[Frame]:
        """Repeat that the dive has ended, to every node that still asks for thrust or puts it out."""
        if not self._ended or now + 1e-6 < self._emergency_due:
            return []
        self._emergency_due = now + EMERGENCY_PERIOD_LATER
        return [self._codec.encode("MovementEmergency", Reason="COMMANDS_SILENT", Release=self._sinks)]

    def _wrench(self, now: float) -> Array | None:
        """Return what is asked for; None: no thrust."""
        if self._emergency is not None or now - self._trusted_at > STATE_SILENT or self._guidance is None:
            self._loops.reset()
            return None
        steers = not self._loops.served[1]
        aim = self._guidance.aim(self.motion, steers, self.period)
        aim = replace(aim, depth=min(aim.depth, self._deepest(now)))
        if self._progress is not None:
            self._progress.judge(self.motion, now, steers=steers)
        return self._loops.wrench(aim, self.motion, self.period)

    def _deepest(self, now: float) -> float:
        """Return the depth at which it is still clear of the bottom; infinity where that is unknown."""
        if now - self._bottom_at > ALTITUDE_SILENT:
            return float("inf")
        return max(self._bottom - self._clearance, self._abilities.afloat - 0.1)

    def _asked(self, wrench: Array | None) -> list[Frame]:
        numbers = np.zeros(6) if wrench is None else wrench
        asked = {
            degree: min(max(float(number), -self._most[degree]), self._most[degree])
            for degree, number in zip(DEGREES, numbers, strict=True)
        }
        force = {degree: asked[degree] for degree in DEGREES[:3]}
        moment = {degree: asked[degree] for degree in DEGREES[3:]}
        return [
            self._codec.encode("WrenchForce", **force, Enable=wrench is not None),
            self._codec.encode("WrenchMoment", **moment),
        ]

    def _look_after_decision(self, now: float) -> None:
        """Hold, then surface, while goals have ceased."""
        if self.goal is None:
            return
        silent = now - self._goal_at
        wanted = (
            None if silent <= GOAL_SILENT else "HOLD" if silent <= GOAL_SILENT + self._patience else "SURFACE"
        )
        if wanted == self._fallback:
            return
        self._fallback = wanted
        if wanted is None:
            self._begin(self.goal, now)
        elif self.goal.mode != "IDLE" or self.motion.depth > self._abilities.afloat:
            here = self.motion
            self._begin(
                Goal(
                    wanted,
                    here.north,
                    here.east,
                    here.depth,
                    here.heading,
                    along=False,
                    number=self.goal.number,
                ),
                now,
            )

    def _begin(self, goal: Goal, now: float) -> None:
        """Go for a goal, from where the vehicle is now."""
        if goal.mode == "IDLE":
            self._guidance = self._progress = None
            return
        within = within_rating(goal, self._sheet)
        self._guidance = Guidance(within, self.motion, self._sheet, self._abilities)
        beyond = goal.depth - within.depth
        self._progress = Progress(self._guidance, self.motion, self._abilities, now, beyond=beyond)

    def _tell(self, now: float) -> list[Frame]:
        said = []
        if now + 1e-6 >= self._due["Progress"]:
            self._due["Progress"] = now + PROGRESS_PERIOD
            said.append(self._state_frame())
        if now + 1e-6 >= self._due["Beat"]:
            self._due["Beat"] = now + BEAT_PERIOD
            uptime = min(now - (self._began or 0.0), MOST_UPTIME)
            reason = self._emergency or ("COMMANDS_SILENT" if self._fallback else "NONE")
            state = "RUNS" if reason == "NONE" else "FAILS_SAFE"
            said.append(self._codec.encode("MovementBeat", State=state, Uptime=uptime, Reason=reason))
        return said

    def _state_frame(self) -> Frame:
        number = 0 if self.goal is None else self.goal.number
        if self._progress is None:
            return self._codec.encode("Progress", Goal=number, State="NONE", Distance=0.0)
        state = "FAILED" if self._emergency else "ACTIVE" if self._fallback else self._progress.state
        distance = self._progress.distance
        within = min(distance, FARTHEST) if isfinite(distance) else FARTHEST
        return self._codec.encode("Progress", Goal=number, State=state, Distance=within)

    def _hear_state(self, found: Received, now: float) -> None:
        self.motion = self.motion._replace(
            **{name.lower(): float(value) for name, value in found.values.items()}
        )

    def _hear_depth(self, found: Received, now: float) -> None:
        values = found.values
        depth, uncertainty = float(values["Depth"]), float(values["Uncertainty"])
        self.motion = self.motion._replace(depth=depth, uncertainty=uncertainty)
        if values["Trusted"]:
            self._trusted_at = now

    def _hear_turning(self, found: Received, now: float) -> None:
        roll, pitch, yaw = (float(found.values[name]) for name in ("Roll", "Pitch", "Yaw"))
        self.motion = self.motion._replace(rolling=roll, pitching=pitch, yawing=yaw)

    def _hear_current(self, found: Received, now: float) -> None:
        north, east = float(found.values["North"]), float(found.values["East"])
        self.motion = self.motion._replace(current_north=north, current_east=east)

    def _hear_reach(self, found: Received, now: float) -> None:
        self._loops.served = tuple(bool(found.values[degree]) for degree in DEGREES)
        self._loops.limited = bool(found.values["Limited"])

    def _hear_altitude(self, found: Received, now: float) -> None:
        if found.values["Valid"]:
            self._bottom, self._bottom_at = self.motion.depth + float(found.values["Altitude"]), now

    def _hear_place(self, found: Received, now: float) -> None:
        self._place = found

    def _hear_pose(self, found: Received, now: float) -> None:
        """Take a goal: its place came before with the same counter."""
        place = self._place
        if place is None or place.sequence != found.sequence:
            return
        goal = goal_of(place, found)
        self._goal_at = now
        if goal != self.goal:
            self.goal = goal
            if self._fallback is None:
                self._begin(goal, now)

    def _hear_emergency(self, found: Received, now: float) -> None:
        self._emergency = self._emergency or str(found.values["Reason"])
