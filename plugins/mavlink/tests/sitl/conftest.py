"""A ground station for simulated vehicles."""

import pytest
from simulated.ground import Ground


@pytest.fixture
def ground():
    """Return a ground station that can switch a vehicle on."""
    station = Ground()
    yield station
    station.close()
