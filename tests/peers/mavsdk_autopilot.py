"""An autopilot made of MAVSDK's server plug-ins: tells what it is sent, one JSON object a line.

Usage: python mavsdk_autopilot.py PORT; ends when its standard input does.
"""

import json
import sys

from mavsdk import ComponentType, Configuration, ConnectionResult, Mavsdk
from mavsdk.plugins.action_server import ActionServer
from mavsdk.plugins.mission_raw_server import MissionRawServer
from mavsdk.plugins.param_server import ParamServer
from mavsdk.plugins.telemetry_server import TelemetryServer


def tell(**fields: object) -> None:
    print("peer " + json.dumps(fields), flush=True)


def mission_came(result, plan, _) -> None:
    items = [
        [item.command, item.frame, item.x, item.y, round(item.z, 3), item.param1, item.param2]
        for item in plan.mission_items
    ]
    tell(what="mission", result=int(result), items=items)


def main(port: str) -> None:
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.AUTOPILOT))
    added = mavsdk.add_any_connection(f"udpout://127.0.0.1:{port}")
    assert added == ConnectionResult.SUCCESS, added
    component = mavsdk.server_component(0)
    parameters = ParamServer(component)
    parameters.provide_param_float("RTL_ALT", 1500.0)
    parameters.provide_param_float("FS_GCS_ENABLE", 0.0)
    plugins = [parameters, TelemetryServer(component)]
    missions, actions = MissionRawServer(component), ActionServer(component)
    missions.subscribe_incoming_mission(mission_came)
    actions.set_armable(True, True)
    actions.subscribe_arm_disarm(lambda result, command, _: tell(what="arm", arm=bool(command.arm)))
    tell(what="ready", plugins=len(plugins) + 2)
    sys.stdin.read()


if __name__ == "__main__":
    main(sys.argv[1])
