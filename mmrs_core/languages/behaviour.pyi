"""Typed stubs of urn:mmrs:behaviour:1.0, made by "mmrs metamodel stubs"; not to be edited."""

from collections.abc import Iterable
from typing import Final

from mmrs_core.languages import robot
from mmrs_core.languages.element import Element

NS_URI: Final[str]

class Behaviour(Element):
    """The behaviour of all robots of a mission."""
    name: str | None
    """Name of the mission that the behaviour was derived from, or of the behaviour."""
    crs: str
    """Coordinate reference system of all geographic coordinates."""
    altitudeReference: robot.AltitudeReference
    """Reference of the altitudes of geographic coordinates."""
    origin: Coordinate | None
    """The point (0, 0, 0) of the local metric frame; absent: the home of the first robot that has one."""
    surfaceHeight: float
    """Height of the water surface above the origin, in metres; depths count down from it."""
    geoidSeparation: float | None
    """Height of mean sea level above the ellipsoid at the origin, in metres; absent: unknown."""
    positionError: float
    """Largest error of a robot's position estimate, in metres; added to every clearance."""
    minimumSeparation: float | None
    """Smallest distance allowed between two robots, in metres; absent: not checked."""
    reserve: float
    """Fraction of a robot's lifetime and energy that must remain unused, from 0 to 1."""
    acceptedUnknowns: list[str]
    """Names of the properties that may remain unknown when the behaviour is checked."""
    robots: list[Robot]
    """The robots."""
    idleRobots: list[Robot]
    """Idle robots of the team: they are not run and stand at their homes, where the others keep clear of them."""
    targets: list[Target]
    """The positions and objects that moves, headings and homes refer to."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        crs: str | None = ...,
        altitudeReference: robot.AltitudeReference | None = ...,
        origin: Coordinate | None = ...,
        surfaceHeight: float | None = ...,
        geoidSeparation: float | None = ...,
        positionError: float | None = ...,
        minimumSeparation: float | None = ...,
        reserve: float | None = ...,
        acceptedUnknowns: Iterable[str] | None = ...,
        robots: Iterable[Robot] | None = ...,
        idleRobots: Iterable[Robot] | None = ...,
        targets: Iterable[Target] | None = ...,
    ) -> None: ...

class Robot(Element):
    """One robot and all its moves."""
    id: str
    """Identifier, unique during the mission."""
    typeName: str
    """Name of the robot type in the Robot Language."""
    travelMode: robot.TravelMode
    """Trade-off between speed and caution."""
    payload: float
    """Weight of the robot's payload in addition to its own devices, in kilograms."""
    home: Coordinate | None
    """Position of the robot at the beginning of the mission."""
    slots: list[Slot]
    """Slots that other robots can activate to synchronise with this one."""
    moves: list[Move]
    """All moves of the robot."""
    moveTransitions: list[MoveTransition]
    """Transitions between the moves."""
    policies: list[robot.Policy]
    """Responses to faults; they take precedence over the policies of the robot type."""
    def __init__(
        self,
        *,
        id: str | None = ...,
        typeName: str | None = ...,
        travelMode: robot.TravelMode | None = ...,
        payload: float | None = ...,
        home: Coordinate | None = ...,
        slots: Iterable[Slot] | None = ...,
        moves: Iterable[Move] | None = ...,
        moveTransitions: Iterable[MoveTransition] | None = ...,
        policies: Iterable[robot.Policy] | None = ...,
    ) -> None: ...

class Target(Element):
    """Target of a move or a heading."""
    name: str | None
    """Name shown on maps and in messages."""
    def __init__(
        self,
        *,
        name: str | None = ...,
    ) -> None: ...

class Coordinate(Target):
    """A position."""
    def __init__(
        self,
        *,
        name: str | None = ...,
    ) -> None: ...

