"""From a recorded schedule to a plan: the last ways home, the signals, the figures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from mmrs_core.planning.crew import Crew, homebound_of
from mmrs_core.planning.idleness import why_idle
from mmrs_core.planning.jobs import Job, is_control
from mmrs_core.planning.left_out import left_out
from mmrs_core.planning.schedule import Schedule, signal_name
from mmrs_core.planning.states import State
from mmrs_core.scene import Await, Branch, Plan, RobotPlan, Scene, Serve, Signal, Step
from mmrs_core.scene.attributes import number

_NOTES = (
    "the terrain is flat at the origin's height",
    "times count a stop at the end of every leg, but not turning on the spot towards the next",
    "energy is the power against the wind or current times the time on one charge",
)


def assemble(crew: Crew, jobs: Sequence[Job], schedule: Schedule) -> Plan:
    """Return the plan of a schedule whose states carry all steps."""
    finished = {
        name: crew.pilots[name].finish(schedule.states[name])
        for name in crew.pilots
        if name in schedule.backs
    }
    steps = {name: state.steps() for name, state in finished.items()}
    signals = {
        signal_name(job.name, robot): (job.name, robot) for job in jobs for robot in schedule.ends[job.name]
    }
    steps = _with_signals(steps, signals)
    spans = _spans(crew.scene, steps, schedule)
    return Plan(
        robots=tuple(_robot_plan(crew, name, steps, finished) for name in crew.pilots),
        makespan=max((state.time for state in finished.values()), default=0.0),
        begins={name: begin for name, (begin, _) in spans.items()},
        ends={name: end for name, (_, end) in spans.items()},
        left_out=left_out(crew.scene, steps),
        notes=(*_of_no_return(crew, schedule), *_of_calm(crew.scene), *_NOTES),
    )


def _of_calm(scene: Scene) -> Iterator[str]:
    """Yield which wind or current that robots travel in nobody states."""
    flies = any(each.kinematics is not None and each.kinematics.launches for each in scene.robots)
    dives = any(number(each.type.part, "maxOperatingPressure") is not None for each in scene.robots)
    if flies and "windSpeed" not in scene.environment:
        yield "the context states no windSpeed: this is a plan for calm air"
    if dives and "currentSpeed" not in scene.environment:
        yield "the context states no currentSpeed: this is a plan for still water"


def _of_no_return(crew: Crew, schedule: Schedule) -> Iterator[str]:
    """Yield which robots end where they could not get home from, though a low battery sends them there."""
    for name in sorted(homebound_of(crew.scene) - crew.homebound):
        pilot, state = crew.pilots[name], schedule.states[name]
        if state.away and not pilot.affords_home(state, 0.0, state.at):
            yield (
                f"robot '{name}' ends where its charge does not suffice to go home:"
                " give it another response to BATTERY_LOW than to return, such as LAND"
            )


def _robot_plan(
    crew: Crew, name: str, steps: Mapping[str, tuple[Step, ...]], finished: Mapping[str, State]
) -> RobotPlan:
    if name not in finished:
        return RobotPlan(name, (), idle=why_idle(crew, name))
    end = finished[name]
    kinematics = crew.pilots[name].kinematics
    energy = kinematics.power * kinematics.draw * end.busy if kinematics.power > 0.0 else None
    return RobotPlan(name, steps[name], end.length, end.busy, energy, end.sorties)


def _with_signals(
    steps: Mapping[str, tuple[Step, ...]], signals: Mapping[str, tuple[str, str]]
) -> dict[str, tuple[Step, ...]]:
    """Have every robot that others wait for give its signals, right after its share has ended."""
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
    """Return the index of the step with which a robot's share of a job ends."""
    return max(i for i, step in enumerate(steps) if isinstance(step, Serve | Branch) and step.task == job)


def _inserted(steps: Sequence[Step], signals: Iterable[tuple[int, Signal]]) -> tuple[Step, ...]:
    after: dict[int, list[Signal]] = {}
    for place, signal in signals:
        after.setdefault(place, []).append(signal)
    return tuple(each for i, step in enumerate(steps) for each in (step, *after.get(i, ())))


def _spans(
    scene: Scene, steps: Mapping[str, tuple[Step, ...]], schedule: Schedule
) -> dict[str, tuple[float, float]]:
    """Return when each task begins and ends, control tasks included."""
    spans: dict[str, tuple[float, float]] = {}
    for mine in steps.values():
        for serve in _serves(mine):
            begin, end = spans.get(serve.task, (serve.begin, serve.end))
            spans[serve.task] = (min(begin, serve.begin), max(end, serve.end))
    for task in scene.tasks:
        if is_control(task):
            time = _control_time(scene, task.name, spans, schedule)
            spans[task.name] = (time, time)
    return {task.name: spans[task.name] for task in scene.tasks if task.name in spans}


def _serves(steps: Iterable[Step]) -> Iterator[Serve]:
    for step in steps:
        if isinstance(step, Serve):
            yield step
        elif isinstance(step, Branch):
            for _, arm in step.arms:
                yield from _serves(arm)


def _control_time(
    scene: Scene, name: str, spans: Mapping[str, tuple[float, float]], schedule: Schedule
) -> float:
    """Return when a Fork or Join ends: when all before it have."""
    if name in schedule.spans:
        return schedule.spans[name][0]
    before = [way.before for way in scene.dependencies if way.after == name]
    times = [
        _control_time(scene, each, spans, schedule) if is_control(scene.task(each)) else spans[each][1]
        for each in before
        if is_control(scene.task(each)) or each in spans
    ]
    return max(times, default=0.0)
