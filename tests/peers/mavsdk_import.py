"""Has MAVSDK import missions, upload them to a vehicle, download them again, and tell it all, as JSON.

Usage: python mavsdk_import.py PORT FILE...; the vehicle must be sending to PORT. Files are plans for
QGroundControl, or lists of waypoints where they end in ``.waypoints``.
"""

import json
import sys
from pathlib import Path

from mavsdk import ComponentType, Configuration, ConnectionResult, Mavsdk
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.mission_raw.mission_raw import MissionRawError

TRIES = 5


def item(found) -> list[object]:
    place = [found.x, found.y, round(found.z, 3)]
    params = [found.param1, found.param2, found.param3, found.param4]
    return [found.command, found.frame, *place, found.mission_type, *params]


def imported(missions: MissionRaw, path: Path):
    text = path.read_text("utf-8")
    if path.suffix == ".waypoints":
        return missions.import_mission_planner_mission_from_string(text)
    return missions.import_qgroundcontrol_mission_from_string(text)


def again(transfer):
    """Return what a transfer gives, tried again where MAVSDK gives up, as it soon does."""
    for _ in range(TRIES - 1):
        try:
            return transfer()
        except MissionRawError as error:
            print(error, flush=True)
    return transfer()


def main(port: str, paths: list[str]) -> None:
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    added = mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    assert added == ConnectionResult.SUCCESS, added
    system = mavsdk.first_autopilot(10.0)
    assert system is not None, "no vehicle"
    missions = MissionRaw(system)
    for path in paths:
        found = imported(missions, Path(path))
        lists = {"mission": found.mission_items, "fence": found.geofence_items, "rally": found.rally_items}
        again(lambda found=found: missions.upload_mission(found.mission_items))
        lists["downloaded"] = again(missions.download_mission)
        shown = {what: [item(each) for each in items] for what, items in lists.items()}
        print("peer " + json.dumps(shown), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
