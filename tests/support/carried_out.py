"""Runs of the engine with vehicles that a test has made."""

from dataclasses import replace

from mmrs_runtime.engine.clocks import SimulatedClock
from mmrs_runtime.engine.run import run
from mmrs_runtime.engine.terms import TO_THE_END
from mmrs_runtime.slots import LocalSlots


def carried_out(
    behaviour, vehicles, *, slots=None, clock=None, conditions=None, policies=None, terms=TO_THE_END
):
    """Return the records of a run, and how it ended."""
    records = []

    def observe(record):
        if terms.observe is not None:
            terms.observe(record)
        records.append(record)

    ending = run(
        behaviour.executable,
        vehicles,
        slots=slots or LocalSlots(behaviour.executable),
        clock=clock or SimulatedClock(),
        conditions=conditions or {},
        policies=policies,
        terms=replace(terms, observe=observe),
    )
    return records, ending
