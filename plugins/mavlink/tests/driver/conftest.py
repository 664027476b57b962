"""Robots of the flight runtime in the air, each with a simulated vehicle."""

from contextlib import ExitStack

import pytest
from flight_crew import manned, robot_of


@pytest.fixture
def in_the_air():
    """Return a function that gives a robot with policies ten metres above its home, or north of that."""
    with ExitStack() as stack:

        def fly(*policies, out: bool = False, cruise: float | None = None, **options):
            robot = robot_of(*policies, cruise=cruise)
            made = stack.enter_context(manned(robot, **options))
            made.fly_out() if out else made.fly_up()
            return made

        yield fly
