"""``mmrs sitl``: simulated vehicles to rehearse on."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from mmrs_runtime.sights import Sight

_Texts = list[str] | None
FIRST_PORT, PORT_STEP = 14_550, 10

app = typer.Typer(rich_markup_mode=None, add_completion=False)


@app.command()
def sitl(
    call: typer.Context,
    behaviour: Annotated[
        Path | None,
        typer.Argument(
            metavar="BEHAVIOUR|PROJECT",
            help="Whose robots get a vehicle each, at their homes; none: --count vehicles at --home.",
        ),
    ] = None,
    count: Annotated[int, typer.Option("--count", min=1, max=250, help="Vehicles without a model.")] = 1,
    home: Annotated[
        str, typer.Option("--home", metavar="LATITUDE,LONGITUDE", help="Of the first of them.")
    ] = "42.37,13.35",
    kind: Annotated[str, typer.Option("--kind", metavar="copter|sub|rover", help="Of them.")] = "copter",
    firmware: Annotated[
        str,
        typer.Option("--firmware", metavar="ardupilot|px4", help="px4: from documents, copters only."),
    ] = "ardupilot",
    port: Annotated[
        int, typer.Option("--port", min=1, max=65_535, help="UDP port of the first robot.")
    ] = FIRST_PORT,
    step: Annotated[
        int, typer.Option("--port-step", min=0, help="To the port of the next; 0: all share one.")
    ] = PORT_STEP,
    host: Annotated[str, typer.Option("--host", help="Where the controllers listen.")] = "127.0.0.1",
    ground: Annotated[
        str,
        typer.Option(
            "--ground",
            metavar="[HOST:]PORT",
            help="Where a ground station listens, too; controllers hear it as an autopilot hands it on.",
        ),
    ] = "",
    speedup: Annotated[
        float, typer.Option("--speedup", min=0.1, max=100.0, help="Seconds of theirs in a second.")
    ] = 1.0,
    wind: Annotated[
        str, typer.Option("--wind", metavar="SPEED,FROM", help="Metres a second, degrees it comes from.")
    ] = "0,0",
    gusts: Annotated[
        str,
        typer.Option(
            "--gusts",
            metavar="SPEED[,SECONDS]",
            help="Unrest of the air about the wind: standard deviation, and how long gusts last (5 s).",
        ),
    ] = "0",
    energy: Annotated[
        float | None,
        typer.Option(
            "--energy", min=1.0, help="Seconds of hovering in a full battery; else as the robot's type says."
        ),
    ] = None,
    recharge: Annotated[
        float | None,
        typer.Option(
            "--recharge",
            min=0.0,
            help="Seconds on the ground until it is full; 0: never. Else as the robot's type says.",
        ),
    ] = None,
    parameter: Annotated[
        _Texts, typer.Option("--parameter", metavar="NAME=VALUE", help="Of all vehicles; may be repeated.")
    ] = None,
    loss: Annotated[
        float, typer.Option("--loss", min=0.0, max=0.9, help="Part of all datagrams that get lost.")
    ] = 0.0,
    delay: Annotated[
        float, typer.Option("--delay", min=0.0, max=10.0, help="Real seconds that each takes.")
    ] = 0.0,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Of losses and gusts.")] = 0,
    fault: Annotated[
        _Texts,
        typer.Option(
            "--fault",
            metavar="[ROBOT:]FAULT[=VALUE,…][@SECONDS[+SECONDS]]",
            help="After so many seconds under way, for so long; may be repeated. --fault list: all of them.",
        ),
    ] = None,
    surroundings: Annotated[
        Path | None,
        typer.Option(
            "--surroundings", metavar="FILE", help="What there is to be detected in photos; of a mission's."
        ),
    ] = None,
    seconds: Annotated[
        float, typer.Option("--for", min=0.0, metavar="SECONDS", help="End by itself; 0: when interrupted.")
    ] = 0.0,
    json: Json = False,
) -> int:
    """Start simulated MAVLink vehicles.

    They are for rehearsing controllers and mmrs run. It prints the --connect arguments to copy. On a terminal
    it tells now and then how each vehicle is. A line such as 'Drone1 gps-lost', 'Drone1 mend gps-lost' or
    'all battery 0.2' makes a fault at once, 'quit' ends. They are ours: what flies here may still be refused
    by a real autopilot.

    Example: mmrs sitl examples/carbon-dioxide --speedup 5 --fault 'Alba:gps-lost@60+20'
    """
    from mmrs_mavlink.commands.berths import Berths, berths_of, plain_berths
    from mmrs_mavlink.commands.rehearsal import Rehearsal, fault_list

    if fault == ["list"]:
        fault_list()
        return 0
    berths = Berths(
        port=port,
        step=step,
        host=host,
        ground=ground,
        speedup=speedup,
        loss=loss,
        delay=delay,
        seed=seed,
        firmware=firmware,
        wind=wind,
        gusts=gusts,
        energy=energy,
        recharge=recharge,
        parameters=tuple(parameter or ()),
        sights=_sights(surroundings),
    )
    if behaviour is not None:
        _refuse_beside(call, behaviour, ("count", "home", "kind"))
    settings = settings_of(call)
    given = berths_of(settings, behaviour) if behaviour is not None else plain_berths(count, home, kind)
    rehearsal = Rehearsal(berths.vehicles(given), fault or [])
    if not json:
        say(" ".join(map(quote, berths.arguments(given))))
    code = rehearsal.run(seconds, quiet=json)
    if json:
        say_json({"vehicles": rehearsal.deeds(), "connect": berths.arguments(given)})
    return code


def _sights(path: Path | None) -> tuple[Sight, ...]:
    from mmrs_core.errors import UnreadableError
    from mmrs_runtime.sights import sights_in

    try:
        return sights_in(path) if path is not None else ()
    except OSError as error:
        raise UnreadableError(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise UnreadableError(str(error)) from error


def _refuse_beside(call: typer.Context, behaviour: Path, names: tuple[str, ...]) -> None:
    """Refuse options of vehicles without a model.

    Raises:
        typer.BadParameter: if there are any.
    """
    for name in names:
        source = call.get_parameter_source(name)
        if source is not None and source.name != "DEFAULT":
            raise typer.BadParameter(f"--{name}: '{behaviour}' says it of its robots")
