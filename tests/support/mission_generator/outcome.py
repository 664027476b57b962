"""What the whole chain makes of a random mission, judged by code that shares nothing with it."""

import time
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from itertools import combinations
from math import dist, inf

import numpy as np
import shapely

from mission_generator.demands import arms
from mission_generator.keeping import breaches
from mission_generator.missions import LARGEST, sample
from mission_generator.names import CONTEXT, DRONE, MISSION, SURVEY
from mission_generator.photos import GRID_TASK, coverage, odd_photos, photos_of
from mmrs_core import pipeline
from mmrs_core.analysis.constraints import check_behaviour
from mmrs_core.analysis.times import times_of
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.errors import InfeasibleError, InvalidModelError
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import write_model
from mmrs_core.stages import Stages
from mmrs_runtime.semantics import Outcome as Outcomes

NEAR = 1e-3
"""Metres by which a track may come nearer than allowed: the rounding of coordinates in a file."""


POINT_TASK, ORBIT_TASK = (MISSION, "PointTask"), (SURVEY, "OrbitTask")

THERE = 0.1
"""Metres from where it is to stay within which a robot counts as a relay."""

SHARES = (0.0, 0.25, 0.5, 0.75)
"""Of each stretch of a track, the places that are looked at."""


@dataclass
class Outcome:
    """What became of one mission.

    `refused` is why it was refused, empty if it was not. `complaints` are broken promises.
    `separation` is the metres that its robots must keep apart, 0 if none are asked for.
    `coverage` is the share of each polygon task's target that was covered; `largest`, the robots and tasks
    that the mission could have at most.
    """

    seed: int
    solvable: bool
    refused: str = ""
    complaints: list[str] = field(default_factory=list)
    coverage: dict[str, float] = field(default_factory=dict)
    seconds: float = 0.0
    makespan: float = 0.0
    separation: float = 0.0
    largest: tuple[int, int] = LARGEST


def outcome_of(seed, contributions, folder, largest=LARGEST):
    """Return what becomes of the random mission of that seed; its files are written to the folder."""
    made = sample(seed, contributions.languages, largest)
    apart = made.mission.minimumSeparation or 0.0
    outcome = Outcome(seed, made.witness is not None, separation=apart, largest=largest)
    started = time.process_time()
    write_project(made, contributions.languages, folder)
    try:
        _carry_out(made, folder, contributions, outcome)
    except InvalidModelError as error:
        outcome.refused = "; ".join(f"{fault.code} {fault.message}" for fault in error.diagnostics)
    except InfeasibleError as error:
        outcome.refused = "; ".join(error.reasons)
    outcome.seconds = time.process_time() - started
    return outcome


def write_project(made, registry, folder):
    """Write mission, context and robot types as a project folder."""
    (folder / "robots").mkdir(parents=True, exist_ok=True)
    write_model((made.mission,), folder / "mission.xmi", registry)
    write_model((made.context,), folder / "context.xmi", registry)
    for name, robot in made.robots.items():
        write_model((robot,), folder / "robots" / f"{name}.xmi", registry)


def _carry_out(made, folder, contributions, outcome):
    models, _ = pipeline.valid_models(folder, contributions)
    stages = Stages(lambda: models, contributions)
    scene, plan = stages.scene, stages.plan
    if plan.lower_bound > plan.makespan + 1e-3:
        outcome.complaints.append(f"lower bound of {plan.lower_bound} s above {plan.makespan} s")
    pipeline.save(stages.transformed[0], folder / "behaviour.xmi", contributions)
    behaviour = _read_again(folder / "behaviour.xmi", models, contributions, outcome)
    program = pipeline.program_of(behaviour, contributions)
    place = pipeline.place_of_scene(scene)
    against = pipeline.refusals(pipeline.verify(program, place, contributions), program)
    outcome.complaints += [f"verify: {each.property} {each.status.value}: {each.message}" for each in against]
    choices = {each.condition for each in arms(made.mission) if each.condition}
    for holds in (True, False) if choices else (True,):
        run = pipeline.simulate(program, place, contributions, assume=dict.fromkeys(choices, holds))
        replayed = replay(program, run.records)
        outcome.complaints += [f"replay: {complaint}" for complaint in replayed.complaints]
        if replayed.outcome is not Outcomes.SUCCESS:
            outcome.complaints.append(f"replay: ends with {replayed.outcome}; {run.ending}")
        outcome.makespan = max(outcome.makespan, run.ending.time)
        outcome.complaints += list(_intrusions(scene, run.tracks))
        outcome.complaints += list(_silences(scene, run.tracks, program))
        outcome.complaints += list(_overdrafts(scene, run.tracks))
        outcome.complaints += list(_approaches(scene, run.tracks))
        outcome.complaints += list(
            breaches(made, program, run, holds, _earliest(program, place, contributions))
        )
    outcome.complaints += list(_repetitions(scene, program))
    outcome.complaints += list(odd_photos(scene, program, outcome.solvable))
    outcome.coverage = dict(coverage(scene, program))
    for task, share in outcome.coverage.items():
        if share < 0.999:
            outcome.complaints.append(f"coverage of '{task}': {share:.5f}")


