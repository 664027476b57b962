"""The status of a simulated vehicle, and a summary of what it has done."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from math import dist, hypot

from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle


def status_line(pilot: Autopilot) -> str:
    """Return the present status of a vehicle."""
    north, east, up = pilot.body.position
    armed = "armed" if pilot.armed else "disarmed"
    item = f", item {pilot.item}" if pilot.mode_name == "auto" else ""
    faults = "".join(f", {word}" for word in _faults_of(pilot))
    return (
        f"{pilot.mode_name.upper()} {armed}, altitude {up:.1f} m, {hypot(north, east):.1f} m from home,"
        f" {pilot.body.pace:.1f} m/s, battery {pilot.energy:.0%}{item}{faults}"
    )


def _faults_of(pilot: Autopilot) -> Iterator[str]:
    if not pilot.located:
        yield "no position"
    if any(pilot.body.error):
        yield f"position error {hypot(*pilot.body.error):.0f} m"
    if pilot.obstacle is not None:
        yield "obstacle"
    if pilot.breached:
        yield "outside its fence"
    if not pilot.camera.works:
        yield "camera dead"
    if pilot.arming_fault:
        yield f"refuses to arm: {pilot.arming_fault}"


def summary_of(vehicle: SimulatedVehicle) -> Mapping[str, object]:
    """Return what a vehicle has done: metres, seconds, fractions."""
    pilot = vehicle.autopilot
    steps = [(a, b) for a, b in pairwise(pilot.track) if b[0] - a[0] < 1.0]
    names = {number: name.upper() for name, number in pilot.numbers.items()}
    return {
        "flown": round(sum(b[0] - a[0] for a, b in steps), 1),
        "metres": round(sum(dist(a[1:], b[1:]) for a, b in steps), 1),
        "highest": round(max((place[3] for place in pilot.track), default=0.0), 1),
        "items": len(pilot.visited),
        "photos": len(pilot.camera.photos),
        "battery": round(pilot.energy, 3),
        "armed": pilot.armed,
        "from_home": round(hypot(*pilot.body.place[:2]), 1),
        "sent": vehicle.radio.sent,
        "heard": vehicle.radio.received,
        "modes": [names.get(number, str(number)) for _, number in pilot.modes],
        "texts": [text for _, _, text in pilot.said],
    }


def summary_line(vehicle: SimulatedVehicle) -> str:
    """Return what a vehicle has done as a line of text."""
    done = summary_of(vehicle)
    armed = "still armed" if done["armed"] else "disarmed"
    return (
        f"{done['flown']:.1f} s in motion, {done['metres']:.1f} m, max altitude {done['highest']:.1f} m,"
        f" {done['items']} mission items, {done['photos']} photos,"
        f" {done['battery']:.0%} battery remaining, {armed} {done['from_home']:.1f} m from home"
    )
