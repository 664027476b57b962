"""Whether photos are where a mission asks for them: over areas and corridors, along lines and circles."""

from collections import defaultdict
from itertools import combinations

import numpy as np
import shapely

from mission_generator.names import SURVEY
from mmrs_core.behaviour.program import BEHAVIOUR

GRID, NEAR = 1e-6, 1e-3
GRID_TASK = (SURVEY, "PhotoGridTask")
CORNERS = {"NORTH_WEST": (-1.0, 1.0), "SOUTH_EAST": (1.0, -1.0)}


def coverage(scene, program):
    """Yield each polygon task's name and the share of its target that lies in footprints less their overlaps.

    Of a cross hatch, the share that lies in footprints of both directions.
    """
    prints, robots = defaultdict(lambda: defaultdict(list)), defaultdict(set)
    for robot in program.robots:
        for task, angle, shape in _footprints(scene, robot):
            prints[task][angle].append(shape)
            robots[task].add(robot.id)
    for task in scene.tasks:
        if task.part.is_a(GRID_TASK):
            if not robots[task.name]:
                yield task.name, 0.0
                continue
            target = _target(scene, task, robots[task.name])
            covered = _covered(prints[task.name], task.part.attributes["crossHatch"])
            common = shapely.intersection(target, covered, grid_size=GRID)
            yield task.name, common.area / target.area if target.area else 1.0


def _covered(prints, twice):
    """Return what footprints cover, by their angles; twice: in two directions across each other."""
    if not twice:
        return shapely.union_all([shape for each in prints.values() for shape in each], grid_size=GRID)
    facing = {angle: each for angle, each in prints.items() if angle is not None}
    layers = {angle: shapely.union_all(each, grid_size=GRID) for angle, each in facing.items()}
    across = [(a, b) for a, b in combinations(layers, 2) if abs(abs(a - b) - 90) <= 1]
    both = shapely.get_parts([shapely.intersection(layers[a], layers[b], grid_size=GRID) for a, b in across])
    return shapely.union_all([each for each in both if each.area], grid_size=GRID)


def odd_photos(scene, program, solvable):
    """Yield what is wrong with the photos of tasks of which more is asked than that they cover an area.

    Args:
        solvable: whether nothing is in the way of the tasks, so that nothing may be left out.
    """
    photos = defaultdict(lambda: defaultdict(list))
    for robot in program.robots:
        for task, *photo in photos_of(robot):
            photos[task][robot.id].append(photo)
    for task in scene.tasks:
        attributes, own = task.part.attributes, photos[task.name]
        places = np.array([at for each in own.values() for at, _, _ in each]).reshape(-1, 3)
        found = []
        if task.part.is_a(GRID_TASK):
            dented = _target(scene, task, own).boundary.difference(_shell(attributes).boundary.buffer(NEAR))
            found = [*_beside(attributes, places), *_astray(attributes, own, places, dented, solvable)]
        elif attributes.get("photoDistance"):
            found = _off_line(task.part, places, solvable)
        elif attributes.get("width") and solvable:
            found = _bare(attributes, places)
        yield from (f"photos of '{task.name}' {each}" for each in found)


def _seen(attributes):
    """Return width and length of what a photo adds: its footprint less the overlaps."""
    grid = attributes.get("gridResolution")
    if grid is not None:
        return grid, grid
    width = attributes["footprintWidth"] * (1.0 - attributes["sideOverlap"])
    return width, attributes["footprintLength"] * (1.0 - attributes["frontOverlap"])


def _shell(attributes):
    return shapely.Polygon([point[:2] for point in attributes["shell"]])


def _beside(attributes, places):
    """Yield photos that are made in turnarounds."""
    shell = _shell(attributes)
    away = shapely.distance(shell, shapely.points(places[:, :2])).max(initial=0.0)
    if away > max(_seen(attributes)):
        yield f"are made up to {away:.3f} m beside it"


def _astray(attributes, own, places, dented, solvable):
    """Yield swaths at another angle than asked for, and a begin at another corner.

    Along areas and holes (`dented`) swaths have dents.
    """
    turned, corner = attributes.get("swathAngle"), CORNERS.get(attributes["startCorner"])
    dent = max(_seen(attributes))
    legs = [(at, turn) for each in own.values() for at, *leg in each if (turn := _angle(*leg)) is not None]
    if turned is not None:
        step = 90.0 if attributes["crossHatch"] else 180.0
        off = [
            (90.0 - angle - turned + step / 2) % step - step / 2
            for at, angle in legs
            if shapely.distance(dented, shapely.Point(at[:2])) > dent
        ]
        if off and max(map(abs, off)) > 0.5:
            yield f"are on swaths that are turned by up to {max(map(abs, off)):.2f} degrees"
    if corner and len(own) == 1 and solvable and legs:
        ends = [np.dot(at[:2], corner) for at, angle in legs if abs(angle - legs[0][1]) < 0.5]
        begin = np.dot(places[0][:2], corner)
        if begin < max(ends) - NEAR:
            yield f"begin {max(ends) - begin:.3f} m from the corner {attributes['startCorner']}"


