"""The flights: examples, ways of flying, and what goes wrong with each class of vehicle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import cos, radians, sin
from typing import Any

from real_flights.flight import (
    AWAY,
    CONTROLLERS,
    DISARM,
    DONE,
    HOLDS,
    HOME,
    MEND,
    PLAN,
    RUN,
    SURFACE,
    Begun,
    Change,
    Cut,
    Flight,
    Happening,
    Kill,
    Later,
    Order,
    Pilot,
    Reboot,
    Resume,
    When,
)
from real_flights.routes import (
    COPTER,
    CRAWLER,
    PHOTOGRAPHER,
    ROVER,
    SUB,
    WIND_FROM,
    Craft,
    Route,
    example,
    on_px4,
    routes,
)

SQUARE = ((0.0, 30.0, 12.0), (25.0, 30.0, 12.0), (25.0, 0.0, 12.0), (0.0, 0.0, 12.0))
LAWN = tuple(
    (18.0 * row, 60.0 * (row % 2 if end == 0 else 1 - row % 2), 12.0) for row in range(6) for end in (0, 1)
)
YARD = ((0.0, 25.0, 0.0), (20.0, 35.0, 0.0), (35.0, 20.0, 0.0), (20.0, 5.0, 0.0), (0.0, 0.0, 0.0))
STREET = ((0.0, 12.0, 0.0), (0.0, 26.0, 0.0), (10.0, 30.0, 0.0), (22.0, 30.0, 0.0), (30.0, 20.0, 0.0))
ARCS = tuple(
    (x, y, 0.0)
    for x, y in ((0, 12), (0.08, 12.63), (0.33, 13.2), (0.7, 13.7), (1.2, 14.1), (1.8, 14.3), (15, 14.4))
)
REEF = ((0.0, 20.0, -3.0), (15.0, 20.0, -5.0), (15.0, 0.0, -5.0), (0.0, 0.0, -3.0), (0.0, 0.0, 0.0))


def _short(craft: Craft, *policies: tuple[str, str, float], stays: float = 0.0, fluid: bool = False) -> Route:
    """Return a short route of a class of vehicle."""
    places, speed = {COPTER: (SQUARE, 5.0), ROVER: (YARD, 1.5), SUB: (REEF, 0.8)}[craft]
    name = {COPTER: "Alba", ROVER: "Badger", SUB: "Nereid"}[craft]
    return Route(name, craft, places, speed, fluid=fluid, stays=stays, policies=policies)


ROUND = tuple(
    (15.0 * sin(angle), 20.0 - 15.0 * cos(angle), 12.0)
    for angle in (radians(10.0 * corner) for corner in range(37))
)
ORBIT = Route("Alba", COPTER, ROUND, 5.0, fluid=True, looks=(0.0, 20.0, 0.0))
PASSING = Route("Kestrel", PHOTOGRAPHER, SQUARE, 3.0, photos=8.0)
"""On each leg, one at once, three at 8 m each, and a last one; an ArduPilot may leave out the first of the
next leg, which is at the same place."""

NAMES: Mapping[Craft, str] = {COPTER: "copter", ROVER: "rover", SUB: "sub"}
AT_LEG = Begun("p1", 3.0)
"""On the second leg, under way."""

FENCE = {"FENCE_TYPE": 6.0, "FENCE_RADIUS": 33.0, "FENCE_ENABLE": 1.0, "AVOID_ENABLE": 0.0}
"""A circle that the second leg leaves; a rover would otherwise stop in front of it for good."""

NO_POSITION = {"SIM_GPS1_ENABLE": 0.0}
NO_MOTOR = {"SIM_ENGINE_MUL": 0.0, "SIM_ENGINE_FAIL": 1.0}
LOW_BATTERY = {"BATT_CAPACITY": 100.0}
"""Milliampere-hours, most of which are gone by then."""


def _upset(
    craft: Craft,
    name: str,
    *happens: tuple[When, Happening],
    ends: str,
    fault: str = "",
    policy: tuple[str, str, float] | None = None,
    parameters: Mapping[str, float] | None = None,
    resumed: bool = False,
    stays: float = 0.0,
    speedup: float = 4.0,
) -> Flight:
    """Return a flight on the short route in which something happens."""
    return Flight(
        f"{NAMES[craft]}: {name}",
        routes(_short(craft, *filter(None, [policy]), stays=stays)),
        happens=happens,
        ends=ends,
        fault=fault,
        deviation=3.0 if resumed else None,
        landing=4.0 if craft is not COPTER else 1.0,
        parameters=parameters or {},
        speedup=speedup,
    )


def _faults(craft: Craft) -> tuple[Flight, ...]:
    back = {COPTER: HOME, ROVER: HOME, SUB: SURFACE}[craft]
    response = {COPTER: "RETURN", ROVER: "RETURN", SUB: "SURFACE"}[craft]
    halt = {COPTER: AWAY, ROVER: HOLDS, SUB: SURFACE}[craft]
    return (
        _upset(
            craft,
            "link cut for 40 s",
            (AT_LEG, Cut()),
            (Later(40.0), MEND),
            ends=back,
            fault="LINK_LOST",
            policy=("LINK_LOST", response, 5.0),
        ),
        _upset(
            craft,
            "telemetry lost",
            (AT_LEG, Cut(outwards=False)),
            (Later(60.0), MEND),
            ends=back,
            fault="LINK_LOST",
            policy=("LINK_LOST", response, 5.0),
        ),
        _upset(craft, "process killed", (AT_LEG, Kill()), ends=back, policy=("LINK_LOST", response, 5.0)),
        _upset(craft, "satellites lost", (AT_LEG, Change(NO_POSITION)), ends=halt, fault="POSITION_LOST"),
        _upset(
            craft,
            "battery low",
            (AT_LEG, Change(LOW_BATTERY)),
            ends=back,
            policy=("BATTERY_LOW", response, 1.0),
        ),
        _upset(
            craft,
            "autopilot restarts",
            (AT_LEG, Reboot()),
            ends=HOLDS if craft is ROVER else AWAY,
            fault="VEHICLE_RESTARTED",
            speedup=1.0,
        ),
    )


def _orders(craft: Craft) -> tuple[Flight, ...]:
    land = {COPTER: AWAY, ROVER: HOLDS, SUB: SURFACE}[craft]
    return (
        Flight(
            f"{NAMES[craft]}: hold, then resume",
            routes(_short(craft)),
            happens=((AT_LEG, Order("hold")), (Later(10.0), Order("resume"))),
            deviation=3.0,
            landing=4.0 if craft is not COPTER else 1.0,
        ),
        _upset(craft, "order return", (AT_LEG, Order("return")), ends=HOME, fault="ORDERED"),
        _upset(craft, "order stop", (AT_LEG, Order("stop")), ends=HOLDS, fault="STOPPED"),
        _upset(craft, "order land", (AT_LEG, Order("land")), ends=land, fault="ORDERED"),
        _upset(
            craft,
            "pilot takes over",
            (AT_LEG, Pilot({COPTER: 5, ROVER: 4, SUB: 19}[craft])),
            *([] if craft is COPTER else [(Later(15.0), DISARM)]),
            ends=HOLDS if craft is ROVER else AWAY,
            fault="TAKEN_OVER",
        ),
    )


def _resumes(craft: Craft) -> tuple[Flight, ...]:
    moments = {
        "on a leg": Begun("p1", 3.0),
        "while it stays": Begun("stay", 3.0),
        "on the first leg": Begun("p0", 1.0),
        "on the last leg": Begun(f"p{len({COPTER: SQUARE, ROVER: YARD, SUB: REEF}[craft]) - 1}", 2.0),
    }
    if craft is COPTER:
        moments |= {"climbing": Begun("up", 3.0), "landing": Begun("down", 3.0)}
    left = HOME if craft is COPTER else HOLDS  # by its failsafe for a lost link: the program has ended
    ordered = {"held": ("hold", DONE, ""), "returning": ("return", left, "ORDERED")}
    return (
        *(
            _upset(
                craft,
                f"killed and resumed, {moment}",
                (when, Kill()),
                (Later(1.0), Resume()),
                ends=DONE,
                resumed=True,
                stays=10.0 if when.move == "stay" else 0.0,
            )
            for moment, when in moments.items()
        ),
        *(
            _upset(
                craft,
                f"killed and resumed, {state}",
                (AT_LEG, Order(order)),
                (Later(3.0), Kill()),
                (Later(1.0), Resume()),
                ends=ends,
                fault=fault,
                resumed=ends == DONE,
            )
            for state, (order, ends, fault) in ordered.items()
        ),
    )


def _ways(craft: Craft) -> tuple[Flight, ...]:
    landing, deviation = (1.0, 1.5) if craft is COPTER else (4.0, 3.0)
    given = [
        Flight(f"{NAMES[craft]}: legs", routes(_short(craft)), landing=landing, deviation=deviation),
        Flight(f"{NAMES[craft]}: fluid", routes(_short(craft, fluid=True)), landing=landing, deviation=3.0),
        Flight(
            f"{NAMES[craft]}: plan in AUTO", routes(_short(craft)), way=PLAN, landing=landing, deviation=3.0
        ),
        Flight(
            f"{NAMES[craft]}: signed link",
            routes(_short(craft)),
            signed=True,
            landing=landing,
            deviation=deviation,
        ),
    ]
    if craft is COPTER:
        given += [
            Flight("copter: turns", routes(replace(_short(craft), turns=20.0))),
            Flight("copter: two sorties", routes(replace(_short(craft), sorties=2))),
            Flight("copter: photos in passing", routes(PASSING), photos=(17, 20)),
            Flight("copter: orbit", routes(ORBIT), looks=(0.0, 20.0, 10.0), parameters={"MNT1_TYPE": 0.0}),
            Flight("copter: orbit, with a gimbal", routes(ORBIT), timed=False, says="flown leg by leg"),
        ]
    return tuple(given)


EXPECTED = ("--backend-option", "objects=expected")
"""Fly to where objects are expected: no simulation of an autopilot finds any."""

VIDEO = {
    '"mavlink.command.StartVideo" value="2500 0 0"': '"mavlink.command.StartVideo" value="181 1 1"',
    '"mavlink.command.StopVideo" value="2501 0"': '"mavlink.command.StopVideo" value="181 1 0"',
}
"""A relay instead of a recording: no camera of ArduPilot's simulations records video."""

