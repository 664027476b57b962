"""Runs whose robots are moved by backends of more than one sort."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from mmrs_core.contributions.vehicles import VehicleFactory, VehicleInput
from mmrs_core.errors import UsageError
from mmrs_runtime.vehicle import Vehicle


def mixed(
    usual: VehicleFactory, own: Mapping[str, VehicleFactory], robots: Collection[str]
) -> VehicleFactory:
    """Return what makes the usual backend for all robots but those that have their own.

    Raises:
        UsageError: if one of them is no robot of the program, or simulated time would meet real time.
    """
    if strange := sorted(set(own) - set(robots)):
        raise UsageError(f"backend of '{strange[0]}': no such robot; there are {', '.join(robots)}")
    used = {each.name: each for each in ([] if set(own) == set(robots) else [usual])}
    used |= {each.name: each for each in own.values()}
    if len({each.simulated for each in used.values()}) > 1:
        words = (f"'{each.name}' {'simulated' if each.simulated else 'real'}" for each in used.values())
        raise UsageError(f"backends of one run go by one time: {', '.join(words)}")

    def connect(given: VehicleInput) -> Vehicle:
        factory = own.get(given.robot.id, usual)
        live = given.live
        if live is not None:
            links = {robot: link for robot, link in live.links.items() if own.get(robot, usual) is factory}
            live = replace(live, links=links)
        return factory.connect(replace(given, live=live))

    simulated = all(each.simulated for each in used.values())
    return VehicleFactory(" and ".join(used), "as each robot has it", connect, simulated)


def options_for(robot: str, options: Mapping[str, str]) -> dict[str, str]:
    """Return the options of one robot's backend: those that name it as in ``ROBOT:KEY`` go before others.

    >>> options_for("a", {"seed": "1", "a:seed": "2", "b:noise": "no"})
    {'seed': '2'}
    """
    own = {
        key.removeprefix(f"{robot}:"): text for key, text in options.items() if key.startswith(f"{robot}:")
    }
    return {**{key: text for key, text in options.items() if ":" not in key}, **own}


def refuse_strange(options: Mapping[str, str], robots: Collection[str]) -> None:
    """Do nothing if options name no other robots than these.

    Raises:
        UsageError: if one does.
    """
    for key in options:
        robot, colon, _ = key.rpartition(":")
        if colon and robot not in robots:
            raise UsageError(f"option '{key}': no robot '{robot}'; there are {', '.join(robots)}")