def _earliest(program, place, contributions):
    """Return when moves may begin at the earliest, by robot and index."""
    kinds = {"robot_kinds": contributions.robot_kinds, "move_kinds": contributions.move_kinds}
    return times_of(CheckInput(program, place.types, environment=place.environment or {}, **kinds)).earliest


def _read_again(file, models, contributions, outcome):
    """Return the behaviour as it stands in its file; what breaks a constraint is a complaint."""
    model = read_model(file, contributions.languages)
    (behaviour,) = model.roots
    faults = check_behaviour(
        behaviour,
        contributions.constraints,
        contributions.languages,
        robots=models.robots,
        place=models.context,
    )
    outcome.complaints += [f"behaviour: {fault}" for fault in (*model.diagnostics, *faults)]
    return behaviour


def _intrusions(scene, tracks):
    """Yield where a track comes nearer to an area than allowed, by distances in the plane.

    Below and above an obstacle the vertical distance alone is looked at, which is never more than
    what was asked for.
    """
    for name, track in tracks.items():
        areas = list(scene.kept_from(scene.robot(name)))
        own = scene.robot(name).clearance
        points = np.array([(sample.east, sample.north, sample.up) for sample in track])
        for area in areas:
            keep = own + area.safety_distance
            low, high = area.low - keep + NEAR, area.high + keep - NEAR
            shape = shapely.Polygon(area.shell)
            near = _parts_between(points, low, high)
            distances = shapely.distance(shape, near) if len(near) else np.array([inf])
            if distances.min() < keep - NEAR:
                yield f"track of '{name}' comes to {distances.min():.3f} m of '{area.name}', not {keep:.3f} m"


def _approaches(scene, tracks):
    """Yield where two robots come nearer to each other than the mission allows, at any time."""
    if scene.minimum_separation is None:
        return
    times = np.unique([sample.time for track in tracks.values() for sample in track])
    places = {}
    for name, track in tracks.items():
        own = np.array([(sample.time, sample.east, sample.north, sample.up) for sample in track])
        places[name] = np.stack([np.interp(times, own[:, 0], own[:, axis]) for axis in (1, 2, 3)], axis=1)
    for one, two in combinations(places, 2):
        apart = places[two] - places[one]
        step = np.diff(apart, axis=0)
        squares = np.maximum((step**2).sum(axis=1), 1e-12)
        share = np.clip(-(apart[:-1] * step).sum(axis=1) / squares, 0.0, 1.0)
        nearest = np.linalg.norm(apart[:-1] + share[:, None] * step, axis=1).min(initial=inf)
        least = scene.minimum_separation
        if nearest < least - NEAR:
            yield f"'{one}' and '{two}' come to {nearest:.3f} m of each other, not {least:g} m"


