"""The backend ardusub-manual drives the simulated ArduSub, over UDP and faster than the clock."""

from math import hypot

import pytest
from dives_by_hand import sub
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.scene import Area, AreaUse
from mmrs_mavlink.plugin.manual.autopilot import TOLD
from mmrs_mavlink.services.commands import command

pytestmark = pytest.mark.real_time("vessels")


def test_a_program_is_driven_to_its_end_without_any_position():
    with sub() as driven:
        assert driven.vehicle.autopilot.mode_name == "depth_hold"
        for id, place in (("out", (6.0, 0.0, -2.0)), ("stay", (6.0, 0.0, -2.0))):
            driven.begin(id)
            driven.finish()
            assert hypot(driven.truth[0] - place[0], driven.truth[1] - place[1]) <= 1.5
            assert driven.truth[2] == pytest.approx(place[2], abs=0.4)
        driven.begin("look")
        driven.finish()
        assert abs((driven.vehicle.autopilot.body.heading + 180.0) % 360.0 - 180.0) <= 15.0
        driven.begin("up")
        driven.finish()
        assert driven.truth[2] >= -0.4
    assert not driven.vehicle.autopilot.armed


def test_where_the_robot_is_is_reckoned():
    with sub() as driven:
        driven.begin("out")
        driven.finish()
        east, north, up = driven.backend.state(driven.clock.now()).position
        assert (east, north) == pytest.approx((6.0, 0.0), abs=0.5)
        assert up == pytest.approx(-2.0, abs=0.4)


def test_it_holds_its_depth_where_nobody_knows_its_heading_any_more():
    with sub() as driven:
        driven.go_down()
        command(driven.backend._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, float(TOLD[0]), -1.0)
        until(lambda: driven.fault)
        driven.stop("HOLD")
        assert driven.backend.watched(driven.clock.now())
        driven.pass_by(5.0)
        assert driven.vehicle.autopilot.armed
        assert driven.truth[2] < -1.0
        driven.stop("RETURN")
        assert "not known: it comes up" in driven.undone
        assert driven.truth[2] >= -0.4


WALL = Area("wall", AreaUse.FORBIDDEN, ((2.0, -0.4), (3.0, -0.4), (3.0, 0.4), (2.0, 0.4)))


@pytest.mark.parametrize("response", ["RETURN", "EMERGENCY_AREA"])
def test_it_goes_round_what_is_forbidden_and_comes_up_there(response):
    refuge = Area("bay", AreaUse.EMERGENCY, ((-9.0, -4.0), (-1.0, -4.0), (-1.0, 4.0), (-9.0, 4.0)))
    with sub(areas=(WALL, refuge)) as driven:
        driven.begin("out")
        driven.finish()
        gone = len(driven.vehicle.autopilot.track)
        driven.stop(response)
        track = driven.vehicle.autopilot.track[gone:]
        within = [(east, north) for _, north, east, _ in track if 2.0 <= east <= 3.0]
        assert min(abs(north) for _, north in within) > 0.4
        assert (
            driven.truth[0] == pytest.approx(0.0, abs=1.5) if response == "RETURN" else driven.truth[0] < 0.0
        )
        assert driven.truth[2] >= -0.4
        assert not driven.undone


def test_it_comes_up_and_says_so_where_there_is_no_emergency_area():
    with sub() as driven:
        driven.go_down()
        driven.stop("EMERGENCY_AREA")
        assert driven.undone == "no path there is known: it surfaces where it is"
        assert driven.truth[2] >= -0.4


def test_thrust_that_is_to_stop_has_stopped():
    with sub() as driven:
        driven.go_down()
        driven.stop("STOP_THRUST")
        assert not driven.vehicle.autopilot.armed


def test_a_vehicle_that_comes_up_can_be_told_to_stay():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.9)
        driven.backend.respond("SURFACE", driven.clock.now())
        until(lambda: driven.vehicle.autopilot.mode_name == "surface")
        driven.stop("HOLD")
        assert driven.vehicle.autopilot.mode_name == "depth_hold"
        assert driven.truth[2] < -0.4


def test_it_pauses_and_goes_on():
    with sub() as driven:
        driven.set_out()
        driven.backend.pause(driven.clock.now())
        until(lambda: driven.backend.paused(driven.clock.now()))
        here = driven.truth
        driven.pass_by(5.0)
        assert driven.truth == pytest.approx(here, abs=0.3)
        assert not driven.done
        driven.backend.resume(driven.clock.now())
        driven.finish()
        assert driven.truth[0] == pytest.approx(6.0, abs=1.5)


def test_it_pauses_on_its_way_round_what_is_forbidden():
    with sub(areas=(WALL,)) as driven:
        driven.begin("out")
        driven.finish()
        driven.backend.recover((), "out", driven.clock.now())
        driven.backend.pause(driven.clock.now())
        until(lambda: driven.backend.paused(driven.clock.now()))
        here = driven.truth
        driven.pass_by(10.0)
        assert driven.truth == pytest.approx(here, abs=0.4)
        driven.backend.resume(driven.clock.now())
        driven.finish()
        assert driven.truth[0] == pytest.approx(0.0, abs=1.5)


@pytest.mark.parametrize("response", ["HOLD", "SURFACE"])
def test_it_stops_as_a_response_says(response):
    with sub() as driven:
        driven.go_down()
        driven.stop(response)
        assert driven.truth[2] >= -0.4 if response == "SURFACE" else driven.truth[2] <= -1.0
