"""Typed stubs of urn:mmrs:robot:1.0, made by "mmrs metamodel stubs"; not to be edited."""

from collections.abc import Iterable
from typing import Final, Literal, TypeAlias

from mmrs_core.languages.element import Element

NS_URI: Final[str]

RangingSystem: TypeAlias = Literal["SONAR", "RADAR", "LIDAR", "SODAR"]
"""Systems for navigation, detection and ranging."""

TravelMode: TypeAlias = Literal["SAFE", "NORMAL", "AGGRESSIVE"]
"""Trade-offs between speed and caution."""

AltitudeReference: TypeAlias = Literal["ELLIPSOID", "MSL", "ORIGIN"]
"""References of altitudes."""

LegMode: TypeAlias = Literal["STEP", "MISSION"]
"""How an autopilot is commanded to take legs."""

PolicyEvent: TypeAlias = Literal["LINK_LOST", "PEER_LOST", "BATTERY_LOW", "WAIT_TOO_LONG", "DEVICE_SILENT", "POSITION_LOST", "OBSTACLE", "FENCE_BREACHED", "VEHICLE_RESTARTED", "LOG_FAILED", "GROUND_LOST", "MOTOR_FAILED"]
"""Faults that a policy responds to."""

PolicyResponse: TypeAlias = Literal["HOLD", "RETURN", "EMERGENCY_AREA", "LAND", "SURFACE", "STOP_THRUST", "CONTINUE"]
"""Responses of a robot to a fault."""

class Robot(Element):
    """A robot type. Every robot of a mission names its type."""
    name: str
    """Unique name of the type; mission robots and behaviours refer to it."""
    onBoardObstacleAvoidance: bool
    """Whether the robot avoids collisions autonomously."""
    gyro: bool
    """Whether a gyroscope is on board."""
    gps: bool
    """Whether a satellite positioning receiver is on board."""
    accelerometer: bool
    """Whether an accelerometer is on board."""
    magnetometer: bool
    """Whether a magnetometer is on board."""
    barometer: bool
    """Whether a barometer is on board."""
    pressuremeter: bool
    """Whether a pressure meter is on board."""
    communicationRange: float | None
    """Maximum range of the radio control, in metres, to the control station at home, to a relay of the context or to a robot that is a relay; absent: unknown."""
    relayRange: float | None
    """Maximum range, in metres, of the relay on board, which passes on the radio between other robots, relays and the control station while the robot holds its position, a robot that launches off the ground only; absent: it carries no relay."""
    dataRate: float | None
    """Data rate between robot and control station, in kilobits per second."""
    radioFrequency: float | None
    """Radio frequency between robot and control station, in megahertz."""
    rangingSystem: list[RangingSystem]
    """The ranging systems that operate in the robot."""
    maxPayload: float | None
    """Largest payload that the robot can carry, in kilograms; absent: it carries none."""
    maxOperatingPressure: float | None
    """Largest ambient pressure in which the robot operates, in pascals absolute."""
    hardwareConfiguration: str | None
    """Path or URL of a document that describes the hardware; never fetched."""
    operatingTemperature: Interval | None
    """Ambient temperatures in which the robot operates, in degrees Celsius."""
    size: Size
    """The robot's dimensions."""
    devices: list[Device]
    """Devices that gather data or act on the world."""
    batteries: list[Battery]
    """The robot's batteries; none where it has a wired power source."""
    movementCapabilities: list[MovementCapability]
    """How the robot moves, one entry for each payload weight that was measured."""
    policies: list[Policy]
    """Responses of robots of this type to faults, unless the mission defines others."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        onBoardObstacleAvoidance: bool | None = ...,
        gyro: bool | None = ...,
        gps: bool | None = ...,
        accelerometer: bool | None = ...,
        magnetometer: bool | None = ...,
        barometer: bool | None = ...,
        pressuremeter: bool | None = ...,
        communicationRange: float | None = ...,
        relayRange: float | None = ...,
        dataRate: float | None = ...,
        radioFrequency: float | None = ...,
        rangingSystem: Iterable[RangingSystem] | None = ...,
        maxPayload: float | None = ...,
        maxOperatingPressure: float | None = ...,
        hardwareConfiguration: str | None = ...,
        operatingTemperature: Interval | None = ...,
        size: Size | None = ...,
        devices: Iterable[Device] | None = ...,
        batteries: Iterable[Battery] | None = ...,
        movementCapabilities: Iterable[MovementCapability] | None = ...,
        policies: Iterable[Policy] | None = ...,
    ) -> None: ...

class Size(Element):
    """The outer dimensions of a robot."""
    width: float
    """Left to right, in metres."""
    length: float
    """Front to back, in metres."""
    height: float
    """Bottom to top, in metres."""
    weight: float
    """Mass without payload, in kilograms."""
    def __init__(
        self,
        *,
        width: float | None = ...,
        length: float | None = ...,
        height: float | None = ...,
        weight: float | None = ...,
    ) -> None: ...

class Interval(Element):
    """A closed interval of a real quantity, in the unit of its owner."""
    min: float
    """The smallest value."""
    max: float
    """The largest value."""
    def __init__(
        self,
        *,
        min: float | None = ...,
        max: float | None = ...,
    ) -> None: ...

class Device(Element):
    """A device that a robot carries, such as a camera, a sensor, a gripper or a lamp."""
    id: str
    """Identifier, unique in the robot type; behaviours refer to it."""
    name: str | None
    """Name of the device, as displayed."""
    properties: list[Property]
    """Configuration of the device; documented keys define how it is wired, so that targets need no tables of their own."""
    supportedActions: list[SupportedAction]
    """Actions that the device supports."""
    def __init__(
        self,
        *,
        id: str | None = ...,
        name: str | None = ...,
        properties: Iterable[Property] | None = ...,
        supportedActions: Iterable[SupportedAction] | None = ...,
    ) -> None: ...

class Property(Element):
    """One property of a device."""
    name: str
    """The key, such as sensor.width, focal.length or mount.yaw."""
    value: str
    """The value, as text; the key defines its unit."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        value: str | None = ...,
    ) -> None: ...