EXAMPLES = (
    Flight("carbon-dioxide", example("carbon-dioxide"), speedup=3.0),
    Flight("carbon-dioxide, controllers", example("carbon-dioxide"), way=CONTROLLERS, speedup=3.0),
    Flight("carbon-dioxide, plan in AUTO", example("carbon-dioxide"), robots=("Alba",), way=PLAN),
    Flight("handwritten", example("handwritten"), arguments=EXPECTED),
    Flight("solar-park", example("solar-park"), speedup=4.0),
    Flight("drone-and-rover", example("drone-and-rover"), deviation=4.0, landing=4.0),
    Flight("mixed-team", example("mixed-team", VIDEO), speedup=3.0, deviation=4.0, landing=4.0),
    Flight("outfall", example("outfall", VIDEO), arguments=EXPECTED, deviation=3.0, landing=4.0),
    Flight("outfall, plan in AUTO", example("outfall"), way=PLAN, deviation=3.0, landing=4.0),
)
LAWNS = (
    Flight(
        "lawn of three",
        routes(
            *(
                Route(name, COPTER, (*LAWN, (0.0, 0.0, 12.0)), 6.0, fluid=True, home=(150.0 * number, 0.0))
                for number, name in enumerate(("Uno", "Due", "Tre"))
            )
        ),
        deviation=2.0,
        speedup=4.0,
    ),
)
ROVERS = (
    Flight("rover: long legs", routes(Route("Badger", ROVER, STREET, 1.5)), deviation=3.0, landing=4.0),
    Flight("rover: arcs", routes(Route("Badger", ROVER, ARCS, 1.0)), deviation=3.0, landing=4.0),
)
FURROWS = ((0.0, 20.0, 0.0), (8.0, 20.0, 0.0), (8.0, 0.0, 0.0), (8.0, 12.0, 0.0), (0.0, 0.0, 0.0))
"""Corners, and a way back on which tracks turn round on the spot."""

