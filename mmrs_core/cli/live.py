"""``mmrs run``: carries a behaviour out with real robots, in real time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.behaviours import load_behaviour
from mmrs_core.cli.buses import BusOptions
from mmrs_core.cli.completion import backend_names, one_of, robot_names
from mmrs_core.cli.flying import carry_out
from mmrs_core.cli.output import say_json
from mmrs_core.cli.parameters import (
    Assume,
    BackendOptions,
    Behaviour,
    Context,
    Robots,
    behaviour_file,
    robot_files,
)
from mmrs_core.cli.run_options import ON_STOP, RunOptions, default_backend
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.simulation import answers, backends_of, options_of

_Texts = list[str] | None


def run(
    call: typer.Context,
    behaviour: Behaviour,
    log: Annotated[
        Path,
        typer.Option(
            "--log",
            metavar="DIR",
            help="Folder for step logs and black boxes (recorded telemetry and decisions).",
        ),
    ] = Path("logs"),
    backend: Annotated[
        _Texts,
        typer.Option(
            "--backend",
            metavar="[ROBOT=]NAME",
            help="Interface to the vehicles, for all robots or one, by a name that 'mmrs plugin list' gives "
            "under vehicles. Default: the one that an installed plug-in declares. Repeatable.",
            autocompletion=backend_names,
        ),
    ] = None,
    connect: Annotated[
        _Texts,
        typer.Option(
            "--connect",
            metavar="[ROBOT=]URL[@SYSTEM]",
            help="Connection URL of a robot, such as udpin:127.0.0.1:14550, or /dev/ttyUSB0,57600@3 for the "
            "vehicle with system id 3 on a shared link. Repeatable.",
        ),
    ] = None,
    only: Annotated[
        _Texts,
        typer.Option(
            "--robot", metavar="ROBOT", help="Run only this robot. Repeatable.", autocompletion=robot_names
        ),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Resume the run logged in --log.")] = False,
    name: Annotated[
        str, typer.Option("--run", metavar="NAME", help="Run name; the same in all processes of a run.")
    ] = "run-0",
    speedup: Annotated[
        float,
        typer.Option(
            "--speedup",
            metavar="FACTOR",
            min=0.01,
            max=1000.0,
            help="Simulated seconds per real second, as given to the simulated vehicles.",
        ),
    ] = 1.0,
    on_stop: Annotated[
        str,
        typer.Option(
            "--on-stop",
            metavar="hold|return|land",
            help="Response of robots to an interrupt and to 'mmrs control stop'.",
            autocompletion=one_of(*ON_STOP),
        ),
    ] = "hold",
    battery_patience: Annotated[
        float,
        typer.Option(
            "--battery-patience",
            min=0.0,
            metavar="SECONDS",
            help="How long to wait for 'mmrs control resume' after a battery change once no other robot is "
            "active; 0 ends the run.",
        ),
    ] = 0.0,
    bus: Annotated[
        bool,
        typer.Option(
            "--bus",
            help="Synchronise slots (flags that robots wait for) with other processes over Zenoh; on this "
            "machine only, unless --bus-listen or --bus-connect is given.",
        ),
    ] = False,
    bus_listen: Annotated[
        _Texts,
        typer.Option(
            "--bus-listen",
            metavar="ENDPOINT",
            help="Zenoh endpoint to listen on, e.g. tcp/0.0.0.0:7447. Repeatable.",
        ),
    ] = None,
    bus_connect: Annotated[
        _Texts,
        typer.Option(
            "--bus-connect",
            metavar="ENDPOINT",
            help="Zenoh endpoint to connect to, e.g. tcp/10.0.0.2:7447. Repeatable.",
        ),
    ] = None,
    bus_config: Annotated[
        Path | None,
        typer.Option("--bus-config", metavar="FILE", help="Zenoh configuration from 'mmrs bus keys'."),
    ] = None,
    sync: Annotated[
        bool,
        typer.Option(
            "--sync",
            help="Wait until the robots of all processes on the bus are ready, then start all at one "
            "instant.",
        ),
    ] = False,
    sync_patience: Annotated[
        float,
        typer.Option(
            "--sync-patience",
            min=0.1,
            metavar="SECONDS",
            help="Start timeout for --sync. No robot starts after it.",
        ),
    ] = 300.0,
    signing_key: Annotated[
        Path | None,
        typer.Option(
            "--signing-key",
            metavar="FILE",
            help="File of 32 bytes that only you may read: signs messages to vehicles, and refuses others.",
        ),
    ] = None,
    inject: Annotated[
        _Texts,
        typer.Option(
            "--inject",
            metavar="FAULTS",
            help="Faults to inject, for all robots or one: loss, duplicate, corrupt or delay, e.g. "
            "loss=0.15; cut, cut-in, cut-out, ground-cut, freeze, disk-full, clock-jump or gps-lost, e.g. "
            "Drone1:cut@60+20 from 60 s after the start for 20 s; with --bus, also bus-loss, bus-duplicate, "
            "bus-delay and bus-cut. Repeatable.",
        ),
    ] = None,
    assume: Assume = None,
    context: Context = None,
    robots: Robots = None,
    backend_option: BackendOptions = None,
    json: Json = False,
) -> int:
    """Run a behaviour on real or simulated vehicles.

    All robots start once every one of them is ready. Interrupt (Ctrl-C) once to stop every robot, from any
    state: the command ends when each has confirmed that it has stopped. Use 'mmrs control' for other
    commands.

    Example: mmrs run mission/behaviour.xmi --connect Drone1=udpin:127.0.0.1:14550 --log flight-1
    """
    session = Session(settings_of(call))
    usual, own = backends_of(backend, "")
    usual = usual or default_backend(session.contributions.vehicles)
    given = dict(options_of(backend_option))
    if signing_key is not None:
        given["signing-key"] = str(signing_key)
    if inject:
        given["inject"] = ",".join(inject)
    wanted = RunOptions(
        folder=log,
        backend=usual,
        own_backends=own,
        options=given,
        links=tuple(connect or ()),
        robots=tuple(only or ()),
        resume=resume,
        run=name,
        speedup=speedup,
        on_stop=on_stop,
        patience=battery_patience,
        assume=answers(assume),
        bus=BusOptions(
            bus,
            tuple(bus_listen or ()),
            tuple(bus_connect or ()),
            bus_config,
            sync_patience if sync else None,
        ),
    )
    loaded = load_behaviour(session, behaviour_file(behaviour), context=context, robots=robot_files(robots))
    result = carry_out(session, loaded, wanted)
    if json:
        say_json(result.as_json())
    else:
        result.say()
    return result.exit_code
