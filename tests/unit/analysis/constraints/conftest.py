"""A small sound project in memory, for tests to break."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from mmrs_core.analysis.constraints import CONSTRAINTS, check_constraints
from mmrs_core.languages import behaviour, context, mission, robot
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import MetamodelSource, Registry, registry_with

FIXTURES = Path(__file__).parents[3] / "fixtures" / "constraints"


def at(x: float, y: float, z: float = 0.0, **more: object) -> Element:
    return mission.RelativeCoordinate(x=x, y=y, z=z, **more)


def geo(latitude: float, longitude: float, **heights: float) -> Element:
    return mission.GeoCoordinate(latitude=latitude, longitude=longitude, **heights)


def box(x: float, y: float, size: float, z: float = 0.0) -> list[Element]:
    return [at(x, y, z), at(x + size, y, z), at(x + size, y + size, z), at(x, y + size, z)]


def quad() -> Element:
    return robot.Robot(
        name="quad",
        size=robot.Size(width=0.8, length=0.6, height=1.2, weight=2.0),
        maxPayload=1.0,
        communicationRange=2000.0,
        maxOperatingPressure=120_000.0,
        operatingTemperature=robot.Interval(min=-10.0, max=40.0),
        batteries=[robot.Battery(capacity=5000.0, voltage=22.2, rechargeTime=900.0)],
        movementCapabilities=[
            robot.MovementCapability(
                payloadWeight=weight, lifetime=lifetime, speed=robot.Interval(min=0.0, max=10.0)
            )
            for weight, lifetime in ((0.0, 1500.0), (1.0, 1000.0))
        ],
        devices=[
            robot.Device(
                id="cam",
                properties=[robot.Property(name="focal.length", value="8.8")],
                supportedActions=[
                    robot.SupportedAction(name="Look", duration=1.0, parameters=[robot.Parameter(key="zoom")])
                ],
            ),
            robot.Device(id="horn", supportedActions=[robot.SupportedAction(name="Beep")]),
        ],
        policies=[robot.Policy(event="LINK_LOST", response="RETURN", after=5.0)],
    )


def place() -> Element:
    return context.Context(
        name="valley",
        forbiddenAreas=[context.Area(name="airfield", shell=box(500, 500, 100), safetyDistance=10.0)],
        obstacles=[
            context.Obstacle(
                name="tower", shell=box(200, 0, 20), safetyDistance=5.0, minHeight=0.0, maxHeight=30.0
            )
        ],
        emergencyAreas=[context.Area(name="meadow", shell=box(-200, -200, 50), safetyDistance=2.0)],
        corridors=[
            context.Corridor(
                name="gate",
                points=[at(20, 20), at(60, 60)],
                width=10.0,
                minHeight=10.0,
                maxHeight=50.0,
                robotTypes=["quad"],
            )
        ],
        environment=context.Environment(
            windSpeed=3.0,
            windDirection=270.0,
            currentSpeed=0.1,
            currentDirection=90.0,
            temperature=20.0,
            waterDensity=1000.0,
            irradiance=500.0,
        ),
    )


def errand(registry: Registry) -> Element:
    def make(kind: str, **features: object) -> Element:
        return registry.create("urn:test:trial", kind, **features)

    visit = make("Visit", name="visit", point=at(50, 50, 20), requiredDevices=["cam"])
    sweep = make(
        "Sweep",
        name="sweep",
        altitude=40.0,
        initialPosition=at(100, 100),
        shell=box(100, 100, 100),
        holes=[mission.Ring(points=box(120, 120, 20)), mission.Ring(points=box(160, 160, 20))],
    )
    follow = make(
        "Follow",
        name="follow",
        altitude=40.0,
        initialPosition=at(0, 200),
        points=[at(0, 200), at(100, 250), at(100, 300)],
    )
    extra = make("Visit", name="extra", point=at(0, 300, 20))
    fork, join = mission.Fork(name="fork"), mission.Join(name="join")
    either, closing = mission.Fork(name="either"), mission.Join(name="closing")
    ways = [
        (fork, visit, None),
        (fork, sweep, None),
        (visit, join, None),
        (sweep, join, None),
        (join, either, None),
        (either, extra, "dry"),
        (either, closing, None),
        (extra, closing, None),
        (closing, follow, None),
    ]
    return mission.Mission(
        name="errand",
        origin=geo(42.37, 13.35, altitude=700.0),
        team=mission.Team(
            robots=[
                mission.Robot(name="r1", type="quad", home=at(0, 0)),
                mission.Robot(name="r2", type="quad", home=at(10, 0)),
            ]
        ),
        tasks=[fork, visit, sweep, join, either, extra, closing, follow],
        taskDependencies=[
            mission.TaskDependency(from_=before, to=after, condition=condition)
            for before, after, condition in ways
        ],
        policies=[robot.Policy(event="LINK_LOST", response="HOLD", after=1.0)],
        acceptedUnknowns=["clearance"],
        minimumSeparation=5.0,
    )


def program() -> Element:
    home, far, thing = (
        behaviour.GeoCoordinate(name="home", latitude=42.37, longitude=13.35, altitude=700.0),
        behaviour.RelativeCoordinate(name="far", x=50.0, y=50.0, z=20.0),
        behaviour.ObjectTarget(name="thing", description="buoy", tolerance=2.0),
    )
    thing.expectedAt = far
    ready, done = behaviour.Slot(name="ready"), behaviour.Slot(name="done")

    def walker(name: str, own: Element, other: Element) -> Element:
        start, stop = behaviour.Start(name="start"), behaviour.Stop(name="stop")
        go = behaviour.GoTo(
            name="go",
            target=far,
            speed=5.0,
            heading=behaviour.Heading(deviceId="cam", target=thing),
            postActions=[
                behaviour.DeviceAction(
                    deviceId="cam", actionName="Look", parameters=[behaviour.Pair(key="zoom", value="2")]
                ),
                behaviour.UnicastNotify(slot=other),
            ],
        )
        hold = behaviour.HoldPosition(name="hold", duration=5.0)
        wait = behaviour.Recharge(name="recharge", duration=900.0)
        choice = behaviour.Choice(from_=hold, to=wait, falseBranch=stop, conditionIdentifier="empty")
        plain = [behaviour.MoveTransition(from_=a, to=b) for a, b in ((start, go), (wait, stop))]
        awaiting = behaviour.MoveTransition(from_=go, to=hold, waitFor=[own])
        return behaviour.Robot(
            id=name,
            typeName="quad",
            home=home,
            slots=[own],
            moves=[start, go, hold, wait, stop],
            moveTransitions=[*plain, awaiting, choice],
        )

    return behaviour.Behaviour(
        name="errand",
        robots=[walker("r1", ready, done), walker("r2", done, ready)],
        targets=[home, far, thing],
    )


@dataclass(frozen=True)
class Models:
    """The project, and what edits of it need."""

    registry: Registry
    mission: Element
    context: Element
    quad: Element
    behaviour: Element

    at = staticmethod(at)
    geo = staticmethod(geo)
    box = staticmethod(box)

    def put(self, element: Element, **features: object) -> None:
        for name, value in features.items():
            setattr(element, name, value)

    def trial(self, kind: str, **features: object) -> Element:
        return self.registry.create("urn:test:trial", kind, **features)

    def task(self, name: str) -> Element:
        return next(task for task in self.mission.tasks if task.name == name)

    def way(self, before: str, after: str) -> Element:
        return next(
            each
            for each in self.mission.taskDependencies
            if (each.from_.name, each.to.name) == (before, after)
        )

    def link(self, before: Element, after: Element, condition: str | None = None) -> None:
        made = mission.TaskDependency(from_=before, to=after, condition=condition)
        self.mission.taskDependencies.append(made)

    def move(self, name: str, robot: int = 0) -> Element:
        return next(move for move in self.behaviour.robots[robot].moves if move.name == name)

    def transition(self, before: str, robot: int = 0) -> Element:
        transitions = self.behaviour.robots[robot].moveTransitions
        return next(each for each in transitions if each.from_ is not None and each.from_.name == before)

    @property
    def as_set(self) -> ModelSet:
        return ModelSet(self.mission, self.context, {"quad": self.quad}, (), self.behaviour)

    def faults(self, constraints=CONSTRAINTS):
        return check_constraints(self.as_set, constraints, self.registry)

    def codes(self) -> set[str]:
        return {fault.code for fault in self.faults()}


@pytest.fixture(scope="session")
def registry() -> Registry:
    return registry_with([MetamodelSource("urn:test:trial", FIXTURES / "trial.ecore")])


@pytest.fixture
def fresh_models(registry: Registry) -> Callable[[], Models]:
    """Return a function that makes the sound project anew."""
    return lambda: Models(registry, errand(registry), place(), quad(), program())


@pytest.fixture
def models(fresh_models: Callable[[], Models]) -> Models:
    return fresh_models()