CRAWLERS = tuple(
    Flight(
        f"tracked rover: {name}",
        routes(Route("Crawler", CRAWLER, FURROWS, 1.0)),
        way=way,
        deviation=3.0,
        landing=4.0,
    )
    for name, way in (("legs", RUN), ("plan in AUTO", PLAN))
)
DIVE = ((10.0, 0.0, -1.0), (10.0, 0.0, -9.0), (10.0, 15.0, -2.0), (10.0, 15.0, -9.0), (0.0, 0.0, 0.0))
TRANSECT = tuple((0.0, 12.0 * index, -3.0) for index in range(1, 6))
"""Places in line, the last one below."""

DIVES = tuple(
    Flight(f"sub: {name}", routes(route), way=way, deviation=3.0, landing=4.0)
    for name, route, way in (
        ("up and down", Route("Nereid", SUB, DIVE, 0.8), RUN),
        ("up and down in AUTO", Route("Nereid", SUB, DIVE, 0.8), PLAN),
        ("transect", Route("Nereid", SUB, TRANSECT, 1.0, fluid=True), RUN),
        ("transect in AUTO", Route("Nereid", SUB, TRANSECT, 1.0, fluid=True), PLAN),
    )
)
WIND = 5.0
"""Metres per second."""

WINDS = tuple(
    Flight(
        f"copter: wind, {name}",
        routes(_short(COPTER), wind=WIND),
        way=way,
        deviation=2.0,
        parameters={"SIM_WIND_SPD": WIND, "SIM_WIND_DIR": WIND_FROM},
    )
    for name, way in (("legs", RUN), ("plan in AUTO", PLAN))
)
MOTORS = (_upset(COPTER, "motor fails", (AT_LEG, Change(NO_MOTOR)), ends=AWAY, fault="MOTOR_FAILED"),)
FENCES = tuple(
    _upset(
        craft,
        "fence broken",
        (Begun("p1", 0.5), Change(FENCE)),
        ends=HOME,
        fault="FENCE_BREACHED",
        policy=("FENCE_BREACHED", "RETURN", 0.0),
    )
    for craft in (COPTER, ROVER)
)
SCHOOL = ((8.0, 10.0, 0.0), (17.0, 10.0, 0.0), (17.0, 20.0, 0.0), (8.0, 20.0, 0.0))
"""An area inside the square, which is uploaded as a fence."""

