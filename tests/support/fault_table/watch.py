"""Follows one vehicle: strikes when it is time, sees where it comes to rest, and judges it."""

import json
import threading
from collections.abc import Callable, Mapping, Sequence
from math import inf

from stalls import Stalls

from fault_table.fleet import Fleet
from fault_table.record import MOMENTS, Answer, Struck, ending, stops_short, story, strayed, struck, talked
from fault_table.row import Outcome, Row, within
from mmrs_runtime.orders.channels import Unreachable
from mmrs_runtime.orders.ordering import give

HANDS_OFF_SECONDS = 3.0
"""Seconds of the run after which nothing may be said any more to a vehicle whose pilot has taken over: a
heartbeat shows the mode once a second."""

SURE_SECONDS = 0.0
"""Real seconds after which a pilot must have been noticed, whatever else may be the cause of a new mode."""

ORDER_SECONDS = 1.0
"""Real seconds in which an order must be confirmed, however fast the run goes."""


class Watch:
    """Follows one robot of a fleet, and keeps what became of it.

    Attributes:
        outcome: so far.
    """

    def __init__(self, row: Row, robot: str, fleet: Fleet) -> None:
        """Follow a robot of this name."""
        self.outcome = Outcome(row.title, row.declared)
        self._row, self._robot, self._fleet = row, robot, fleet
        self._stalls = Stalls()
        self._vehicle = fleet.vehicles[robot]
        self._victim = fleet.vehicles[f"g{robot[1:]}"] if row.strikes_peer else self._vehicle
        self._struck: Struck | None = None
        self._mended = row.mends is None
        self._resumed = row.resumes is None
        self._refused = not row.refuses
        self._settled = self._itself = False
        self._rest: tuple[str, float] | None = None
        self._answer: Answer | None = None
        self._threads: list[threading.Thread] = []

    def ready(self) -> bool:
        """Return whether the vehicle is where the row wants it to be struck, and so is the one that is."""
        there = MOMENTS[self._row.during]
        return there(self._vehicle) and there(self._victim)

    def strike(self) -> None:
        """Make it happen."""
        self._stalls = Stalls()
        target, before = self._vehicle.autopilot.body.target, struck(self._vehicle)
        self._row.strike(self._victim)
        after = struck(self._vehicle)
        # A restart changes the mode by itself, which is no answer; a fence's own action is one.
        since = after if self._row.event == "VEHICLE_RESTARTED" else before
        self._answer, self._struck = Answer(self._vehicle, since, target), since
        if self._row.order and not self._row.together:
            self._give(self._row.order)

    def begin(self, itself: bool) -> None:
        """Act from now on, at instants of the vehicle's own time, however late whoever looks on may be.

        Args:
            itself: whether to strike when the vehicle is where it is wanted; else somebody else does.
        """
        self._itself = itself
        self._vehicle.on_tick = self._act

    def _act(self) -> None:
        try:
            if not self._settled:
                self._go_on()
        except Exception as error:
            # It would end the vehicle, and nobody would know why.
            self.outcome.problems.append(f"the table itself fails: {error!r}")

    def _go_on(self) -> None:
        if self._struck is None:
            if self._itself and self.ready():
                self.strike()
            return
        assert self._answer is not None
        self._answer.look()
        self._follow_up(self._vehicle.autopilot.time - self._struck.time)

    def settled(self) -> bool:
        """Return whether nothing more is to come."""
        if self._settled:
            return True
        if self._struck is None:
            return False
        found, now = ending(self._vehicle, self._struck), self._vehicle.autopilot.time
        if not found or self._rest is None or self._rest[0] != found:
            self._rest = (found, now) if found else None
            return False
        stays = found == self._row.rest and now - self._rest[1] > self._row.lasts
        stays = stays and (self._row.within is None or self._answered() is not None)
        if stays and self._mended and self._resumed and self._refused and self._logged():
            self.observe()
        return self._settled

    def observe(self) -> None:
        """Keep what the vehicle has done and what the logs say, before anybody interrupts the process."""
        if self._settled:
            return
        self._settled = True
        for thread in self._threads:
            thread.join(10.0)
        if self._row.together:
            for reply in self._fleet.replies:
                if reply["robot"] in (self._robot, f"g{self._robot[1:]}"):
                    self._judge(str(reply["order"]), reply)
        self._observe_logs()
        problems = self.outcome.problems
        if self._struck is None:
            problems.append(f"never {self._row.during}: {self._vehicle.autopilot.modes}")
            return
        self.outcome.happened = story(self._vehicle, self._struck)
        self.outcome.answered = self._answered()
        self.outcome.rested = self._rest[1] - self._struck.time if self._rest else None
        if (self._rest[0] if self._rest else "") != self._row.rest:
            problems.append(f"does not end as wanted: {self._row.rest}")
        if self._row.stays is not None and strayed(self._vehicle, self._struck) > self._row.stays:
            problems.append(f"goes {strayed(self._vehicle, self._struck):.0f} m away")
        if (
            self._row.ends == "holds"
            and self._row.mends is None
            and not stops_short(self._vehicle, self._struck)
        ):
            problems.append("goes on for longer than it takes to brake")
        if self._row.hands_off:
            self._check_hands_off(self._struck.time + (self._row.mends[0] if self._row.mends else 0.0))
        if self._row.within is not None:
            speedup = self._fleet.speedup
            limit = within(max(self._row.within, self._row.least * speedup), speedup)
            limit += self._stalls.seconds * speedup
            if self.outcome.answered is None or self.outcome.answered > limit:
                problems.append(f"answered after {self.outcome.answered}, not {limit} s")

    def heard(self, said: list[str]) -> None:
        """Keep what the process has said, where that is all there is."""
        if self._row.says:
            found = [line for line in said if self._row.says in line and self._robot in line]
            self.outcome.line = found[0] if found else ""
            if not found:
                self.outcome.problems.append(f"nobody says {self._row.says}")

    def _follow_up(self, since: float) -> None:
        if not self._mended and self._row.mends is not None and since > self._row.mends[0]:
            self._mended = True
            self._row.mends[1](self._victim)
        taken = self._row.mends[0] if self._row.mends is not None else 0.0
        if not self._refused and since > taken + max(HANDS_OFF_SECONDS, SURE_SECONDS * self._fleet.speedup):
            self._refused = True
            self._start(self._ask_in_vain, self._row.refuses)
        if not self._resumed and self._row.resumes is not None and since > self._row.resumes:
            self._resumed = True
            self._give("resume")

    def _give(self, order: str) -> None:
        self._start(self._ask, order)

    def _start(self, ask: Callable[[str], None], order: str) -> None:
        self._threads.append(threading.Thread(target=ask, args=(order,), daemon=True))
        self._threads[-1].start()

    def _ask_in_vain(self, order: str) -> None:
        try:
            replies = list(give(self._fleet.logs, order, [self._robot], seconds=3.0))
        except Unreachable:
            return
        if any(reply.get("confirmed") for reply in replies):
            self.outcome.problems.append(f"{order} is obeyed although a pilot has the vehicle: {replies}")

    def _ask(self, order: str) -> None:
        (reply,) = give(self._fleet.logs, order, [self._robot])
        self._judge(order, reply)

    def _judge(self, order: str, reply: Mapping[str, object]) -> None:
        if not reply.get("confirmed"):
            self.outcome.problems.append(f"{order} is not confirmed: {reply}")
        elif float(str(reply["seconds"])) > ORDER_SECONDS + self._stalls.seconds:
            self.outcome.problems.append(f"{order} is confirmed after {reply['seconds']} s")
        seconds = float(str(reply.get("seconds", inf)))
        self.outcome.confirmed[order] = max(seconds, self.outcome.confirmed.get(order, 0.0))

    def _answered(self) -> float | None:
        assert self._answer is not None
        return self._answer.seconds

    def _logged(self) -> bool:
        if not self._fleet.process.running():
            return True
        steps = self._fleet.steps(self._robot)
        if self._row.ends == "done":
            return _complete(steps)
        if "" in self._row.event.split("|"):
            return True
        return (
            bool(steps)
            and steps[-1]["label"] == "fault"
            and (not self._row.response or bool(self._fitting()))
        )

    def _fitting(self) -> list[dict[str, object]]:
        """Return the lines of the black box that say that the row's response was decided."""
        return [line for line in self._fleet.box(self._robot) if line.get("response") == self._row.response]

    def _check_hands_off(self, since: float) -> None:
        sent = talked(self._vehicle, since + HANDS_OFF_SECONDS)
        self.outcome.happened += f"; heard nothing but heartbeats after {HANDS_OFF_SECONDS:g} s"
        if sent:
            self.outcome.problems.append(f"the pilot is disturbed: {sent[:5]}")

    def _observe_logs(self) -> None:
        steps, row, problems = self._fleet.steps(self._robot), self._row, self.outcome.problems
        faults = [str(step["detail"]).partition(":")[0] for step in steps if step["label"] == "fault"]
        self.outcome.line = json.dumps(steps[-1], ensure_ascii=False) if steps else ""
        if len(faults) > 1 or "".join(faults) not in row.event.split("|"):
            problems.append(f"the step log has faults {faults}, not {row.event or 'none'}")
        elif faults and steps[-1]["label"] != "fault":
            problems.append(f"a step follows the fault: {steps[-1]}")
        if row.ends == "done" and not _complete(steps):
            problems.append("the program was not carried out to its end")
        box = self._fleet.box(self._robot)
        lines = [line for line in box if line["kind"] == ("order" if row.order else "decision")]
        fitting = [line for line in lines if row.response and line.get("response") == row.response]
        self.outcome.decision = json.dumps((fitting or lines or [""])[-1], ensure_ascii=False)
        if row.response and not fitting and "|" not in row.event:
            problems.append(f"the black box has no decision to {row.response}: {lines}")
        if row.order and not any(line["order"] == row.order and line["confirmed"] for line in lines):
            problems.append(f"the black box has no order {row.order}: {lines}")


def _complete(steps: Sequence[Mapping[str, object]]) -> bool:
    return bool(steps) and (steps[-1]["label"], steps[-1]["move"]) == ("end", "stop")
