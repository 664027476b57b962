"""Makes the one page that shows a mission: map, heights, timeline, figures; it needs no network."""

from __future__ import annotations

import json
from importlib.resources import files

from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.preview.key import key_markup
from mmrs_core.pictures.preview.map_drawing import map_markup
from mmrs_core.pictures.preview.map_ways import leg_tip
from mmrs_core.pictures.preview.markup import element, style_sheet, text
from mmrs_core.pictures.preview.palette import Style, style_of
from mmrs_core.pictures.preview.picture import Leg, Picture, RobotPicture, Thing
from mmrs_core.pictures.preview.profile import BARS, BARS_OF_FLIGHTS, profile_markup
from mmrs_core.pictures.preview.projection import projection_of
from mmrs_core.pictures.preview.time_axis import LEFT, RIGHT, WIDTH
from mmrs_core.pictures.preview.timeline import KEY, KEY_OF_FLIGHTS, timeline_markup

_POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
_TALLEST = 940
_LAYERS = (
    ("coverage", "ground covered"),
    ("clearance", "clearance"),
    ("areas", "areas and obstacles"),
    ("emergency", "emergency areas"),
    ("tasks", "tasks"),
    ("things", "things at the place"),
    ("ways", "ways"),
    ("labels", "names"),
    ("grid", "grid"),
)
_FLOWN_LAYERS = (("planned", "ways as planned"), ("marks", "photos and faults"))


def page(picture: Picture) -> str:
    """Return a whole HTML document; nothing in it refers to another file."""
    title = picture.title or "mission"
    head = (
        '<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{text(_POLICY)}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        element("title", None, text(title)),
        element("style", None, style_sheet("page.css") + style_sheet("dark.css")),
    )
    body = (
        element("header", None, element("h1", None, text(title)), element("p", None, text(_lead(picture)))),
        element(
            "section",
            {"class": "place"},
            _controls(picture),
            _frame(picture),
            _player(picture),
        ),
        element(
            "section",
            None,
            element("h2", None, "Who does what, and who waits for whom"),
            element("p", {"class": "soft"}, KEY_OF_FLIGHTS if picture.flown else KEY),
            element("div", {"class": "wide"}, timeline_markup(picture)),
        ),
        element(
            "section",
            None,
            element("h2", None, "Heights above the origin"),
            element("p", {"class": "soft"}, BARS_OF_FLIGHTS if picture.flown else BARS),
            element("div", {"class": "wide"}, profile_markup(picture)),
        ),
        element("section", None, element("h2", None, "Robots"), _table(picture)),
        _things(picture),
        _notes(picture),
        '<div id="tip" role="status" hidden></div>',
        _data(picture),
        f"<script>{_script()}</script>",
    )
    return (
        f'<!doctype html>\n<html lang="en"><head>{"".join(head)}</head><body>{"".join(body)}</body></html>\n'
    )


def _lead(picture: Picture) -> str:
    robots, tasks = len(picture.robots), len(picture.tasks)
    counts = [f"{robots} robot{'s' * (robots != 1)}"]
    counts += [f"{tasks} task{'s' * (tasks != 1)}"] if tasks else []
    done = "flown for" if picture.flown else "done after"
    return f"{', '.join(counts)}, {done} {clock(picture.makespan)}. Origin: {picture.origin}."


def _frame(picture: Picture) -> str:
    shown = projection_of(picture)
    ratio = shown.width / shown.height
    shape = f"aspect-ratio: {ratio:.4f}; max-width: {_TALLEST * ratio:.0f}px"
    return element("div", {"class": "frame", "style": shape}, map_markup(picture))


def _controls(picture: Picture) -> str:
    robots = (_robot_box(i, robot) for i, robot in enumerate(picture.robots))
    shown = (*_FLOWN_LAYERS, *_LAYERS) if picture.flown else _LAYERS
    layers = (_box({"data-toggle": name}, text(words)) for name, words in shown)
    return element(
        "aside",
        None,
        element("h2", None, "Robots"),
        robots,
        element("h2", None, "Shown"),
        layers,
        element("h2", None, "Key"),
        key_markup(picture),
        '<p class="hint">Drag to move, wheel to zoom, double click to see all.</p>',
    )


