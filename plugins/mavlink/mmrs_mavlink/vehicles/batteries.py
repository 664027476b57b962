"""Whether the batteries of a vehicle suffice for its program: compared before it takes off."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_runtime.faults import RefusedError

from ..links.link import Link
from ..program import Charge, Robot
from ..services import parameters
from ..services.commands import command
from .inspection import Findings
from .telemetry import Telemetry
from .vehicle import FULL

MILLIAMPERE_HOUR = 3.6
WATT_HOUR = 3600.0
LEAST_CAPACITY = 10.0
"""Milliampere-hours up to which a capacity is none, as to ArduPilot (``AP_BattMonitor_Backend.cpp``)."""

BATTERY_RESET, ALL_BATTERIES = 42_651, 65_535.0
RENEWAL_SECONDS = 5.0
"""Within which a vehicle tells the new charge."""

SAME = 0.95
"""Part of the energy of the type's batteries from which on the vehicle's count as such."""


@dataclass(frozen=True, slots=True)
class _Held:
    """What the batteries of a vehicle hold when full, as it is set up.

    Attributes:
        names: of the parameters that say so.
        milliampere_hours: of all that are monitored. voltage: at which they are given.
    """

    names: tuple[str, ...]
    milliampere_hours: float
    voltage: float

    @property
    def joules(self) -> float:
        return self.milliampere_hours * MILLIAMPERE_HOUR * self.voltage

    def __str__(self) -> str:
        return f"{self.milliampere_hours:g} mAh at {self.voltage:.1f} V, {' + '.join(self.names)}"


def inspect_batteries(link: Link, telemetry: Telemetry, robot: Robot, *, at_start: bool) -> Findings:
    """Return whether what is left suffices for the first sortie of a program, and what is unknown of that.

    The energy is that of the capacity that the vehicle is set up with, at the nominal voltage of the robot's
    type, or at its own where that is lower. Of several batteries none counts as fuller than the emptiest.

    Args:
        link: to the vehicle, which stands on the ground.
        telemetry: of the vehicle.
        robot: its program.
        at_start: whether the first sortie is about to begin.
    """
    left, held = telemetry.least_energy(), _held(link, telemetry, robot.charge)
    if left is None:
        return Findings(lines=["unknown: battery: the vehicle does not report how much of it is left"])
    if held is None:
        reported = f"{left:.0%} is left, and the vehicle does not report the capacity"
        names = [capacity for capacity, _, _ in link.profile.autopilot.capacities[:1]]
        return Findings(lines=[f"unknown: battery: {' '.join([reported, *(f'({name})' for name in names)])}"])
    found = Findings()
    charge, lasts = robot.charge, robot.endurance
    has = f"battery: {_shown(left * held.joules)} are left ({left:.0%} of {held})"
    if charge is None or not lasts:
        found.lines.append(f"{has}; unknown: what the program takes, which its robot type does not state")
        return found
    if held.joules < SAME * charge.energy:
        has += f", and full batteries of its type hold {_shown(charge.energy)}"
    power, usable = charge.energy / lasts, (left - robot.reserve) * held.joules
    if at_start:
        _compare(found, has, charge, power, left * held.joules, usable, robot.reserve)
    else:
        found.lines.append(has)
    most = None if charge.longest is None else charge.longest * power
    if most is not None and (1.0 - robot.reserve) * held.joules < most and not found.defects:
        found.lines.append(
            f"battery: a sortie of the program takes up to {_shown(most)} (warning: a full battery holds"
            f" {_shown(held.joules)}, of which {robot.reserve:.0%} is the reserve)"
        )
    return found


def renew_battery(link: Link, telemetry: Telemetry) -> str:
    """Make a vehicle count its batteries as full; return why it does not; empty: it does, or never tells.

    What integrates the current, as an ArduPilot does, counts on after a change without a restart.
    """
    left, why = telemetry.energy(), ""
    if left is None or left >= FULL:
        return ""
    try:
        command(link, BATTERY_RESET, ALL_BATTERIES, 100.0)
    except RefusedError as error:
        why = f" ({error})"
    link.wait(lambda: (telemetry.energy() or 0.0) >= FULL, link.clock.patience(RENEWAL_SECONDS))
    left = telemetry.energy()
    if left is None or left >= FULL:
        return ""
    return f"its vehicle still reports {left:.0%}{why}: restart it with its new battery"


def _compare(
    found: Findings, has: str, charge: Charge, power: float, left: float, usable: float, reserve: float
) -> None:
    """Add whether what is left, and what of that is usable, suffices for the first sortie; joules."""
    least = charge.least * power
    if charge.most is None:
        takes = f"the first sortie takes {_shown(least)} at least"
        unknown = "; unknown: how much at most"
    else:
        takes, unknown = f"the first sortie takes up to {_shown(charge.most * power)}", ""
    kept = f"{takes}, with a reserve of {reserve:.0%}"
    if left < (charge.most or 0.0) * power or usable < least:
        found.defects.append(f"{has}; {kept}")
    elif usable < (charge.most or 0.0) * power:
        found.lines.append(f"{has}; {kept} (warning: it may not suffice)")
    else:
        found.lines.append(f"{has}; {takes}{unknown}")


def _held(link: Link, telemetry: Telemetry, charge: Charge | None) -> _Held | None:
    """Return what the batteries of a vehicle hold; None where it does not report them."""
    known = link.profile.autopilot.capacities
    values = parameters.read(link, [name for capacity, monitor, _ in known for name in (capacity, monitor)])
    found = {
        capacity: values[capacity]
        for number, (capacity, monitor, off) in enumerate(known)
        if values.get(capacity, 0.0) > LEAST_CAPACITY and values.get(monitor) not in off
        # the first one is there if anything is reported at all
        if monitor in values or number == 0
    }
    nominal, measured = None if charge is None else charge.voltage, telemetry.voltage()
    voltage = min((each for each in (nominal, measured) if each is not None), default=None)
    if not found or voltage is None:
        return None
    return _Held(tuple(found), sum(found.values()), voltage)


def _shown(joules: float) -> str:
    return f"{joules / WATT_HOUR:.0f} Wh"
