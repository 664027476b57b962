"""From a recorded schedule to a plan: the final returns home, signals and figures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from mmrs_core.planning.corridors import crossings
from mmrs_core.planning.jobs import Job, is_control
from mmrs_core.planning.omissions import omissions_of
from mmrs_core.planning.schedule import Decisions, Schedule, Shortfall, schedule, signal_name
from mmrs_core.planning.search import broken_times
from mmrs_core.planning.states import State
from mmrs_core.planning.team import Team, homebound_of
from mmrs_core.scene import Await, Branch, Plan, RobotPlan, Scene, Serve, Signal, Step, all_steps
from mmrs_core.scene.attributes import number

_NOTES = (
    "the terrain is flat at the origin's height",
    "energy is the power against the wind or current times the time on one charge",
)


_MOST_NAMES = 20
"""Tasks that are named with one reason."""


def assemble(team: Team, jobs: Sequence[Job], found: Schedule) -> Plan:
    """Return the plan of a schedule whose states carry all steps."""
    finished = {
        name: team.pilots[name].finish(found.states[name]) for name in team.pilots if name in found.backs
    }
    steps = {name: state.steps() for name, state in finished.items()}
    signals = {
        signal_name(job.name, robot): (job.name, robot) for job in jobs for robot in found.ends[job.name]
    }
    steps = _with_signals(steps, signals)
    spans = spans_of(team.scene, steps)
    return Plan(
        robots=tuple(_robot_plan(team, name, steps, finished) for name in team.pilots),
        makespan=max((state.time for state in finished.values()), default=0.0),
        begins={name: begin for name, (begin, _) in spans.items()},
        ends={name: end for name, (_, end) in spans.items()},
        left_out=omissions_of(team.scene, steps),
        notes=(
            *_stranded(team, found),
            *_past_corridors(team.scene, steps),
            *_of_works(team.scene, steps),
            *_unstated_flow(team.scene),
            *_NOTES,
        ),
    )


def planned(team: Team, jobs: Sequence[Job], decisions: Decisions) -> Plan | None:
    """Return the plan of decisions, before robots are kept apart; None where they lead to none."""
    found = schedule(team, jobs, decisions, record=True)
    if isinstance(found, Shortfall) or broken_times(team, found.spans):
        return None
    return assemble(team, jobs, found)


def _of_works(scene: Scene, steps: Mapping[str, tuple[Step, ...]]) -> Iterator[str]:
    """Yield the notes of works that the plan contains; robots that share a note in one line."""
    found: dict[tuple[str, str], dict[str, None]] = {}
    for robot, mine in steps.items():
        for serve in (each for each in all_steps(mine) if isinstance(each, Serve)):
            for note in scene.works[serve.task, robot].notes:
                found.setdefault((serve.task, note), {})[robot] = None
    for (task, note), robots in found.items():
        yield f"task '{task}', {', '.join(robots)}: {note}"


def _past_corridors(scene: Scene, steps: Mapping[str, tuple[Step, ...]]) -> Iterator[str]:
    """Yield where robots go past corridors from task to task."""
    for name, mine in steps.items():
        yield from crossings(name, all_steps(mine), scene.corridors_of(scene.robot(name)))


def _unstated_flow(scene: Scene) -> Iterator[str]:
    """Yield each wind or current that robots travel in and the context does not state."""
    flies = any(each.kinematics is not None and each.kinematics.launches for each in scene.robots)
    dives = any(number(each.type.part, "maxOperatingPressure") is not None for each in scene.robots)
    if flies and "windSpeed" not in scene.environment:
        yield "the context states no windSpeed: this is a plan for calm air"
    if dives and "currentSpeed" not in scene.environment:
        yield "the context states no currentSpeed: this is a plan for still water"


def _stranded(team: Team, schedule: Schedule) -> Iterator[str]:
    """Yield each robot that a low battery sends home and that ends too far away to return."""
    for name in sorted(homebound_of(team.scene) - team.homebound):
        pilot, state = team.pilots[name], schedule.states[name]
        if state.away and not pilot.affords_home(state, 0.0, state.at):
            yield (
                f"robot '{name}' ends where its charge does not suffice to go home:"
                " give it another response to BATTERY_LOW than to return, such as LAND"
            )


def _robot_plan(
    team: Team, name: str, steps: Mapping[str, tuple[Step, ...]], finished: Mapping[str, State]
) -> RobotPlan:
    if name not in finished:
        return RobotPlan(name, (), idle=why_idle(team, name))
    end = finished[name]
    kinematics = team.pilots[name].kinematics
    energy = kinematics.power * kinematics.draw * end.busy if kinematics.power > 0.0 else None
    return RobotPlan(name, steps[name], end.length, end.busy, energy, end.sorties)


def _with_signals(
    steps: Mapping[str, tuple[Step, ...]], signals: Mapping[str, tuple[str, str]]
) -> dict[str, tuple[Step, ...]]:
    receivers: dict[str, list[str]] = {}
    for robot, mine in steps.items():
        for step in mine:
            for signal in step.signals if isinstance(step, Await) else ():
                receivers.setdefault(signal, []).append(robot)
    given: dict[str, list[tuple[int, Signal]]] = {name: [] for name in steps}
    for signal, names in receivers.items():
        job, sender = signals[signal]
        place = _end_of(steps[sender], job)
        time = steps[sender][place].end
        given[sender].append((place, Signal(time, time, job, signal, tuple(dict.fromkeys(names)))))
    return {name: _inserted(mine, given[name]) for name, mine in steps.items()}


def _end_of(steps: Sequence[Step], job: str) -> int:
    return max(i for i, step in enumerate(steps) if isinstance(step, Serve | Branch) and step.task == job)


def _inserted(steps: Sequence[Step], signals: Iterable[tuple[int, Signal]]) -> tuple[Step, ...]:
    after: dict[int, list[Signal]] = {}
    for place, signal in signals:
        after.setdefault(place, []).append(signal)
    return tuple(each for i, step in enumerate(steps) for each in (step, *after.get(i, ())))


def spans_of(scene: Scene, steps: Mapping[str, tuple[Step, ...]]) -> dict[str, tuple[float, float]]:
    """Return when each task of a plan begins and ends."""
    spans: dict[str, tuple[float, float]] = {}
    for mine in steps.values():
        for serve in (each for each in all_steps(mine) if isinstance(each, Serve)):
            begin, end = spans.get(serve.task, (serve.begin, serve.end))
            spans[serve.task] = (min(begin, serve.begin), max(end, serve.end))
        spans |= {step.task: (step.begin, step.begin) for step in mine if isinstance(step, Branch)}
    for task in scene.tasks:
        if is_control(task) and task.name not in spans:
            time = _control_time(scene, task.name, spans)
            spans[task.name] = (time, time)
    return {task.name: spans[task.name] for task in scene.tasks if task.name in spans}


def _control_time(scene: Scene, name: str, spans: Mapping[str, tuple[float, float]]) -> float:
    """Return when a Fork or Join ends: when all before it have."""
    before = [edge.before for edge in scene.dependencies if edge.after == name]
    times = [
        spans[each][1] if each in spans else _control_time(scene, each, spans)
        for each in before
        if each in spans or is_control(scene.task(each))
    ]
    return max(times, default=0.0)


def why_idle(team: Team, robot: str) -> str:
    """Return why no task of the plan is a robot's; a reason is said once, with some of the tasks' names."""
    reasons: dict[str, list[str]] = {}
    for task in team.groups:
        reasons.setdefault(_reason(team, task, robot), []).append(task)
    return "; ".join(f"{_some(tasks)}: {reason}" for reason, tasks in reasons.items())


def idle_apart(scene: Scene, plan: Plan, tried: Mapping[tuple[RobotPlan, ...], float]) -> Plan:
    """Return a plan with the reason of each robot that has no work only because robots keep apart.

    That is known where every plan that was found without it ends later, before its robots are kept apart,
    than one with it.

    Args:
        scene: of the plan.
        plan: as its robots keep apart.
        tried: makespans of plans before that, by what their robots do.
    """
    if scene.minimum_separation is None:
        return plan
    soonest = dict[tuple[str, bool], float]()
    for robots, makespan in tried.items():
        for each in robots:
            key = each.robot, not each.steps
            soonest[key] = min(soonest.get(key, plan.makespan), makespan)

    def explained(each: RobotPlan) -> RobotPlan:
        with_it, without = (soonest.get((each.robot, idle), plan.makespan) for idle in (False, True))
        if not each.idle or round(without - with_it) <= 0:
            return each
        reason = f"it would make the mission end {without - with_it:.0f} s sooner if robots did not keep"
        return replace(each, idle=f"{each.idle}; {reason} {scene.minimum_separation:g} m apart")

    return replace(plan, robots=tuple(map(explained, plan.robots)))


def _some(tasks: Sequence[str]) -> str:
    more = f" and {len(tasks) - _MOST_NAMES} more" if len(tasks) > _MOST_NAMES else ""
    return ", ".join(f"'{task}'" for task in tasks[:_MOST_NAMES]) + more


def _reason(team: Team, task: str, robot: str) -> str:
    if team.forwards(task, robot) is None:
        return team.refusal(task, robot) or "it cannot do the task"
    if team.whole(task) and len(team.able(task)) > 1:
        return "one robot must do all of it, and the mission ends no later with another one"
    wanted = team.asked[task]
    others = [name for name in team.able(task) if name not in team.sharing_with(task, robot)]
    apart = (
        f"; it cannot share it with {', '.join(others)}, whose work is laid out otherwise" if others else ""
    )
    if wanted is not None:
        return f"the task wants {wanted}, and other robots have it{apart}"
    return f"no plan was found in which it makes the mission end sooner{apart}"
