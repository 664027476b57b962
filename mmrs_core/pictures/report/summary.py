"""The first words of a report: how it went, at a glance."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.preview.markup import element, text
from mmrs_core.pictures.report.values import Report, Status
from mmrs_core.pictures.report.words import metres, percent, spoken
from mmrs_runtime.policies import EVENTS


def verdict(report: Report) -> str:
    """Return one sentence on how it went, in its colour."""
    words, kind = _verdict(report)
    return element("p", {"class": f"verdict {kind}"}, text(words))


def _verdict(report: Report) -> tuple[str, str]:
    asked = [task for task in report.tasks if task.status is not Status.NOT_CHOSEN]
    done = sum(task.status is Status.DONE for task in asked)
    ended = sum(robot.ended_early for robot in report.robots)
    near = any(each.too_near for each in report.approaches)
    near = near or any(each.too_near for each in report.separations)
    whole = "all robots came to the end of their programs" if report.outcome == "success" else ""
    tasks = f"{done} of {len(asked)} tasks done" if asked else whole
    early = f"{ended} robot{'s' * (ended != 1)} ended early" if ended else ""
    close = "a required distance was not kept" if near else ""
    empty = any(e.lowest is not None and e.lowest < e.reserve - 0.005 for e in report.energies)
    low = "a battery fell under the reserve" if empty else ""
    strange = "the logs are no run of this behaviour" if report.complaints else ""
    unfinished = "not all programs came to their end" if report.outcome != "success" and not ended else ""
    words = "; ".join(each for each in (tasks, early, unfinished, close, low, strange) if each)
    if near or strange or (asked and not done):
        return words, "bad"
    words = words or "nothing is known of how it ended"
    return words, "good" if done == len(asked) and report.outcome == "success" and not empty else "fair"


def tiles(report: Report) -> str:
    """Return the figures that people ask for first."""
    return element("dl", {"class": "tiles"}, (_tile(name, value) for name, value in _figures(report)))


def _tile(name: str, value: str) -> str:
    return element("div", None, element("dt", None, text(name)), element("dd", None, text(value)))


def _figures(report: Report) -> Iterator[tuple[str, str]]:
    yield "time", clock(report.duration)
    ways = [robot.way for robot in report.robots if robot.way is not None]
    yield "way of all robots", metres(sum(ways)) if len(ways) == len(report.robots) else "not known"
    if report.deviations:
        worst = max(report.deviations, key=lambda each: each.sideways.largest)
        yield "farthest off the way", f"{metres(worst.sideways.largest)} ({worst.robot})"
    judged = [each for each in report.approaches if each.required is not None]
    if judged:
        nearest = min(judged, key=lambda each: each.kept - (each.required or 0.0))
        allowed = f", {nearest.error:g} m of it for errors" if nearest.error else ""
        kept = f"{nearest.kept:.2f} m of {nearest.required:.2f} m required{allowed}"
        yield "nearest to what to keep off", f"{kept} ({nearest.robot}, {nearest.area})"
    lowest = [(each.lowest, each.robot) for each in report.energies if each.lowest is not None]
    if lowest:
        part, robot = min(lowest)
        yield "emptiest battery", f"{percent(part)} ({robot})"
    if report.photos and not report.simulated:
        taken = sum(photo.state == "taken" for photo in report.photos)
        yield "photos confirmed", f"{taken} of {len(report.photos)}"
    yield "faults", _faults(report)


def _faults(report: Report) -> str:
    """Return how many faults there were, and which: those that ended programs, or were answered."""
    ended = [(e.robot, e.what.partition(":")[0]) for e in report.events if e.kind == "fault"]
    decided = [(e.robot, e.what) for e in report.events if e.kind == "decision" and e.what in EVENTS]
    faults = [*ended, *(each for each in decided if each not in ended)]
    names = dict.fromkeys(spoken(name) for _, name in faults)
    return f"{len(faults)} ({', '.join(names)})" if faults else "none"
