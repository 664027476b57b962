"""What is around a simulated vehicle: water, bottom, things to see and to run into. Plain data."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from math import inf

GATE, BUOY, PATH = "gate", "buoy", "path"


@dataclass(frozen=True, slots=True)
class Thing:
    """An object that cameras see.

    A gate is a bar with a post at both ends, which hang down half the bar's length; it is passed in the
    direction of its heading. A buoy is a sphere. A path is a flat strip on the bottom, eight times as long
    as wide, that points to where its heading does.

    Attributes:
        kind: `GATE`, `BUOY` or `PATH`; others are not drawn.
        name: that detections bear.
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
        obstacles: that sonar sees; things: that cameras see.
    """

    current: tuple[float, float] = (0.0, 0.0)
    bottom: float = 100.0
    density: float | None = None
    noise: bool = True
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
        ValueError: the text describes no surroundings.
    """
    try:
        found = json.loads(text)
        north, east = found.pop("current", (0.0, 0.0))
        obstacles = tuple(Obstacle(**each) for each in found.pop("obstacles", ()))
        things = tuple(Thing(**each) for each in found.pop("things", ()))
        return Surroundings(**found, current=(north, east), obstacles=obstacles, things=things)
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"no surroundings: {error}") from error
