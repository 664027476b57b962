"""Robots of a behaviour on their buses, in real time."""

from __future__ import annotations

from dataclasses import replace

from auv_vessel.eyes import Detections
from mmrs_auv.backend.options import Connecting, connecting
from mmrs_auv.backend.orders import BehaviourOrders
from mmrs_auv.controllers.connected import ConnectedVehicle
from mmrs_auv.controllers.orders import Waters
from mmrs_auv.sheets import sheet_of_robot
from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.errors import LinkLostError, UnsupportedError, UsageError
from mmrs_runtime.controllers.box_entries import PROCESS
from mmrs_runtime.engine.clocks import FollowingClock, RealClock
from mmrs_runtime.injection import Rehearsal, injections, noted_in
from mmrs_runtime.injection.spec import OF_STATIONS, OF_VEHICLE

SHARED = "injected faults of CAN buses"


def connected(given: VehicleInput, live: Live) -> ConnectedVehicle:
    """Return a robot on its bus.

    Raises:
        LinkLostError: there is no bus, or the port for detections is taken.
        UnsupportedError: its type lacks data, an option is unknown, or it cannot do what its program holds.
    """
    options, robot, clock = connecting(given.options), given.robot.id, live.clock
    assert isinstance(clock, RealClock)
    sheet = sheet_of_robot(given.program, given.robot, given.type, given.environment)
    channel = live.links.get(robot, "") or options.channel
    eyes = _eyes(given, options)
    sight = None if eyes is None or options.objects == "expected" else eyes.place
    orders = BehaviourOrders(given, sheet, Waters(given.program.frame.surface), sight)
    faults, box = faults_of(given, live, options.inject), live.black_box(robot)
    if faults is not None:
        faults.record(robot, noted_in(box))
    try:
        return ConnectedVehicle(
            robot,
            sheet,
            orders,
            replace(options, channel=channel),
            FollowingClock(clock),
            live,
            {
                "plan": given.program.fingerprint,
                "process": PROCESS,
                "link": "can",
                "vehicle": "sub",
                "confirms": True,
            },
            box=box,
            eyes=eyes,
            rehearsal=faults,
            let_go=(lambda: None) if faults is None else lambda: faults.forget(robot),
        )
    except OSError as error:
        raise LinkLostError(f"robot '{robot}': {channel}: {error}") from error


def faults_of(given: VehicleInput, live: Live, text: str) -> Rehearsal | None:
    """Return the faults of a run, begun; None if none are asked for.

    Raises:
        UsageError: one is none, or concerns what no vehicle on a bus has.
    """
    found = live.shared.get(SHARED)
    if isinstance(found, Rehearsal) or not text:
        return found if isinstance(found, Rehearsal) else None
    buses = {robot.id: live.links.get(robot.id, robot.id) for robot in given.program.robots}
    try:
        asked = injections([text], buses)
    except ValueError as error:
        raise UsageError(f"option 'inject': {error}") from error
    for fault in asked.faults:
        if fault.name in (*OF_VEHICLE, *OF_STATIONS):
            raise UsageError(f"option 'inject': {fault.text}: is for vehicles that speak MAVLink")
    made = live.shared[SHARED] = Rehearsal(asked, FollowingClock(live.clock), live.announce)
    made.start()
    return made


def _eyes(given: VehicleInput, options: Connecting) -> Detections | None:
    sought = [
        f"move '{move.id}': object {move.target.description!r}"
        for move in given.robot.moves
        if move.target is not None and move.target.description is not None
    ]
    if not options.detections:
        if sought and options.objects != "expected":
            raise UnsupportedError(
                f"robot '{given.robot.id}': objects are not detected: --backend-option detections=PORT, or "
                "objects=expected",
                sought,
            )
        return None
    try:
        return Detections(port=options.detections, robot=given.robot.id)
    except OSError as error:
        raise LinkLostError(f"robot '{given.robot.id}': {error}") from error
