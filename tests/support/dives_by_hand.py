"""A simulated ArduSub that does not know where it is, and its robot, which is driven by hand."""

from contextlib import contextmanager
from dataclasses import replace

from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.names import AUV_MOVEMENT
from mmrs_multicopter.testing import robot_program
from patience import until
from ports import free_port

from mmrs_core.behaviour.program import BEHAVIOUR, Heading, MoveTarget
from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.scene import Capability, Device, DeviceAction, Frame, Part, RobotType
from mmrs_core.testing.programs import move, program
from mmrs_mavlink.plugin.manual import ARDUSUB_MANUAL
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.engine.clocks import RealClock

SPEEDUP = 10.0
POOL = Frame("EPSG:4326", None, None, surface=0.0)
ROBOT = ("urn:mmrs:robot:1.0", "Robot")
DEVICE_ACTION = ((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action"))
DIVER = RobotType(
    "Diver",
    (ROBOT,),
    (AUV_MOVEMENT,),
    0.5,
    None,
    (Capability(0.0, 3600.0, (0.0, 1.0)),),
    (),
    {"lamp": Device("lamp", {"on": DeviceAction("on", 0.0)}, {"mavlink.relay": "1"})},
    Part((ROBOT,), {"maxOperatingPressure": 600_000.0}),
)


def dive(id, east, north, depth, **changes):
    """Return a move to a place so deep."""
    return replace(move(id, "GoTo"), **{"target": MoveTarget((east, north, -depth)), "speed": 0.8, **changes})


MOVES = (
    dive("out", 6.0, 0.0, 2.0),
    move("stay", "HoldPosition", duration=3.0),
    replace(move("look", "HeadTo"), heading=Heading(MoveTarget((6.0, 50.0, -2.0)))),
    dive("up", 6.0, 4.0, 0.0),
)


def given(*moves, live=None, areas=(), policies=(), **options):
    """Return what a backend is given of the robot with these moves."""
    robot = robot_program("naiad", moves or MOVES, home=(0.0, 0.0, 0.0), type_name="Diver")
    kinds = {AUV_MOVEMENT: AUV_KIND}
    behaviour = program(robot, frame=POOL, reserve=0.2)
    own = {"robot": robot, "type": DIVER, "options": options, "policies": policies, "live": live}
    return VehicleInput(behaviour, {DIVER.name: DIVER}, kinds, {}, areas, **own)


def connected(url, clock, say=print, shared=None, **more):
    """Return what drives the robot whose vehicle is there; it does not listen yet."""
    live = Live(
        clock, lambda: None, say, "run-0", links={"naiad": url}, shared={} if shared is None else shared
    )
    return ARDUSUB_MANUAL.connect(given(live=live, **more))


class Driven:
    """The robot at work."""

    def __init__(self, backend, clock, vehicle, said):
        self.backend, self.clock, self.vehicle, self.said = backend, clock, vehicle, said

    def begin(self, id):
        self.backend.do(next(each for each in MOVES if each.id == id), self.clock.now())

    def set_out(self):
        """Begin to go out, and wait until it is a metre from home."""
        self.begin("out")
        until(lambda: self.truth[0] > 1.0)

    def go_down(self):
        """Begin to go out, and wait until it is a metre deep."""
        self.begin("out")
        until(lambda: self.truth[2] < -1.0)

    def finish(self):
        until(lambda: self.fault or self.done, 30.0)
        assert self.fault is None, self.fault

    def stop(self, response):
        self.backend.respond(response, self.clock.now())
        until(lambda: self.done, 30.0)

    def pass_by(self, seconds):
        end = self.clock.now() + seconds
        until(lambda: self.clock.now() >= end)

    @property
    def undone(self):
        return self.backend.undone(self.clock.now())

    @property
    def done(self):
        self.backend.look(self.clock.now())
        return self.backend.done

    @property
    def fault(self):
        self.backend.look(self.clock.now())
        return self.backend.trouble

    @property
    def truth(self):
        north, east, up = self.vehicle.autopilot.body.position
        return east, north, up


@contextmanager
def sub(*, located=False, areas=(), policies=(), parameters=None, **settings):
    """Give a simulated ArduSub that has no position, and its robot, ready."""
    port, clock, said = free_port(), RealClock(SPEEDUP), []
    backend = connected(f"udpin:127.0.0.1:{port}", clock, said.append, areas=areas, policies=policies)
    with SimulatedVehicle(port, Settings(kind="sub", **settings), speedup=SPEEDUP) as vehicle:
        vehicle.autopilot.located = located
        vehicle.autopilot.parameters.update(parameters or {})
        driven = Driven(backend, clock, vehicle, said)
        try:
            backend.prepare(clock.now())
            driven.finish()
            yield driven
        finally:
            backend.close()
