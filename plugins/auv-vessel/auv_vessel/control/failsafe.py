"""When a vehicle fails safe, and how soon: the times that it declares, and that tests measure at the bus.

Each time is from the moment at which the cause is there. Thrust zero means that every thruster's command
says zero and not enabled; the drive itself obeys within one more command period, and stops by its own
watchdog (`Sheet.watchdog`) where the actuator controller is gone.
"""

from __future__ import annotations

from auv_vessel.wire.catalogue import BEAT_PERIOD, COMMAND_PERIOD, SENSOR_PERIOD

COMMANDS_SILENT = 0.3
"""Seconds without a wrench, complete and valid, after which thrust is zero; the next one restores it."""

COMMANDS_GONE = 2.0
"""Seconds without a wrench after which the actuator controller gives up the dive: emergency, weight gone."""

MOVEMENT_GONE = 10.0 * BEAT_PERIOD
"""Seconds without a beat of movement, where there was one, after which it does, whatever wrenches come."""

STATE_SILENT = 0.5
"""Seconds without a valid depth of the sensor controller after which it does."""

STATE_UNTRUSTED = 1.0
"""Seconds of depths that are not to be trusted after which it does; movement asks for no thrust before."""

LEAK_SAID = 2
"""Messages in sequence that say that water is inside, before it is believed: 5 a second."""

HEALTH_SILENT = 5.0
"""Seconds without a word of leaks and battery, where there was one, after which the dive is given up."""

UNSERVED = 1.0
"""Seconds without a thruster that works and pushes up or down, where there was one, after which it is."""

DEEP_FOR = 0.5
"""Seconds of pressure beyond the rated depth, and a margin, after which the dive is given up."""

ACTUATORS_GONE = 3.0 * BEAT_PERIOD
"""Seconds without a beat of the actuator controller after which the sensor controller gives up the dive."""

STALE = 0.5
"""Seconds after the last plausible value of an instrument during which its state is still trusted."""

FROZEN = 0.6
"""Seconds after which an instrument of usual noise that repeats one value is taken to be frozen."""

MARGIN = COMMAND_PERIOD + SENSOR_PERIOD
"""Seconds that detection and the next command may take more than the times above."""

EMERGENCY_PERIOD, EMERGENCY_PERIOD_LATER = 0.1, 0.5
"""Seconds from one emergency message to the next: for `EMERGENCY_OFTEN` seconds, and after that."""

EMERGENCY_OFTEN = 2.0


def deepest(max_depth: float) -> float:
    """Return the depth, metres, from which on a vehicle rated for `max_depth` is too deep."""
    return 1.02 * max_depth + 0.5