AREAS = (Flight("copter: area to fence", routes(_short(COPTER), forbidden=SCHOOL), deviation=1.5),)
BUOY = (
    _upset(
        SUB,
        "fence broken",
        (Begun("p1", 0.5), Change({"FENCE_TYPE": 2.0, "FENCE_RADIUS": 22.0, "FENCE_ENABLE": 1.0})),
        ends=SURFACE,
        fault="FENCE_BREACHED",
        policy=("FENCE_BREACHED", "SURFACE", 0.0),
    ),
)


PX4_LANDING = 4.0
"""Metres; the satellites that its simulation imitates wander by two to three."""


def _as_px4(flight: Flight, **changes: Any) -> Flight:
    """Return a copter's flight as that of a PX4."""
    name = flight.name.replace("copter:", "PX4:")
    led_away = flight.deviation is None or changes.get("ends") == HOME
    deviation = None if led_away else 3.0
    changes["models"] = on_px4(flight.models)
    return replace(
        flight, name=name, px4=True, deviation=deviation, landing=PX4_LANDING, speedup=1.0, **changes
    )


FIELD = tuple(
    (12.0 * row, 100.0 * (row % 2 if end == 0 else 1 - row % 2), 12.0) for row in range(16) for end in (0, 1)
)
"""Ten minutes, so that the luck of a landing is less than the twentieth within which times are judged."""

FIELDS = tuple(
    Flight(f"copter: {name}", routes(Route("Alba", COPTER, (*FIELD, (0.0, 0.0, 12.0)), 5.0)), way=way)
    for name, way in (("ten minutes", RUN), ("ten minutes in AUTO", PLAN))
)
STRIPS = tuple(
    (15.0 * row, 45.0 + 30.0 * step * (1 - 2 * (row % 2)), 12.0) for row in range(4) for step in (-1, 0, 1)
)
"""Turns by a right angle at the ends of strips, and places between, that are passed."""

