"""Whether a run keeps what its mission asks for: order, times, crews, equipment, priorities, choices."""

from collections import defaultdict
from math import inf

import numpy as np

from mission_generator.demands import ASIDE, able, arms

NEAR = 1e-3

ROUNDING = 0.1
"""Metres by which a robot on two legs at once, as at corners, may seem to be ahead."""


def breaches(made, program, run, holds, earliest):
    """Yield what a run breaks.

    Args:
        made: the mission, its context and its robot types.
        program: what was run.
        run: with every condition answered alike.
        holds: that answer.
        earliest: when moves may begin at the earliest, by robot and index.
    """
    tasks = {task.name: task for task in made.mission.tasks if task.eClass.name not in ASIDE}
    crews, soonest = defaultdict(set), {}
    for robot in program.robots:
        for index, move in enumerate(robot.moves):
            if move.works:
                crews[move.task].add(robot.id)
                begin = earliest.get((robot.id, index), inf)
                soonest[move.task] = min(begin, soonest.get(move.task, inf))
    spans = _spans(program, run)
    whole = {
        name: (min(begin for begin, _ in own.values()), max(end for _, end in own.values()))
        for name, own in spans.items()
    }
    before = {name: _before(made.mission, name) for name in tasks}
    yield from _undone(made.mission, tasks, whole, crews, holds)
    yield from _crews(made, tasks, crews)
    yield from _times(tasks, whole, soonest, before)
    yield from _priorities(tasks, spans, whole, before)
    yield from _hastes(made, run.tracks)


def _spans(program, run):
    """Return (begin, end) of the work of each robot on each task that was done: by task, then by robot."""
    serves = {
        (robot.id, move.id): move.task for robot in program.robots for move in robot.moves if move.works
    }
    spans = defaultdict(dict)
    for record in run.records:
        task = serves.get((record.robot, record.move))
        if task and record.label in ("act", "begin", "end"):
            begin, _ = spans[task].get(record.robot, (record.time, None))
            spans[task][record.robot] = (begin, record.time)
    return spans


def _before(mission, task):
    """Return the names of all tasks that must have ended before one."""
    direct = {each.from_.name for each in mission.taskDependencies if each.to.name == task}
    return direct.union(*(_before(mission, each) for each in direct))


def _undone(mission, tasks, whole, crews, holds):
    """Yield tasks that are not done, or done though their condition does not hold."""
    chosen = arms(mission)
    left = [each.to.name for each in chosen if bool(each.condition) is not holds]
    taken = [each.to.name for each in chosen if bool(each.condition) is holds]
    if (chosen and sum(name in whole for name in taken) != 1) or any(name in whole for name in left):
        yield f"of the tasks {taken}, not {left}, one should be done, not of {sorted(whole)}"
    if len(set().union(*(crews[each.to.name] for each in chosen))) > 1:
        yield "arms of one choice are done by several robots"
    yield from (f"'{name}' is not done" for name in tasks if name not in {*whole, *taken, *left})


def _crews(made, tasks, crews):
    types = {robot.name: made.robots[robot.type] for robot in made.mission.team.robots}
    for name, task in tasks.items():
        if task.robotsWanted not in (None, len(crews[name])):
            yield f"'{name}' is done by {sorted(crews[name])}, not by {task.robotsWanted} robots"
        unable = [robot for robot in sorted(crews[name]) if not able(task, types[robot])]
        if unable:
            yield f"'{name}' is done by {unable}, without what it requires"


def _times(tasks, whole, soonest, before):
    for name, task in tasks.items():
        begin, end = whole.get(name, (0.0, 0.0))
        if soonest.get(name, inf) < (task.earliestStart or 0.0) - NEAR:
            yield f"'{name}' may begin at {soonest[name]:.3f} s, before {task.earliestStart:g} s"
        if end > (task.deadline or inf) + NEAR:
            yield f"'{name}' ends at {end:.3f} s, after {task.deadline:g} s"
        if end - begin > (task.maxDuration or inf) + NEAR:
            yield f"'{name}' takes {end - begin:.3f} s, more than {task.maxDuration:g} s"
        for other in before[name] & whole.keys() if name in whole else ():
            if whole[other][1] > begin + NEAR:
                yield f"'{name}' begins at {begin:.3f} s, before '{other}' has ended"


def _priorities(tasks, spans, whole, before):
    """Yield tasks that a robot does before others of higher priority that could have come next."""
    for robot in {robot for own in spans.values() for robot in own}:
        own = sorted((spans[name][robot], name) for name in spans if robot in spans[name] and name in tasks)
        free = 0.0
        for index, ((_, end), name) in enumerate(own):
            for _, later in own[index + 1 :]:
                task, ends = tasks[later], [whole[each][1] for each in before[later] & whole.keys()]
                ready = max([*ends, task.earliestStart or 0.0])
                if task.priority > tasks[name].priority and ready <= free:
                    yield f"'{robot}' does '{name}' before '{later}', which has priority"
            free = end


def _hastes(made, tracks):
    """Yield robots that are quicker than those of their type with so much payload can be."""
    for robot in (each for each in made.mission.team.robots if each.name in tracks):
        able = [c for c in made.robots[robot.type].movementCapabilities if c.payloadWeight >= robot.payload]
        fastest = min(able, key=lambda each: each.payloadWeight).speed.max
        rows = np.array([(each.time, each.east, each.north) for each in tracks[robot.name]])
        seconds, *ways = np.diff(rows, axis=0).T
        over = (np.hypot(*ways) - fastest * seconds).max(initial=0.0)
        if over > ROUNDING:
            yield f"'{robot.name}' is {over:.3f} m ahead of its largest speed, {fastest:g} m/s"