class SupportedAction(Element):
    """An action that a device can perform."""
    name: str
    """Name of the action, unique in the device; behaviours refer to it."""
    description: str | None
    """Description of the action."""
    duration: float
    """Duration of the action, in seconds."""
    parameters: list[Parameter]
    """The parameters that the action accepts."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        description: str | None = ...,
        duration: float | None = ...,
        parameters: Iterable[Parameter] | None = ...,
    ) -> None: ...

class Parameter(Element):
    """A parameter of an action."""
    key: str
    """Name of the parameter, unique in the action."""
    description: str | None
    """Meaning, unit and range of its values."""
    def __init__(
        self,
        *,
        key: str | None = ...,
        description: str | None = ...,
    ) -> None: ...

class Battery(Element):
    """A battery of the robot."""
    capacity: float
    """Charge when full, in milliampere-hours."""
    voltage: float
    """Nominal voltage, in volts."""
    rechargeTime: float | None
    """Time to a full charge or an exchange, in seconds; absent: it cannot be recharged during a mission."""
    def __init__(
        self,
        *,
        capacity: float | None = ...,
        voltage: float | None = ...,
        rechargeTime: float | None = ...,
    ) -> None: ...

class MovementCapability(Element):
    """How the robot moves while it carries a payload of one weight."""
    payloadWeight: float
    """Weight of the payload that the figures hold for, in kilograms."""
    lifetime: float | None
    """Estimated time that the robot operates on full batteries with that payload, in seconds; absent: unlimited for a wired robot, unknown for one with batteries."""
    maxAcceleration: float | None
    """Largest acceleration, in metres per second squared."""
    speed: Interval
    """Smallest and largest speed, in metres per second."""
    yaw: Interval | None
    """Range of the angle about the vertical axis, in degrees."""
    pitch: Interval | None
    """Range of the angle about the lateral axis, in degrees."""
    roll: Interval | None
    """Range of the angle about the longitudinal axis, in degrees."""
    maxClimbRate: float | None
    """Largest upward speed, in metres per second; absent: the largest speed."""
    maxDescentRate: float | None
    """Largest downward speed, in metres per second; absent: the largest speed."""
    maxTurnRate: float | None
    """Largest rate of turn about the vertical axis, in degrees per second; absent: 90."""
    launchTime: float | None
    """Time from the command to launch until the robot climbs, in seconds; absent: as its autopilot, or its kind, takes."""
    recoveryTime: float | None
    """Time from touching the ground until the robot stands still, its motors off, in seconds; absent: as its autopilot, or its kind, takes."""
    landingRate: float | None
    """Downward speed of the last part of a landing, in metres per second; absent: as its autopilot lands, or as it descends."""
    landingHeight: float | None
    """Height above the ground below which the robot comes down at its landing rate, in metres; absent: as its autopilot lands."""
    legTimings: list[LegTiming]
    """How the autopilot takes straight legs, as measured: one entry for legs that are commanded one by one, one for those of missions. What they leave open is as the autopilot takes legs by default, within the limits above."""
    def __init__(
        self,
        *,
        payloadWeight: float | None = ...,
        lifetime: float | None = ...,
        maxAcceleration: float | None = ...,
        speed: Interval | None = ...,
        yaw: Interval | None = ...,
        pitch: Interval | None = ...,
        roll: Interval | None = ...,
        maxClimbRate: float | None = ...,
        maxDescentRate: float | None = ...,
        maxTurnRate: float | None = ...,
        launchTime: float | None = ...,
        recoveryTime: float | None = ...,
        landingRate: float | None = ...,
        landingHeight: float | None = ...,
        legTimings: Iterable[LegTiming] | None = ...,
    ) -> None: ...

class LegTiming(Element):
    """How fast an autopilot takes straight legs. Every figure overrides the default of the autopilot."""
    flownAs: LegMode | None
    """How the legs are commanded; absent: both ways."""
    maxSpeed: float | None
    """Largest level speed that is reached, in metres per second."""
    maxAcceleration: float | None
    """Level acceleration, in metres per second squared."""
    maxDeceleration: float | None
    """Level deceleration, in metres per second squared; absent: as the acceleration, where that is given."""
    maxVerticalAcceleration: float | None
    """Upward and downward acceleration, in metres per second squared."""
    maxJerk: float | None
    """Change of the acceleration, in metres per second cubed."""
    maxClimbRate: float | None
    """Upward speed, in metres per second."""
    maxDescentRate: float | None
    """Downward speed, in metres per second."""
    cornerRadius: float | None
    """Distance from a corner within which it is passed without a stop, in metres; 0: every corner is a stop."""
    settlingTime: float | None
    """Time from the end of a leg until it is reported as done, in seconds."""
    overshoot: float | None
    """How far the robot goes beyond a target, in metres for each metre per second of the leg's largest speed: a time, in seconds."""
    lag: float | None
    """How much longer a long level leg takes, as the robot builds up the thrust against its drag only with time, in seconds."""
    lagTime: float | None
    """Time constant with which that thrust grows, in seconds."""
    spread: float | None
    """Share by which legs take longer or shorter than expected, 0 to 1; checks count with both."""
    def __init__(
        self,
        *,
        flownAs: LegMode | None = ...,
        maxSpeed: float | None = ...,
        maxAcceleration: float | None = ...,
        maxDeceleration: float | None = ...,
        maxVerticalAcceleration: float | None = ...,
        maxJerk: float | None = ...,
        maxClimbRate: float | None = ...,
        maxDescentRate: float | None = ...,
        cornerRadius: float | None = ...,
        settlingTime: float | None = ...,
        overshoot: float | None = ...,
        lag: float | None = ...,
        lagTime: float | None = ...,
        spread: float | None = ...,
    ) -> None: ...

class Policy(Element):
    """A robot's response to a fault."""
    event: PolicyEvent
    """The fault."""
    response: PolicyResponse
    """The response."""
    after: float | None
    """How long the fault lasts before the robot responds, in seconds; absent: the default of the platform for that event."""
    def __init__(
        self,
        *,
        event: PolicyEvent | None = ...,
        response: PolicyResponse | None = ...,
        after: float | None = ...,
    ) -> None: ...