HOPS = tuple((0.0, 10.0 * index, 12.0) for index in range(1, 21))
"""Places so near each other that none is passed at the commanded speed."""

STAIRS = tuple((0.0, 15.0 * index, 12.0 + 3.0 * min(index, 10 - index)) for index in range(1, 11))

STRIPES = tuple(
    Flight(f"copter: {name}", routes(Route("Alba", COPTER, places, speed, fluid=True)), way=way)
    for name, places, speed, way in (
        ("strips", (*STRIPS, (0.0, 0.0, 12.0)), 5.0, RUN),
        ("strips in AUTO", (*STRIPS, (0.0, 0.0, 12.0)), 5.0, PLAN),
        ("quick strips in AUTO", (*STRIPS, (0.0, 0.0, 12.0)), 9.0, PLAN),
        ("hops", HOPS, 9.0, RUN),
        ("hops in AUTO", HOPS, 9.0, PLAN),
        ("stairs in AUTO", STAIRS, 5.0, PLAN),
    )
)

_COPTERS = {
    flight.name.removeprefix("copter: "): flight
    for flight in (*_ways(COPTER), *_orders(COPTER), *_faults(COPTER), *AREAS, *FIELDS, *STRIPES)
}
PX4S = (
    *(
        _as_px4(_COPTERS[name])
        for name in (
            *("legs", "fluid", "plan in AUTO", "turns", "two sorties", "area to fence"),
            *("hold, then resume", "order return", "order stop", "order land"),
            *("link cut for 40 s", "process killed"),
            *("ten minutes", "ten minutes in AUTO", "strips", "strips in AUTO", "quick strips in AUTO"),
            *("hops", "hops in AUTO", "stairs in AUTO"),
        )
    ),
    _as_px4(_COPTERS["photos in passing"], parameters={"TRIG_MODE": 4.0}),
    _as_px4(_COPTERS["orbit"], parameters={}),
    replace(
        _as_px4(_COPTERS["legs"], parameters={"MPC_XY_VEL_MAX": 3.0}),
        name="PX4: slower by its owner",
        timed=False,
        says="MPC_XY_VEL_MAX = 3: slower than the 5 m/s of its program",
    ),
    _as_px4(_COPTERS["pilot takes over"], happens=((AT_LEG, Pilot(4, 6)),)),
    _as_px4(_COPTERS["satellites lost"], happens=((AT_LEG, Change({"SIM_GPS_USED": 0.0})),)),
    _as_px4(_COPTERS["battery low"], happens=(), parameters={"SIM_BAT_DRAIN": 40.0, "SIM_BAT_MIN_PCT": 5.0}),
    _as_px4(FENCES[0], happens=((Begun("p1", 0.5), Change({"GF_MAX_HOR_DIST": 33.0})),)),
    *(
        _as_px4(flight, ends=HOME, happens=(*flight.happens[:-1], (Later(12.0), Resume())))
        for flight in _resumes(COPTER)
        if flight.name.endswith((", on a leg", ", while it stays"))
    ),
)
"""A PX4 that flies does not restart by an order, and its simulation has no motor to fail. Once its set-points
have ended it climbs to return, too far off its path for a program that is resumed, which leaves it to that.
"""

FLIGHTS = (
    *(flight for craft in (COPTER, ROVER, SUB) for flight in _ways(craft)),
    *ROVERS,
    *CRAWLERS,
    *DIVES,
    *WINDS,
    *LAWNS,
    *(flight for craft in (COPTER, ROVER, SUB) for flight in _orders(craft)),
    *(flight for craft in (COPTER, ROVER, SUB) for flight in _faults(craft)),
    *MOTORS,
    *FENCES,
    *AREAS,
    *BUOY,
    *(flight for craft in (COPTER, ROVER, SUB) for flight in _resumes(craft)),
    *EXAMPLES,
    *PX4S,
)
