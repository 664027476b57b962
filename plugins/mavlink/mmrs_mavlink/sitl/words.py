"""Simulated vehicles in words: how they are now, and what they did."""

from __future__ import annotations

from itertools import pairwise
from math import dist, hypot
from typing import TypedDict

from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle


class Deeds(TypedDict):
    """What a vehicle did: metres, seconds, parts of one."""

    flown: float
    metres: float
    highest: float
    items: int
    photos: int
    battery: float
    armed: bool
    from_home: float
    sent: int
    heard: int
    modes: list[str]
    texts: list[str]


def state_of(pilot: Autopilot) -> str:
    """Return how a vehicle is now, in words."""
    north, east, up = pilot.body.position
    armed = "armed" if pilot.armed else "disarmed"
    item = f", item {pilot.item}" if pilot.mode_name == "auto" else ""
    trouble = "".join(f", {word}" for word in troubles_of(pilot))
    return (
        f"{pilot.mode_name.upper()} {armed}, {up:.1f} m up, {hypot(north, east):.1f} m from home,"
        f" {pilot.body.pace:.1f} m/s, battery {pilot.energy:.0%}{item}{trouble}"
    )


def troubles_of(pilot: Autopilot) -> list[str]:
    """Return what is wrong with a vehicle, in words."""
    found = {
        "no position": not pilot.located,
        f"{hypot(*pilot.body.error):.0f} m from where it takes itself to be": any(pilot.body.error),
        "obstacle": pilot.obstacle is not None,
        "out of its fence": pilot.breached,
        "camera dead": not pilot.camera.works,
        f"will not arm: {pilot.unfit}": bool(pilot.unfit),
    }
    return [word for word, holds in found.items() if holds]


def deeds_of(vehicle: SimulatedVehicle) -> Deeds:
    """Return what a vehicle did until now."""
    pilot = vehicle.autopilot
    steps = [(a, b) for a, b in pairwise(pilot.track) if b[0] - a[0] < 1.0]
    names = {number: name.upper() for name, number in pilot.numbers.items()}
    return Deeds(
        flown=round(sum(b[0] - a[0] for a, b in steps), 1),
        metres=round(sum(dist(a[1:], b[1:]) for a, b in steps), 1),
        highest=round(max((place[3] for place in pilot.track), default=0.0), 1),
        items=len(pilot.visited),
        photos=len(pilot.camera.photos),
        battery=round(pilot.energy, 3),
        armed=pilot.armed,
        from_home=round(hypot(*pilot.body.place[:2]), 1),
        sent=vehicle.radio.sent,
        heard=vehicle.radio.heard,
        modes=[names.get(number, str(number)) for _, number in pilot.modes],
        texts=[text for _, _, text in pilot.said],
    )


def summary(deeds: Deeds) -> str:
    """Return what a vehicle did, in a line."""
    where = "still armed" if deeds["armed"] else "disarmed"
    return (
        f"{deeds['flown']:.1f} s under way, {deeds['metres']:.1f} m, {deeds['highest']:.1f} m up at most,"
        f" {deeds['items']} mission items, {deeds['photos']} photos,"
        f" {deeds['battery']:.0%} of the battery left, {where} {deeds['from_home']:.1f} m from home"
    )
