"""Numbers that only make sense within a range: checks that plug-ins use as well, and the core's own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from math import inf, isfinite
from typing import TypeAlias

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, CONTEXT, MISSION, ROBOT, called
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.grounding.features import number
from mmrs_core.languages.element import Element, is_kind
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Name


@dataclass(frozen=True, slots=True)
class Range:
    """The check that features lie in a range; the bounds belong to it unless they are said to be excluded.

    Values that are not finite are breaches of the metamodel, and reported as such.
    """

    features: tuple[str, ...]
    low: float = -inf
    high: float = inf
    without_low: bool = False
    without_high: bool = False

    def __call__(self, element: Element, models: ModelSet) -> Iterator[Finding]:
        """Yield the features of an element that lie outside."""
        for feature in self.features:
            found = number(element, feature)
            if found is not None and isfinite(found) and not self._holds(found):
                words = f"{feature} of {called(element)} is {found:g}, but must be {self._words()}"
                yield Finding(element, words)

    def _holds(self, found: float) -> bool:
        above = found > self.low if self.without_low else found >= self.low
        below = found < self.high if self.without_high else found <= self.high
        return above and below

    def _words(self) -> str:
        low = f"{'more than' if self.without_low else 'at least'} {self.low:g}"
        high = f"{'less than' if self.without_high else 'at most'} {self.high:g}"
        return " and ".join(
            words for words, bound in ((low, self.low), (high, self.high)) if abs(bound) < inf
        )


def at_least_zero(*features: str) -> Range:
    """Return the check that features are not negative."""
    return Range(features, low=0.0)


def positive(*features: str) -> Range:
    """Return the check that features are more than 0."""
    return Range(features, low=0.0, without_low=True)


def share(*features: str) -> Range:
    """Return the check that features are parts of a whole: at least 0, and less than 1."""
    return Range(features, low=0.0, high=1.0, without_high=True)


Check: TypeAlias = Callable[[Element, ModelSet], Iterable[Finding]]


def every(*checks: Check) -> Check:
    """Return the check that makes several, one after the other."""
    return lambda element, models: (found for check in checks for found in check(element, models))


def of_kind(metaclass: Name, check: Check) -> Check:
    """Return a check that only concerns elements of a metaclass."""
    return lambda element, models: check(element, models) if is_kind(element, *metaclass) else ()


CONSTRAINTS = (
    *Constraint(
        "MML005",
        "The reserve is a part of the whole: at least 0 and less than 1.",
        (MISSION, "Mission"),
        share("reserve"),
        "write 0.2 for a reserve of twenty per cent",
    ).also(("BL046", (BEHAVIOUR, "Behaviour"))),
    Constraint(
        "MML006",
        "Position error and separation of a mission are not negative.",
        (MISSION, "Mission"),
        at_least_zero("positionError", "minimumSeparation"),
        "give the distance in metres, or leave it out",
    ),
    Constraint(
        "MML009",
        "The largest gap of a mission is more than 0.",
        (MISSION, "Mission"),
        positive("largestGap"),
        "give the distance in metres, or leave it out",
    ),
    *Constraint(
        "MML007",
        "The payload of a robot is not negative.",
        (MISSION, "Robot"),
        at_least_zero("payload"),
        "give the weight in kilograms, 0 for none",
    ).also(("BL026", (BEHAVIOUR, "Robot"))),
    *Constraint(
        "MML010",
        "The depth of a coordinate is not negative.",
        (MISSION, "GeoCoordinate"),
        at_least_zero("depth"),
        "depth counts down from the surface; use altitude for what is above it",
    ).also(("BL028", (BEHAVIOUR, "GeoCoordinate"))),
    Constraint(
        "MML060",
        "A task does not begin before the mission.",
        (MISSION, "Task"),
        at_least_zero("earliestStart"),
        "earliestStart counts seconds from the mission's start",
    ),
    Constraint(
        "MML061",
        "A task has some time: its deadline and its longest duration are more than 0.",
        (MISSION, "Task"),
        positive("deadline", "maxDuration"),
        "give the time in seconds, or leave it out where there is no limit",
    ),
    Constraint(
        "MML062",
        "The robotsWanted of a task is at least 1.",
        (MISSION, "Task"),
        Range(("robotsWanted",), low=1.0),
        "leave robotsWanted out to let as many robots share the task as help",
    ),
    Constraint(
        "MML056",
        "The turnaround distance of a task is not negative.",
        (MISSION, "SweepTask"),
        at_least_zero("turnaroundDistance"),
        "give the distance in metres beyond the area's border, or leave it out",
    ),
    Constraint(
        "CTX005",
        "The safety distance of an area is not negative.",
        (CONTEXT, "Area"),
        at_least_zero("safetyDistance"),
        "draw the area smaller if robots may come into it",
    ),
    Constraint(
        "CTX020",
        "The range of a relay is more than 0.",
        (CONTEXT, "Relay"),
        positive("range"),
        "give the range of its radio in metres",
    ),
    Constraint(
        "CTX018",
        "A corridor has a width.",
        (CONTEXT, "Corridor"),
        positive("width"),
        "give the metres from one side of the corridor to the other",
    ),
    Constraint(
        "CTX011",
        "Wind, current and sunshine are not negative.",
        (CONTEXT, "Environment"),
        at_least_zero("windSpeed", "currentSpeed", "irradiance"),
        "give wind and current a direction turned by 180 degrees instead; without sun the irradiance is 0",
    ),
    Constraint(
        "CTX012",
        "Directions of wind and current lie between 0 and 360 degrees.",
        (CONTEXT, "Environment"),
        Range(("windDirection", "currentDirection"), low=0.0, high=360.0),
        "count degrees clockwise from north: 90 is east",
    ),
    Constraint(
        "CTX013",
        "The temperature is above absolute zero.",
        (CONTEXT, "Environment"),
        Range(("temperature",), low=-273.15),
        "give the temperature in degrees Celsius",
    ),
    Constraint(
        "CTX014",
        "The density of the water is that of some water.",
        (CONTEXT, "Environment"),
        Range(("waterDensity",), low=900.0, high=1300.0),
        "give it in kilograms per cubic metre: 1000 for fresh water, about 1025 for sea water",
    ),
    Constraint(
        "RL006",
        "The dimensions and the weight of a robot are more than 0.",
        (ROBOT, "Size"),
        positive("width", "length", "height", "weight"),
        "clearances follow from the dimensions; give them in metres, and the weight in kilograms",
    ),
    Constraint(
        "RL007",
        "A battery has a capacity and a voltage.",
        (ROBOT, "Battery"),
        positive("capacity", "voltage"),
        "capacity is in milliampere-hours, voltage in volts; a wired robot has no batteries",
    ),
    Constraint(
        "RL008",
        "The recharge time of a battery is not negative.",
        (ROBOT, "Battery"),
        at_least_zero("rechargeTime"),
        "leave rechargeTime out where the battery cannot be recharged during a mission",
    ),
    Constraint(
        "RL010",
        "The payload that figures hold for is not negative.",
        (ROBOT, "MovementCapability"),
        at_least_zero("payloadWeight"),
        "give the weight in kilograms, 0 for none",
    ),
    Constraint(
        "RL011",
        "Lifetime, acceleration and rates of a movement are more than 0.",
        (ROBOT, "MovementCapability"),
        positive(
            "lifetime", "maxAcceleration", "maxClimbRate", "maxDescentRate", "maxTurnRate", "landingRate"
        ),
        "leave out what is not known",
    ),
    Constraint(
        "RL032",
        "Times of launching and landing, and the height of the last descent, are not negative.",
        (ROBOT, "MovementCapability"),
        at_least_zero("launchTime", "recoveryTime", "landingHeight"),
        "leave out what is not known",
    ),
    Constraint(
        "RL033",
        "Speeds, accelerations, jerk and time constants of a leg timing are more than 0.",
        (ROBOT, "LegTiming"),
        positive(
            "maxSpeed",
            "maxAcceleration",
            "maxDeceleration",
            "maxVerticalAcceleration",
            "maxJerk",
            "maxClimbRate",
            "maxDescentRate",
            "lagTime",
        ),
        "leave out what is not known",
    ),
    Constraint(
        "RL034",
        "The corner radius, the settling time, the overshoot and the lag of a leg timing are not negative.",
        (ROBOT, "LegTiming"),
        at_least_zero("cornerRadius", "settlingTime", "overshoot", "lag"),
        "leave out what is not known",
    ),
    Constraint(
        "RL035",
        "The spread of a leg timing is a share, 0 to less than 1.",
        (ROBOT, "LegTiming"),
        share("spread"),
        "give the share by which legs take longer or shorter than expected, such as 0.1",
    ),
    Constraint(
        "RL012",
        "The largest payload is not negative.",
        (ROBOT, "Robot"),
        at_least_zero("maxPayload"),
        "give the weight in kilograms; leave it out where the robot carries nothing",
    ),
    Constraint(
        "RL013",
        "Ranges, data rate, frequency and pressure of a robot are more than 0.",
        (ROBOT, "Robot"),
        positive("communicationRange", "relayRange", "dataRate", "radioFrequency", "maxOperatingPressure"),
        "leave out what is not known",
    ),
    Constraint(
        "RL014",
        "Action durations are not negative.",
        (ROBOT, "SupportedAction"),
        at_least_zero("duration"),
        "give the duration in seconds, 0 for an instant",
    ),
    Constraint(
        "RL015",
        "The delay of a policy is not negative.",
        (ROBOT, "Policy"),
        at_least_zero("after"),
        "give the delay in seconds, 0 for at once",
    ),
    Constraint(
        "BL047",
        "Position error and separation of a behaviour are not negative.",
        (BEHAVIOUR, "Behaviour"),
        at_least_zero("positionError", "minimumSeparation"),
        "give the distance in metres, or leave it out",
    ),
    Constraint(
        "BL023",
        "The duration of a hold is not negative.",
        (BEHAVIOUR, "HoldPosition"),
        at_least_zero("duration"),
        "give the duration in seconds",
    ),
    Constraint(
        "BL024",
        "The distance from a target is not negative.",
        (BEHAVIOUR, "GoTo"),
        at_least_zero("distance"),
        "give the distance in metres, 0 for the target itself",
    ),
    Constraint(
        "BL025",
        "A commanded speed is more than 0.",
        (BEHAVIOUR, "GoTo"),
        positive("speed"),
        "leave the speed out to go by the travel mode",
    ),
    Constraint(
        "BL027",
        "The tolerance of an object's place is not negative.",
        (BEHAVIOUR, "ObjectTarget"),
        at_least_zero("tolerance"),
        "leave it out where it is not known",
    ),
)