class GeoCoordinate(Coordinate):
    """A geographic position."""
    latitude: float
    """Geographic latitude, in degrees, north positive."""
    longitude: float
    """Geographic longitude, in degrees, east positive."""
    altitude: float | None
    """Height above the altitude reference, in metres; absent: at the height of the origin. Not together with depth."""
    depth: float | None
    """Vertical distance below the surface of ground or water, in metres. Not together with altitude."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        latitude: float | None = ...,
        longitude: float | None = ...,
        altitude: float | None = ...,
        depth: float | None = ...,
    ) -> None: ...

class RelativeCoordinate(Coordinate):
    """A position relative to another one."""
    x: float
    """Metres to the east of the reference."""
    y: float
    """Metres to the north of the reference."""
    z: float
    """Metres above the reference."""
    reference: Coordinate | None
    """The coordinate that x, y and z count from; absent: the origin."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        x: float | None = ...,
        y: float | None = ...,
        z: float | None = ...,
        reference: Coordinate | None = ...,
    ) -> None: ...

class ObjectTarget(Target):
    """An object that the robot locates with its own sensors."""
    description: str
    """Description of the object: an identifier, a URL of a model of it, or a concept of an ontology."""
    expectedAt: Coordinate | None
    """Expected position of the object; absent: unknown."""
    tolerance: float | None
    """Largest distance of the object from its expected position, in metres; absent: unknown."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        description: str | None = ...,
        expectedAt: Coordinate | None = ...,
        tolerance: float | None = ...,
    ) -> None: ...

class Move(Element):
    """An atomic movement."""
    name: str | None
    """Name, unique in the robot."""
    task: str | None
    """Name of the task that the move serves; absent: none."""
    rule: str | None
    """Name of the rule that made the move; absent: written by hand."""
    preActions: list[Action]
    """Actions before the movement, in order."""
    postActions: list[Action]
    """Actions after the movement, in order."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        task: str | None = ...,
        rule: str | None = ...,
        preActions: Iterable[Action] | None = ...,
        postActions: Iterable[Action] | None = ...,
    ) -> None: ...

class Start(Move):
    """The first move; every robot has exactly one."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        task: str | None = ...,
        rule: str | None = ...,
        preActions: Iterable[Action] | None = ...,
        postActions: Iterable[Action] | None = ...,
    ) -> None: ...

class Stop(Move):
    """The last move; every robot has exactly one."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        task: str | None = ...,
        rule: str | None = ...,
        preActions: Iterable[Action] | None = ...,
        postActions: Iterable[Action] | None = ...,
    ) -> None: ...

class HoldPosition(Move):
    """Keeps the current position."""
    duration: float
    """Duration, in seconds."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        task: str | None = ...,
        rule: str | None = ...,
        preActions: Iterable[Action] | None = ...,
        postActions: Iterable[Action] | None = ...,
        duration: float | None = ...,
    ) -> None: ...

class Recharge(HoldPosition):
    """Waits at home until the batteries are full again."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        task: str | None = ...,
        rule: str | None = ...,
        preActions: Iterable[Action] | None = ...,
        postActions: Iterable[Action] | None = ...,
        duration: float | None = ...,
    ) -> None: ...

class HeadTo(Move):
    """Turns on the spot."""
    heading: Heading
    """Heading to turn to."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        task: str | None = ...,
        rule: str | None = ...,
        preActions: Iterable[Action] | None = ...,
        postActions: Iterable[Action] | None = ...,
        heading: Heading | None = ...,
    ) -> None: ...

class GoTo(Move):
    """Goes to a target."""
    target: Target
    """The position or object to go to."""
    distance: float
    """Distance between the robot and the target at the end, in metres."""
    heading: Heading | None
    """Orientation of the robot along the path; absent: its front points along the path."""
    speed: float | None
    """Speed, in metres per second; absent: defined by the travel mode."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        task: str | None = ...,
        rule: str | None = ...,
        preActions: Iterable[Action] | None = ...,
        postActions: Iterable[Action] | None = ...,
        target: Target | None = ...,
        distance: float | None = ...,
        heading: Heading | None = ...,
        speed: float | None = ...,
    ) -> None: ...

