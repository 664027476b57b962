"""Steps as behaviours of the helm, each active while its step's turn is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from mmrs_core.behaviour.travel import TRAVEL_MARGINS
from mmrs_core.generation.context import RobotContext
from mmrs_moos.steps import TOLERANCE, Step
from mmrs_moos.words import DEPLOY, DONE, STEP, text

WEIGHT = 100
SLIP = 4.0
"""A place that was passed counts as reached within so many capture radii."""


@dataclass(frozen=True, slots=True)
class Behaviour:
    """A behaviour of the helm: its type, and its parameters in order, names of which may repeat."""

    type: str
    parameters: tuple[tuple[str, str], ...]


def behaviours_of(step: Step, context: RobotContext) -> Iterator[Behaviour]:
    """Yield what a helm does in a step, all of it at once.

    A way ends at its place as seen from above; then the helm holds until the depth is right, too.
    """
    turn = [("condition", f"{DEPLOY} = true"), ("condition", f"{STEP} = {step.id}")]
    place = f"{text(step.place[0])},{text(step.place[1])}"
    radius = TRAVEL_MARGINS[context.robot.travel_mode].radius
    if step.speed is not None:
        settles = f"{step.id}_settles"
        yield Behaviour(
            "BHV_Waypoint",
            (
                ("name", step.id),
                ("pwt", text(WEIGHT)),
                *turn,
                ("endflag", f"{STEP} = {settles}"),
                ("points", place),
                ("speed", text(step.speed)),
                ("capture_radius", text(radius)),
                ("slip_radius", text(SLIP * radius)),
                ("repeat", "0"),
            ),
        )
        yield from _depth(step, step.id, turn, context)
        turn = [("condition", f"{DEPLOY} = true"), ("condition", f"{STEP} = {settles}")]
    name = step.id if step.speed is None else f"{step.id}_settles"
    if step.move.kind != "Start" and step.next:
        yield Behaviour(
            "BHV_StationKeep",
            (
                ("name", f"{name}_station"),
                ("pwt", text(WEIGHT)),
                *turn,
                ("station_pt", place),
                ("center_activate", "false"),
                ("inner_radius", text(radius)),
                ("outer_radius", text(2.0 * radius)),
                ("outer_speed", text(_slow(context))),
            ),
        )
    if step.next or step.ways:
        yield from _depth(step, name, turn, context)
    yield from _ends(step, name, turn, context)


def _ends(step: Step, name: str, turn: list[tuple[str, str]], context: RobotContext) -> Iterator[Behaviour]:
    """Yield what ends a step: a timer for each way on, which runs while its conditions are met."""
    met = [("condition", f"{variable} = {value}") for variable, value in step.waits]
    if step.speed is not None and context.dives:
        low, high = step.depth - TOLERANCE, step.depth + TOLERANCE
        met += [("condition", f"NAV_DEPTH <= {text(high)}")]
        met += [("condition", f"NAV_DEPTH >= {text(low)}")] if low > 0.0 else []
    posts = [("endflag", f"{variable} = {value}") for variable, value in step.posts]
    ways = step.ways or (("", "", step.next),)
    for number, (variable, value, to) in enumerate(ways):
        chosen = [("condition", f"{variable} = {value}")] if variable else []
        then = [("endflag", f"{STEP} = {to}")] if to else [("endflag", f"{DONE} = true")]
        yield Behaviour(
            "BHV_Timer",
            (
                ("name", f"{name}_ends_{number}"),
                *turn,
                *met,
                *chosen,
                ("duration", text(step.seconds)),
                ("duration_idle_decay", "false"),
                *posts,
                *then,
            ),
        )


def _depth(step: Step, name: str, turn: list[tuple[str, str]], context: RobotContext) -> Iterator[Behaviour]:
    if not context.dives:
        return
    yield Behaviour(
        "BHV_ConstantDepth",
        (
            ("name", f"{name}_depth"),
            ("pwt", text(WEIGHT)),
            *turn,
            ("depth", text(step.depth)),
            ("duration", "no-time-limit"),
        ),
    )


def _slow(context: RobotContext) -> float:
    type = context.type
    return type.capabilities[0].speed[1] / 2.0 if type is not None and type.capabilities else TOLERANCE
