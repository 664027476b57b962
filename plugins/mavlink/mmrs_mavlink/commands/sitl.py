"""``mmrs sitl``: simulated MAVLink vehicles."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.completion import one_of
from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.parameters import Duration
from mmrs_core.cli.settings import Json, settings_of

_Texts = list[str] | None
FIRST_PORT, PORT_STEP = 14_550, 10

app = typer.Typer(rich_markup_mode=None, add_completion=False)


@app.command()
def sitl(
    call: typer.Context,
    behaviour: Annotated[
        Path,
        typer.Argument(
            metavar="PROJECT|BEHAVIOUR",
            help="Project folder, mission or behaviour file; one vehicle starts at the home of each robot.",
        ),
    ],
    firmware: Annotated[
        str | None,
        typer.Option(
            "--firmware",
            metavar="ardupilot|px4",
            help="Autopilot to imitate; px4 supports copters only. Default: by robot type.",
            autocompletion=one_of("ardupilot", "px4"),
        ),
    ] = None,
    port: Annotated[
        int, typer.Option("--port", metavar="PORT", min=1, max=65_535, help="UDP port of the first vehicle.")
    ] = FIRST_PORT,
    step: Annotated[
        int,
        typer.Option(
            "--port-step", metavar="N", min=0, help="Port increment per vehicle; 0 shares one port."
        ),
    ] = PORT_STEP,
    host: Annotated[
        str, typer.Option("--host", metavar="HOST", help="Host of the controllers.")
    ] = "127.0.0.1",
    ground: Annotated[
        str,
        typer.Option(
            "--ground",
            metavar="[HOST:]PORT",
            help="UDP address of a ground station. Its messages are forwarded to the controllers.",
        ),
    ] = "",
    speedup: Annotated[
        float,
        typer.Option(
            "--speedup", metavar="FACTOR", min=0.1, max=100.0, help="Simulated seconds per real second."
        ),
    ] = 1.0,
    recharge: Annotated[
        float | None,
        typer.Option(
            "--recharge",
            metavar="SECONDS",
            min=0.0,
            help="Recharge time on the ground, in seconds; 0 disables recharging. Default: by robot type.",
        ),
    ] = None,
    parameters: Annotated[
        _Texts,
        typer.Option(
            "--parameter", metavar="NAME=VALUE", help="Autopilot parameter set on all vehicles. Repeatable."
        ),
    ] = None,
    fault: Annotated[
        _Texts,
        typer.Option(
            "--fault",
            metavar="[ROBOT:]FAULT[=VALUE,…][@SECONDS[+SECONDS]]",
            help="Fault to inject into ROBOT (default: all robots), @SECONDS after arming (default: at "
            "launch), for +SECONDS (default: until cleared): gps-lost, position-shift, restart, stick, "
            "obstacle, breach, battery, silent, link-down, ground-down, motor-failed or wind. Repeatable.",
        ),
    ] = None,
    surroundings: Annotated[
        Path | None,
        typer.Option("--surroundings", metavar="FILE", help="Objects that photos can show, as JSON."),
    ] = None,
    seconds: Duration = 0.0,
    json: Json = False,
) -> int:
    """Start simulated MAVLink vehicles.

    Prints the --connect arguments for 'mmrs run' and generated controllers. Type 'Drone1 gps-lost' or
    'all battery 0.2' to inject a fault, 'Drone1 clear gps-lost' to clear it, 'quit' to stop. The autopilots
    are imitations: a real autopilot may still reject what works here.

    Example: mmrs sitl examples/carbon-dioxide --speedup 5 --fault 'Alba:gps-lost@60+20'
    """
    from mmrs_core.simulation.surroundings import sights_in
    from mmrs_mavlink.commands.fleet import connected, equipped, members_of, parameter, station
    from mmrs_mavlink.commands.rehearsal import checked, print_summaries, rehearse, summary_of

    options = {
        "firmware": firmware,
        "recharge": recharge,
        "ground": station(ground) if ground else None,
        "parameters": dict(map(parameter, parameters or ())),
    }
    sights = sights_in(surroundings) if surroundings is not None else ()
    members = equipped(members_of(settings_of(call), behaviour, sights), options)
    faults = [checked(text, members) for text in fault or []]
    vehicles, arguments = connected(members, port, step, host, speedup)
    code = rehearse(vehicles, faults, seconds, lambda: None if json else say(shlex.join(arguments)))
    summaries = {robot: summary_of(vehicle) for robot, vehicle in vehicles.items()}
    if json:
        say_json({"vehicles": summaries, "connect": arguments})
    else:
        print_summaries(summaries)
    return code