class Heading(Element):
    """An orientation: a device points at a target."""
    deviceId: str | None
    """Identifier of the device in the robot's type; absent: the front of the robot."""
    target: Target
    """Target that the device points at."""
    angle: float
    """Angle between the device and the direction to the target, in degrees: at 90 the target is on the device's right side."""
    def __init__(
        self,
        *,
        deviceId: str | None = ...,
        target: Target | None = ...,
        angle: float | None = ...,
    ) -> None: ...

class MoveTransition(Element):
    """Transition from one move to the next."""
    from_: Move
    """The move that ends."""
    to: Move
    """The move that begins."""
    waitFor: list[Slot]
    """Own slots that must all be active before the transition is taken."""
    fluid: bool
    """Whether the robot passes from one move into the next without a stop."""
    policies: list[robot.Policy]
    """Responses to faults during this wait; they take precedence over the policies of the robot and its type."""
    def __init__(
        self,
        *,
        from_: Move | None = ...,
        to: Move | None = ...,
        waitFor: Iterable[Slot] | None = ...,
        fluid: bool | None = ...,
        policies: Iterable[robot.Policy] | None = ...,
    ) -> None: ...

class Choice(MoveTransition):
    """A branch: a condition decides which move follows."""
    conditionIdentifier: str
    """Identifier of the condition; if it holds, the robot continues with the move at to."""
    falseBranch: Move
    """The move that follows if the condition does not hold."""
    def __init__(
        self,
        *,
        from_: Move | None = ...,
        to: Move | None = ...,
        waitFor: Iterable[Slot] | None = ...,
        fluid: bool | None = ...,
        policies: Iterable[robot.Policy] | None = ...,
        conditionIdentifier: str | None = ...,
        falseBranch: Move | None = ...,
    ) -> None: ...

class Slot(Element):
    """A variable of the robot that is either active or not; not active at the beginning."""
    name: str
    """Name, unique in the robot."""
    def __init__(
        self,
        *,
        name: str | None = ...,
    ) -> None: ...

class Action(Element):
    """An action before or after a movement."""
    name: str | None
    """Name shown on maps and in messages."""
    def __init__(
        self,
        *,
        name: str | None = ...,
    ) -> None: ...

class DeviceAction(Action):
    """An action of a device."""
    actionName: str
    """Name of the action, among the supported actions of the device."""
    deviceId: str
    """Identifier of the device in the robot's type."""
    parameters: list[Pair]
    """Values of the action's parameters."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        actionName: str | None = ...,
        deviceId: str | None = ...,
        parameters: Iterable[Pair] | None = ...,
    ) -> None: ...

class CommunicationAction(Action):
    """A message to the control station or to other robots."""
    def __init__(
        self,
        *,
        name: str | None = ...,
    ) -> None: ...

class Feedback(CommunicationAction):
    """Sends a message to the control station."""
    payload: list[Pair]
    """Content of the message."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        payload: Iterable[Pair] | None = ...,
    ) -> None: ...

class Notify(CommunicationAction):
    """Sets slots of robots."""
    active: bool
    """Whether the slots become active or inactive."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        active: bool | None = ...,
    ) -> None: ...

class UnicastNotify(Notify):
    """Sets one slot of one robot."""
    slot: Slot
    """The slot; the receiver is the robot that owns it."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        active: bool | None = ...,
        slot: Slot | None = ...,
    ) -> None: ...

class MulticastNotify(Notify):
    """Sets several slots at once."""
    slots: list[Slot]
    """The slots; the receivers are the robots that own them."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        active: bool | None = ...,
        slots: Iterable[Slot] | None = ...,
    ) -> None: ...

class BroadcastNotify(Notify):
    """Sets the slot of one name in every robot that has it, the sender included."""
    slot: Slot
    """Any slot of that name."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        active: bool | None = ...,
        slot: Slot | None = ...,
    ) -> None: ...

class Pair(Element):
    """A key and its value."""
    key: str
    """The key."""
    value: str
    """The value."""
    def __init__(
        self,
        *,
        key: str | None = ...,
        value: str | None = ...,
    ) -> None: ...
