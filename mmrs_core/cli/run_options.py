"""Options of ``mmrs run``, and their checks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import typer

from mmrs_core.behaviour.program import Program
from mmrs_core.cli.buses import BusOptions
from mmrs_core.contributions.vehicles import VehicleFactory
from mmrs_core.errors import UsageError
from mmrs_core.simulation.run import options_for

ON_STOP = {"hold": "HOLD", "return": "RETURN", "land": "LAND"}


@dataclass(frozen=True, slots=True)
class RunOptions:
    """Options of ``mmrs run``.

    Attributes:
        folder: of the logs.
        backend: of robots without one in `own_backends`.
        options: of the backends; ``ROBOT:KEY`` is for that of one robot.
        links: as in ``--connect``.
        robots: those that this process runs; empty: all.
        patience: seconds to wait for the command to resume once no other robot is active.
        assume: fixed answers, by condition.
    """

    folder: Path
    backend: str
    own_backends: Mapping[str, str] = field(default_factory=dict)
    options: Mapping[str, str] = field(default_factory=dict)
    links: tuple[str, ...] = ()
    robots: tuple[str, ...] = ()
    resume: bool = False
    run: str = "run-0"
    speedup: float = 1.0
    on_stop: str = "hold"
    patience: float = 0.0
    assume: Mapping[str, bool] = field(default_factory=dict)
    bus: BusOptions = field(default_factory=BusOptions)


def robots_of(program: Program, wanted: tuple[str, ...]) -> tuple[str, ...]:
    """Return the robots that this process runs, in the program's order; `wanted` empty: all.

    Raises:
        typer.BadParameter: if there is no such robot.
    """
    known = tuple(robot.id for robot in program.robots)
    for robot in wanted:
        if robot not in known:
            raise typer.BadParameter(f"--robot {robot}: unknown robot; the behaviour has {', '.join(known)}")
    return tuple(robot for robot in known if not wanted or robot in wanted)


def stop_response(word: str) -> str:
    """Return the response that robots give when interrupted.

    Raises:
        typer.BadParameter: if there is none of that name.
    """
    if word not in ON_STOP:
        raise typer.BadParameter(f"--on-stop {word}: expected one of {', '.join(ON_STOP)}")
    return ON_STOP[word]


def check_backends(
    wanted: RunOptions,
    links: Mapping[str, str],
    robots: tuple[str, ...],
    backends: Mapping[str, VehicleFactory],
) -> None:
    """Refuse options and links that the backends of these robots make nothing of.

    Raises:
        typer.BadParameter: if there are any.
        OSError: if a file that an option names cannot be read.
    """
    urls = {robot: links.get(robot, "") for robot in robots}
    for name, backend in backends.items():
        own = {robot: options_for(robot, wanted.options) for robot in _by(name, wanted, robots)}
        for fault in backend.check(own, urls) if own else ():
            raise typer.BadParameter(fault)


def default_backend(backends: Mapping[str, VehicleFactory]) -> str:
    """Return the backend that a plug-in declares as the default one.

    Raises:
        UsageError: there is none, or there are several.
    """
    found = sorted(name for name, each in backends.items() if each.default)
    if len(found) != 1:
        why = f"the defaults are {' and '.join(found)}" if found else "no installed plug-in has a default"
        raise UsageError(f"--backend: {why}; choose one of {', '.join(sorted(backends))}")
    return found[0]


def options_of_robots(
    wanted: RunOptions, robots: tuple[str, ...], backends: Mapping[str, VehicleFactory]
) -> dict[str, str]:
    """Return the options of backends; where these differ, the signing key is for those that sign."""
    options = dict(wanted.options)
    if wanted.own_backends and (key := options.pop("signing-key", None)) is not None:
        signing = (
            robot for name, each in backends.items() if each.signs for robot in _by(name, wanted, robots)
        )
        options |= {f"{robot}:signing-key": key for robot in signing}
    return options


def _by(backend: str, wanted: RunOptions, robots: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(each for each in robots if wanted.own_backends.get(each, wanted.backend) == backend)


def links_of(given: tuple[str, ...], robots: tuple[str, ...], known: tuple[str, ...]) -> dict[str, str]:
    """Return the links of these robots as far as they were given; so may be those of all others known.

    Raises:
        typer.BadParameter: if it is not clear whose one of them is, or one robot has two.
    """
    links: dict[str, str] = {}
    for text in given:
        named = max((each for each in known if text.startswith(f"{each}=")), key=len, default="")
        robot, separator, url = (named, "=", text[len(named) + 1 :]) if named else text.partition("=")
        if not separator and len(robots) > 1:
            raise typer.BadParameter(
                f"--connect {text}: several robots; name one: --connect {robots[0]}={text}"
            )
        if separator and robot not in known:
            raise typer.BadParameter(
                f"--connect {text}: unknown robot '{robot}'; the robots are {', '.join(known)}"
            )
        name, reached = (robot, url) if separator else (robots[0], text)
        if name in links:
            raise typer.BadParameter(f"--connect {text}: '{name}' already has the connection {links[name]}")
        links[name] = reached
    return {robot: links[robot] for robot in robots if robot in links}
