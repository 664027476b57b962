"""Makes the page that shows a mission: map, timeline, altitude profile, tables; it needs no network."""

from __future__ import annotations

from markupsafe import Markup

from mmrs_core.pictures.documents import render, source, style_sheets
from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.palette import style_of, variables
from mmrs_core.pictures.preview.key import gaps_in_words, key_of
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.pictures.preview.picture import ElementPicture, Leg, Picture, RobotPicture
from mmrs_core.pictures.preview.profile import BARS, BARS_OF_FLIGHTS, profile_of
from mmrs_core.pictures.preview.projection import projection_of
from mmrs_core.pictures.preview.timeline import KEY, KEY_OF_FLIGHTS, LEFT, RIGHT, WIDTH, timeline_of

_TALLEST = 940
_LAYERS = (
    ("problems", "problems"),
    ("planned", "planned paths"),
    ("marks", "photos and faults"),
    ("coverage", "ground covered"),
    ("clearance", "clearance"),
    ("areas", "areas and obstacles"),
    ("emergency", "emergency areas"),
    ("ranges", "radio ranges"),
    ("tasks", "tasks"),
    ("elements", "context elements"),
    ("paths", "paths"),
    ("labels", "names"),
    ("grid", "grid"),
)
_LAYERS_OF_FLIGHTS = ("planned", "marks")
_LAYERS_OF_PLANS = ("coverage", "paths")


def page(picture: Picture) -> str:
    """Return a whole HTML document; nothing in it refers to another file."""
    shown = projection_of(picture)
    absent = (
        *(() if picture.flown else _LAYERS_OF_FLIGHTS),
        *(() if picture.planned else _LAYERS_OF_PLANS),
        *(() if picture.problems else ("problems",)),
        *(() if picture.ranges else ("ranges",)),
    )
    document = render(
        "preview.html",
        title=picture.title or "mission",
        style=Markup(variables()) + style_sheets("page", "map", "charts"),
        script=source("preview.js"),
        lead=_lead(picture),
        picture=picture,
        robots=[(index, style_of(index), robot) for index, robot in enumerate(picture.robots)],
        layers=[layer for layer in _LAYERS if layer[0] not in absent],
        key=key_of(picture),
        gaps=gaps_in_words(picture),
        map=map_of(picture),
        ratio=f"{shown.width / shown.height:.4f}",
        widest=f"{_TALLEST * shown.width / shown.height:.0f}",
        timeline=timeline_of(picture),
        timeline_key=KEY_OF_FLIGHTS if picture.flown else KEY,
        profile=profile_of(picture),
        profile_key=BARS_OF_FLIGHTS if picture.flown else BARS,
        rows=[(each.name, each.type_name, *(value for _, value in each.summary)) for each in picture.robots],
        columns=[name for name, _ in picture.robots[0].summary] if picture.robots else [],
        elements=[(each.name, each.symbol.label, _details(each)) for each in picture.elements if each.name],
        data=_data(picture),
    )
    return str(document)


def _lead(picture: Picture) -> str:
    robots, tasks = len(picture.robots), len(picture.tasks)
    counts = [f"{robots} robot{'s' * (robots != 1)}"]
    counts += [f"{tasks} task{'s' * (tasks != 1)}"] if tasks else []
    missing = sum(not gap.drawn for gap in picture.gaps)
    counts += [f"{missing} not drawn"] if missing else []
    if not picture.planned:
        return f"{', '.join(counts)}, not planned. Origin: {picture.origin}."
    done = "flown for" if picture.flown else "mission time"
    return f"{', '.join(counts)}, {done} {clock(picture.makespan)}. Origin: {picture.origin}."


def _details(element: ElementPicture) -> str:
    details = [f"{name}: {value}" for name, value in element.details]
    return "; ".join(details if element.points else [*details, "without a position"])


def _data(picture: Picture) -> dict[str, object]:
    """Return the paths over time, for the player."""
    shown = projection_of(picture)
    return {
        "robots": [
            {
                "home": robot.home[:2],
                "colour": f"var(--{style_of(index).colour})",
                "legs": [_leg(robot, leg) for leg in robot.legs if not leg.aside],
            }
            for index, robot in enumerate(picture.robots)
        ],
        "axis": {"left": LEFT, "right": WIDTH - RIGHT, "end": picture.shown},
        "projection": {"west": shown.west, "north": shown.north, "scale": shown.scale},
    }


def _leg(robot: RobotPicture, leg: Leg) -> dict[str, object]:
    data: dict[str, object] = {
        "begin": leg.begin,
        "end": leg.end,
        "points": [[round(p[0], 2), round(p[1], 2)] for p in leg.points],
        "tip": leg.tip(robot.name),
    }
    return data | {"times": [round(time, 2) for time in leg.times]} if len(leg.times) > 1 else data
