"""Runs in real time with the vehicles of a backend; `mmrs_runtime.engine.live` carries them out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.execution import Condition
from mmrs_core.contributions.vehicles import Live, VehicleFactory, VehicleInput
from mmrs_core.errors import LinkLostError, MmrsError
from mmrs_core.simulation.run import refuse_undecided
from mmrs_runtime.bus import Incomplete
from mmrs_runtime.engine import live as engine
from mmrs_runtime.engine.live import LiveRun
from mmrs_runtime.engine.preflight import NotReadyError
from mmrs_runtime.engine.terms import Ending
from mmrs_runtime.slots import Slots
from mmrs_runtime.vehicle import Vehicle


def live_run_for(
    program: Program,
    inputs: Mapping[str, VehicleInput],
    backend: VehicleFactory,
    bus: Slots,
    conditions: Mapping[str, Condition],
) -> LiveRun:
    """Return a run of the robots that have an input, with the vehicles of a backend."""

    def connect(id: str, live: Live) -> Vehicle:
        return backend.connect(replace(inputs[id], live=live))

    return LiveRun(
        program=program.executable,
        connect={id: partial(connect, id) for id in inputs},
        bus=bus,
        conditions=conditions,
        policies={id: given.policies for id, given in inputs.items()},
        ready=lambda vehicles: refuse_undecided(program, vehicles, conditions),
    )


def run_live(live_run: LiveRun) -> Ending:
    """Carry the programs out; see `mmrs_runtime.engine.live.run_live`.

    Raises:
        LinkLostError: if a robot does not answer at first, or robots of other processes have not come.
        UnsupportedError: if a robot cannot do what its program holds, or options are wrong.
        MmrsError: if a robot does not get ready, and none has started without it.
        ValueError: if the steps to resume from are not the program's.
        KeyboardInterrupt: if robots are ordered to stop before they are ready.
    """
    try:
        return engine.run_live(live_run)
    except NotReadyError as error:
        raise (LinkLostError if error.link_lost else MmrsError)(str(error)) from None
    except Incomplete as error:
        raise LinkLostError(str(error)) from error