def _off_line(part, places, solvable):
    """Yield photos beside the line along which they were to be made, and parts of it without photos."""
    attributes, every = part.attributes, part.attributes["photoDistance"]
    heights, wide = [attributes["altitude"]], NEAR
    if "radius" in attributes:
        wide = 0.005 * attributes["radius"]  # a circle is flown as a polygon
        line = shapely.Point(attributes["point"][:2]).buffer(attributes["radius"], quad_segs=90).exterior
    elif "shell" in attributes:
        shell = shapely.Polygon([point[:2] for point in attributes["shell"]])
        line = shell.buffer(attributes["distance"], join_style="mitre", mitre_limit=2.0).boundary
        top, count = attributes.get("topAltitude"), int(attributes.get("layers") or 1)
        heights = np.linspace(heights[0], top or heights[0], count)
    else:
        line = shapely.LineString([point[:2] for point in attributes["points"]])
    off = shapely.distance(line, shapely.points(places[:, :2])).max(initial=0.0)
    if off > wide:
        yield f"are up to {off:.3f} m beside their line"
    for height in heights if solvable else ():
        there = shapely.points(places[abs(places[:, 2] - height) < NEAR, :2])
        bare = line.difference(shapely.union_all(shapely.buffer(there, 1.01 * every / 2.0 + wide))).length
        if bare > NEAR:
            yield f"leave out {bare:.3f} m of {line.length:.3f} m at {height:g} m"


def _bare(attributes, places):
    """Yield how much of a corridor no photo shows, each photo with all that it shows however it is turned."""
    line = shapely.LineString([point[:2] for point in attributes["points"]])
    corridor = line.buffer(attributes["width"] / 2.0, cap_style="flat")
    shown = shapely.buffer(shapely.points(places[:, :2]), np.hypot(*_seen(attributes)) / 2.0)
    left = corridor.difference(shapely.union_all(shown)).area / corridor.area
    if left > 0.01:
        yield f"leave out {100.0 * left:.2f} % of a corridor"


def _angle(here, end):
    """Return the direction of a leg in degrees from east to north, below 180; None if it has no length."""
    east, north = np.subtract(end, here)[:2]
    return None if np.hypot(east, north) < NEAR else round(np.degrees(np.arctan2(north, east)), 1) % 180.0


def _target(scene, task, robots):
    """Return shell minus holes minus all that is too near to an area at the task's height."""
    attributes = task.part.attributes
    shell = [point[:2] for point in attributes["shell"]]
    holes = [[point[:2] for point in ring.attributes["points"]] for ring in attributes["holes"]]
    target = shapely.Polygon(shell, holes)
    own = max(scene.robot(name).clearance for name in robots)
    for area in scene.kept_from(scene.robot(min(robots))):
        keep = own + area.safety_distance
        if area.low - keep < attributes["altitude"] < area.high + keep:
            target = target.difference(shapely.Polygon(area.shell).buffer(keep, quad_segs=64))
    return target


def _footprints(scene, robot):
    """Yield the task, the angle and the ground that each photo shows, a rectangle along the leg.

    Of a photo that is made while the robot stands, all that it shows however it is turned, without an angle.
    """
    for task, at, here, end in photos_of(robot):
        part = scene.task(task).part
        if part.is_a(GRID_TASK):
            yield task, _angle(here, end), _shown(_seen(part.attributes), at, here, end)


def photos_of(robot):
    """Yield the task of each photo, where it is made, and the ends of the leg."""
    ends, before = {}, {to: source for source, each in robot.transitions.items() for to in each.next_moves}
    every, since = 0.0, 0.0
    for index, move in enumerate(robot.moves):
        here = ends.get(before.get(index), robot.home)
        end = ends[index] = move.target.position if move.target and move.target.position else here
        ahead = [here for action in move.before if _photographs(action)]
        behind = [end for action in move.after if _photographs(action)]
        every, since = _distance(move.before, every), 0.0 if ahead else since
        passed, since = _passed(every, since, here, end)
        every, since = _distance(move.after, every), 0.0 if behind else since
        yield from ((move.task, at, here, end) for at in (*ahead, *passed, *behind))


def _photographs(action):
    return action.is_a((BEHAVIOUR, "DeviceAction")) and action.name in ("TakePicture", "TriggerByDistance")


def _distance(actions, before):
    """Return the metres between photos in passing after some actions; 0 where there are none."""
    given = [dict(action.parameters)["distance"] for action in actions if action.name == "TriggerByDistance"]
    return float(given[-1]) if given else before


def _passed(every, since, here, end):
    """Return where a camera is triggered between two places, metres after it last was, and those left."""
    length = since + np.hypot(*np.subtract(end[:2], here[:2]))
    count = int(length / every) if every > 0.0 else 0
    way = np.subtract(end, here) / max(length - since, GRID)
    return [np.add(here, way * (n * every - since)) for n in range(1, count + 1)], length - count * every


def _shown(seen, at, here, end):
    width, length = seen
    way = np.array(end[:2]) - np.array(here[:2])
    norm = np.hypot(*way)
    if norm < NEAR:
        return shapely.Point(at[:2]).buffer(min(seen) / 2.0)
    along, across = way / norm, np.array([-way[1], way[0]]) / norm
    corners = [
        np.array(at[:2]) + a * along * length / 2 + b * across * width / 2
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    return shapely.Polygon(corners)