def _robot_box(index: int, robot: RobotPicture) -> str:
    style = style_of(index)
    icon = f"{text(robot.symbol.icon)} " if robot.symbol and robot.symbol.icon else ""
    kind = f"{robot.type_name}, {robot.symbol.label}" if robot.symbol else robot.type_name
    words = f"{_sample(style)}<b>{icon}{text(robot.name)}</b> <small>{text(kind)}</small>"
    return _box({"data-toggle-robot": index}, words)


def _box(attributes: dict[str, str | int], words: str) -> str:
    box = element("input", {"type": "checkbox", "checked": "", **attributes})
    return f"<label>{box}{words}</label>"


def _sample(style: Style) -> str:
    line = {
        "d": "M1 6H33",
        "stroke": style.colour,
        "stroke-width": 3,
        "stroke-dasharray": style.dashes or None,
    }
    return element("svg", {"class": "sample", "width": 34, "height": 12}, element("path", line))


def _player(picture: Picture) -> str:
    slider = {"type": "range", "id": "time", "min": 0, "max": picture.shown, "value": 0, "step": "any"}
    return element(
        "div",
        {"class": "player"},
        '<button type="button" id="play" aria-label="play">▶</button>',
        element("input", {**slider, "aria-label": "time"}),
        '<output id="now">0:00</output>',
    )


def _table(picture: Picture) -> str:
    titles = [title for title, _ in picture.robots[0].summary] if picture.robots else []
    head = element("tr", None, (element("th", None, text(title)) for title in ("robot", "type", *titles)))
    return element(
        "div", {"class": "wide"}, element("table", None, head, (_row(robot) for robot in picture.robots))
    )


def _row(robot: RobotPicture) -> str:
    cells = (robot.name, robot.type_name, *(value for _, value in robot.summary))
    return element("tr", None, (f"<td><bdi>{text(cell)}</bdi></td>" for cell in cells))


def _things(picture: Picture) -> str:
    """Return a table of what the place holds, with what is not on the map."""
    if not picture.things:
        return ""
    head = element("tr", None, (element("th", None, title) for title in ("thing", "kind", "")))
    rows = (
        element("tr", None, (f"<td><bdi>{text(cell)}</bdi></td>" for cell in _thing_cells(thing)))
        for thing in picture.things
        if thing.name
    )
    table = element("div", {"class": "wide"}, element("table", None, head, rows))
    return element("section", None, element("h2", None, "At the place"), table)


def _thing_cells(thing: Thing) -> tuple[str, str, str]:
    details = [f"{what}: {words}" for what, words in thing.details]
    return (
        thing.name,
        thing.symbol.label,
        "; ".join(details if thing.points else [*details, "without a place"]),
    )


def _notes(picture: Picture) -> str:
    if not picture.notes:
        return ""
    items = (element("li", None, text(note)) for note in picture.notes)
    return element(
        "section",
        None,
        element("h2", None, "What to know" if picture.flown else "Assumptions"),
        element("ul", None, items),
    )


def _data(picture: Picture) -> str:
    """Return the ways over time for the player, as JSON that cannot end the script element."""
    robots = [
        {
            "home": robot.home[:2],
            "colour": style_of(index).colour,
            "legs": [_leg_data(robot, leg) for leg in robot.legs if not leg.aside],
        }
        for index, robot in enumerate(picture.robots)
    ]
    shown = projection_of(picture)
    projection = {"west": shown.west, "north": shown.north, "scale": shown.scale}
    axis = {"left": LEFT, "right": WIDTH - RIGHT, "end": picture.shown}
    dumped = json.dumps({"robots": robots, "axis": axis, "projection": projection})
    safe = dumped.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
    return f'<script type="application/json" id="data">{safe}</script>'


def _leg_data(robot: RobotPicture, leg: Leg) -> dict[str, object]:
    data: dict[str, object] = {
        "begin": leg.begin,
        "end": leg.end,
        "points": [[round(p[0], 2), round(p[1], 2)] for p in leg.points],
        "tip": leg_tip(robot.name, leg),
    }
    return data | {"times": [round(time, 2) for time in leg.times]} if len(leg.times) > 1 else data


def _script() -> str:
    return (files("mmrs_core.pictures.preview") / "page.js").read_text(encoding="utf-8")
