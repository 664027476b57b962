"""What is around a simulated vehicle: water, bottom, things to see and to run into. Plain data."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields
from math import inf, isfinite

GATE, BUOY, PATH = "gate", "buoy", "path"

HAZIEST = 10.0
"""Times as hazy as a clear pool, at most."""


@dataclass(frozen=True, slots=True)
class Thing:
    """An object that cameras see.

    A gate is a bar with a post at both ends, which hang down half the bar's length; it is passed in the
    direction of its heading. A buoy is a sphere. A path is a flat strip on the bottom, eight times as long
    as wide, that points to where its heading does.

    Attributes:
        kind: `GATE`, `BUOY` or `PATH`; others are not drawn.
        name: in detections.
        north, east, depth: metres, of the middle: of a gate's bar, of a buoy's sphere, of a path's strip.
        heading: degrees clockwise from north.
        colour: by its English name, such as "red", "orange", "yellow", "green".
        size: metres: length of a gate's bar, diameter of a buoy, length of a path.
    """

    kind: str
    name: str
    north: float
    east: float
    depth: float
    heading: float = 0.0
    colour: str = "orange"
    size: float = 1.0


@dataclass(frozen=True, slots=True)
class Obstacle:
    """An upright cylinder that sonar sees.

    Attributes:
        north, east: of its axis, metres. radius: metres.
        top, bottom: depths of its ends, metres.
    """

    north: float
    east: float
    radius: float
    top: float = 0.0
    bottom: float = inf


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The water around a vehicle.

    Attributes:
        current: metres per second to the north and to the east, the same everywhere.
        bottom: its depth, metres.
        density: of the water, kilograms per cubic metre; None: that of the vehicle's sheet.
        noise: whether sensors have noise and bias.
        haze: how many times the haze of a clear pool the water has; cameras undo as much of it.
        obstacles: that sonar sees; things: that cameras see.
    """

    current: tuple[float, float] = (0.0, 0.0)
    bottom: float = 100.0
    density: float | None = None
    noise: bool = True
    haze: float = 1.0
    obstacles: tuple[Obstacle, ...] = ()
    things: tuple[Thing, ...] = ()


def to_json(surroundings: Surroundings) -> str:
    """Return surroundings as a file holds them; an obstacle without end below has no bottom there."""
    found = asdict(surroundings)
    for obstacle in found["obstacles"]:
        if obstacle["bottom"] == inf:
            del obstacle["bottom"]
    return json.dumps(found, indent=2, allow_nan=False) + "\n"


def from_json(text: str) -> Surroundings:
    """Return the surroundings of a file.

    Raises:
        ValueError: the text describes no surroundings; the message states why.
    """
    try:
        found = json.loads(text)
        north, east = found.pop("current", (0.0, 0.0))
        obstacles = tuple(Obstacle(**each) for each in found.pop("obstacles", ()))
        things = tuple(Thing(**each) for each in found.pop("things", ()))
        around = Surroundings(**found, current=(north, east), obstacles=obstacles, things=things)
    except (KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError(f"no surroundings: {error}") from error
    _check(around)
    return around


def _check(around: Surroundings) -> None:
    """Raise ValueError for the first value that no water, or nothing in it, has."""
    _check_values(around, "the water", {"bottom": inf, "haze": HAZIEST})
    for key, value in zip(("current", "current", "density"), (*around.current, around.density), strict=True):
        if value is not None or key == "current":
            _check_number("the water", key, value)
    for thing in around.things:
        _check_values(thing, f"thing {thing.name!r}", {"size": inf})
    for number, obstacle in enumerate(around.obstacles):
        _check_values(obstacle, f"obstacle {number}", {"radius": inf})


def _check_values(found: Surroundings | Thing | Obstacle, where: str, most: dict[str, float]) -> None:
    """Check the types of all values; those that `most` names are above zero, and no more than that."""
    for each in fields(found):
        value = getattr(found, each.name)
        if each.type in ("str", "bool") and type(value).__name__ != each.type:
            raise ValueError(f"no surroundings: {where}: {each.name} is {value!r}")
        if each.type == "float" and value != each.default:
            _check_number(where, each.name, value)
        if each.name in most and not 0.0 < value <= most[each.name]:
            raise ValueError(f"no surroundings: {where}: {each.name} is {value:g}")


def _check_number(where: str, key: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise ValueError(f"no surroundings: {where}: {key} is {value!r}")
