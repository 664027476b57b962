"""What simulated vehicles see in their photos, and tell."""

from __future__ import annotations

import pytest

from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.sights import Sight

pytestmark = pytest.mark.real_time("parts of flights")

LONG = "a float with a very long name"
HERE = (Sight("float", 0.0, 0.0, 1.0), Sight(LONG, 0.0, 0.0, 1.0), Sight("wreck", 0.0, 0.0, 20.0))


@pytest.fixture
def texts(ground):
    """Return what a vehicle that stands above things says in texts when it takes a photo."""
    port = ground.socket.getsockname()[1]
    with SimulatedVehicle(port, Settings(boot=0.1, ready=0.1, sights=HERE), speedup=10.0):
        assert ground.of("HEARTBEAT")
        assert ground.command(203, 0, 0, 0, 0, 1).result == 0
        said = []
        while (told := ground.of("STATUSTEXT", 1.0)) is not None and len(said) < 2:
            said += [told.text] if told.text.startswith("detected") else []
        return said


def test_what_a_photo_shows_is_told_with_its_place_if_there_is_room(texts):
    assert texts == ["detected float at 42.370000,13.350000", f"detected {LONG}"]
