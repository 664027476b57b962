"""One robot at work in this process, alone or beside others."""

from __future__ import annotations

import threading
from dataclasses import replace

import pytest
from flight_crew import SPEEDUP, SteadyClock
from ports import free_port

from mmrs_core.sitl import Settings, SimulatedVehicle
from mmrs_mavlink.crews import Crews
from mmrs_mavlink.judgement import Judgement
from mmrs_mavlink.links.radios import Radios
from mmrs_mavlink.options import options_of, parser_for
from mmrs_mavlink.session import Shared
from mmrs_mavlink.slots import LocalSlots
from mmrs_runtime.injection import Rehearsal


@pytest.fixture
def process(tmp_path):
    """Return a function that gives what robots share, alpha's vehicle being at that port, or made up."""

    def share(*robots, port: int = 0, words=()):
        vehicle = ["--connect", f"alpha=udpin:127.0.0.1:{port}@1", "--speedup", str(SPEEDUP)]
        arguments = [*(vehicle if port else ["--dry-run"]), "--log", str(tmp_path), *words]
        options = options_of(parser_for(robots), robots, arguments)
        if port:
            options = replace(options, clock=SteadyClock(SPEEDUP, options.clock.now()))
        judgement = Judgement({}, {})
        return Shared(
            options=options,
            slots=LocalSlots(robots),
            judgement=judgement,
            decides=judgement.decides(robots),
            rehearsal=Rehearsal(options.inject, options.clock, print),
            radios=Radios(options.clock, retries=options.reach.retries),
            crews=Crews([robot.id for robot in robots]),
            stop=threading.Event(),
            abandon=threading.Event(),
        )

    return share


@pytest.fixture
def vehicle():
    """Return a simulated vehicle at alpha's home, and its port."""
    port = free_port()
    with SimulatedVehicle(port, Settings(), speedup=SPEEDUP) as simulated:
        yield simulated, port
