"""Projects with simulated vehicles, and `mmrs run` for them."""

import pytest
from fault_table.fleet import Fleet

SPEEDUP = 30.0


@pytest.fixture
def fleet(tmp_path):
    """Return a function that gives vehicles for pads, switched on."""
    open_fleets = []

    def make(*pads, speedup: float = SPEEDUP, **settings):
        made = Fleet(tmp_path, pads, "interpreted", speedup=speedup, settings=settings)
        made.__enter__()
        open_fleets.append(made)
        return made

    yield make
    for each in open_fleets:
        each.__exit__()