def _silences(scene, tracks, program):
    """Yield where a robot is out of range of its home and of all relays that a chain leads to at that time.

    Robots that are relays count as long as they are at their places.
    """
    relays = [each.attributes for each in scene.elements if each.is_a((CONTEXT, "Relay"))]
    still = [(each["position"], each["range"]) for each in relays]
    hovering = [*_hovering(scene, program)]
    for name, track in tracks.items():
        robot = scene.robot(name)
        reach = robot.type.part.attributes["communicationRange"]
        rows = np.array([(sample.time, sample.east, sample.north, sample.up) for sample in track])
        rows = np.concatenate([rows + share * (np.roll(rows, -1, axis=0) - rows) for share in SHARES])
        rows = rows.reshape(len(SHARES), -1, 4)[:, :-1].reshape(-1, 4)
        there = [_is_there(tracks[other], rows[:, 0], at) & (other != name) for other, at, _ in hovering]
        known = np.array(there, dtype=bool).reshape(len(hovering), len(rows)).T
        for held in {tuple(row) for row in known.tolist()}:
            others = [(at, range) for (_, at, range), is_held in zip(hovering, held, strict=True) if is_held]
            places = rows[(known == held).all(axis=1), 1:]
            balls = _chained(robot.home, reach, [*still, *others])
            beyond = np.min(
                [np.linalg.norm(places - at, axis=1) - min(range, reach) for at, range in balls], axis=0
            )
            if beyond.max(initial=-inf) > NEAR:
                at = places[beyond.argmax()].round(1).tolist()
                yield f"'{name}' is {beyond.max():.3f} m out of range at {at}"


def _hovering(scene, program):
    """Yield (robot, place, range) of each that is a relay."""
    for task in scene.tasks:
        if task.part.is_a((SURVEY, "RelayTask")):
            (robot,) = {r.id for r in program.robots if any(move.task == task.name for move in r.moves)}
            type = scene.robot(robot).type.part
            yield robot, task.part.attributes["point"], type.attributes["relayRange"]


def _is_there(track, times, at):
    rows = np.array([(sample.time, sample.east, sample.north, sample.up) for sample in track])
    places = np.stack([np.interp(times, rows[:, 0], rows[:, axis]) for axis in (1, 2, 3)], axis=1)
    return np.linalg.norm(places - at, axis=1) < THERE


def _chained(home, reach, left):
    balls = [(home, reach)]
    for at, range in balls:
        near = [each for each in left if dist(each[0], at) <= min(each[1], range)]
        balls += near
        left = [each for each in left if each not in near]
    return balls


def _overdrafts(scene, tracks):
    """Yield where a robot uses up some of the reserve that it must keep."""
    for name, track in tracks.items():
        full = sum(battery.energy for battery in scene.robot(name).type.batteries)
        least = min(sample.energy for sample in track)
        if least < full * scene.reserve * (1.0 - NEAR):
            yield f"'{name}' has {least:.0f} J left, not {full * scene.reserve:.0f} J"


def _parts_between(points, low, high):
    """Return the parts of a track between two heights as lines in the plane."""
    starts, ends = points[:-1], points[1:]
    rise = ends[:, 2] - starts[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        to_low, to_high = (low - starts[:, 2]) / rise, (high - starts[:, 2]) / rise
    flat = rise == 0
    inside = (starts[:, 2] > low) & (starts[:, 2] < high)
    enter = np.where(flat, np.where(inside, 0.0, 2.0), np.clip(np.fmin(to_low, to_high), 0.0, None))
    leave = np.where(flat, np.where(inside, 1.0, -1.0), np.clip(np.fmax(to_low, to_high), None, 1.0))
    kept = enter < leave
    begin = starts[kept, :2] + (ends - starts)[kept, :2] * enter[kept, None]
    end = starts[kept, :2] + (ends - starts)[kept, :2] * leave[kept, None]
    return shapely.linestrings(np.stack([begin, end], axis=1)) if kept.any() else np.array([])


def _repetitions(scene, program):
    """Yield what is done twice: a photo of a task at one place, or a task at a point in several sorties."""
    parts, photos, sorties = defaultdict(set), defaultdict(set), Counter()
    for robot in program.robots:
        for move in robot.moves:
            sorties[robot.id] += move.is_a((DRONE, "TakeOff"))
            if move.works:
                parts[move.task].add((robot.id, sorties[robot.id]))
        for task, at, *leg in photos_of(robot):
            photos[task].add((*np.round(at, 2), *leg))
    for task in scene.tasks:
        own = sorted(parts[task.name])
        if task.part.is_a(POINT_TASK) and not task.part.is_a(ORBIT_TASK) and len(own) != 1:
            yield f"'{task.name}' is done in {len(own)} sorties: {own}"
        if task.part.is_a(GRID_TASK) and not task.part.attributes["crossHatch"]:
            places = [each[:3] for each in photos[task.name]]
            twice = len(places) - len(set(places))
            cuts = sum(sorties[name] for name in {robot for robot, _ in own})
            if twice > cuts:  # where a swath is cut, its last photo is repeated
                yield f"{twice} photos of '{task.name}' are made twice"
