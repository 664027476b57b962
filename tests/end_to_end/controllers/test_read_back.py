"""What a vehicle has kept of an upload, and which differences are none."""

from dataclasses import replace

import pytest
from ports import free_port

from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import open_port
from mmrs_mavlink.services import missions
from mmrs_mavlink.services.items import Item
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import RefusedError

pytestmark = pytest.mark.real_time("controllers")

WAYPOINT, SPEED, VERTEX, RALLY_POINT = 16, 178, 5002, 5100
SEA, RELATIVE, SEA_INT, RELATIVE_INT, TERRAIN, TERRAIN_INT, NO_FRAME = 0, 3, 5, 6, 10, 11, 2
MISSION, FENCE, RALLY = 0, 1, 2


@pytest.fixture
def linked():
    """Return a link, and the simulated vehicle at its end."""
    port = free_port()
    link = Link(open_port(f"udpin:127.0.0.1:{port}"), Clock(20.0))
    with SimulatedVehicle(port, Settings(boot=0.0, ready=0.0), speedup=20.0) as vehicle:
        assert link.wait(lambda: link.component, 600.0)
        yield link, vehicle
    link.close()


@pytest.fixture
def read_back(linked):
    """Return a function that uploads an item after a home, changes what was kept, and verifies it."""
    link, vehicle = linked

    def verify(kind: int, given, **kept) -> None:
        home = Item(WAYPOINT, x=423_700_000, y=133_500_000)
        items = [home, given] if kind == MISSION else [given]
        missions.upload(link, items, kind)
        store = vehicle.autopilot.stores[kind]
        store[-1] = replace(store[-1], **kept)
        missions.verify(link, items, kind)

    return verify


@pytest.fixture
def item():
    """Return a function that makes an item 20.5 m above home."""
    return lambda command, frame=RELATIVE: Item(command, x=423_701_000, y=133_500_000, z=20.5, frame=frame)


@pytest.mark.parametrize("frame", [RELATIVE, RELATIVE_INT])
def test_the_same_frame_by_another_number_is_no_difference(read_back, item, frame):
    read_back(MISSION, item(WAYPOINT), frame=frame)
    read_back(RALLY, item(RALLY_POINT), frame=frame)


@pytest.mark.parametrize("frame", [SEA, SEA_INT, TERRAIN, TERRAIN_INT, 1])
@pytest.mark.parametrize(("kind", "command"), [(MISSION, WAYPOINT), (RALLY, RALLY_POINT)])
def test_a_height_above_something_else_is_refused(read_back, item, frame, kind, command):
    with pytest.raises(RefusedError, match="instead of"):
        read_back(kind, item(command), frame=frame)


@pytest.mark.parametrize("frame", [SEA, RELATIVE, NO_FRAME])
def test_the_frame_of_an_item_without_a_place_means_nothing(read_back, frame):
    paced = Item(SPEED, (1.0, 5.0, -1.0, 0.0), frame=NO_FRAME)
    read_back(MISSION, paced, frame=frame)


def test_a_fence_is_given_back_without_heights(read_back, item):
    read_back(FENCE, item(VERTEX), frame=SEA, z=0.0)


def test_a_corner_of_a_fence_somewhere_else_is_refused(read_back, item):
    with pytest.raises(RefusedError, match="fence: item 0"):
        read_back(FENCE, item(VERTEX), frame=SEA, z=0.0, x=423_701_100)


def test_a_rally_point_keeps_whole_metres(read_back, item):
    read_back(RALLY, item(RALLY_POINT), z=20.0)
    with pytest.raises(RefusedError):
        read_back(RALLY, item(RALLY_POINT), z=18.0)


def test_a_waypoint_keeps_centimetres(read_back, item):
    read_back(MISSION, item(WAYPOINT), z=20.49)
    with pytest.raises(RefusedError):
        read_back(MISSION, item(WAYPOINT), z=20.0)
