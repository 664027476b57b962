"""Activities of robots, as status queries report them."""

from __future__ import annotations

from .policies import NOTHING

WAITS = "waits for its vehicle"
HELD_EARLY = "is held before it begins"
WORKS = "works"
HELD = "is held"
RESPONDS = "responds"
TAKEN = "under external control"
SUSPENDED = "waits for its battery"
LOST = "has ended by a lost link"
ENDED = "has ended"


def if_held(phase: str) -> str:
    """Return the phase of a robot that is held, or is to be, given what it would be at otherwise."""
    return {WAITS: HELD_EARLY, WORKS: HELD}.get(phase, phase)


def answering(response: str) -> dict[str, object]:
    """Return the status of a robot that carries out a response, as JSON has it."""
    return {"phase": TAKEN} if response == NOTHING else {"phase": RESPONDS, "response": response}
