"""Has MAVSDK import plans, upload them to a vehicle, download them again, and tell it all, as JSON.

Usage: python mavsdk_import.py PORT PLAN...; the vehicle must be sending to PORT.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from mavsdk import ComponentType, Configuration, ConnectionResult, Mavsdk
from mavsdk.plugins.mission_raw import MissionRaw


def item(found) -> list[object]:
    return [found.command, found.frame, found.x, found.y, round(found.z, 3), found.mission_type]


def main(port: str, paths: list[str]) -> None:
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    added = mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    assert added == ConnectionResult.SUCCESS, added
    system = mavsdk.first_autopilot(10.0)
    assert system is not None, "no vehicle"
    missions = MissionRaw(system)
    for path in paths:
        found = missions.import_qgroundcontrol_mission_from_string(Path(path).read_text("utf-8"))
        lists = {"mission": found.mission_items, "fence": found.geofence_items, "rally": found.rally_items}
        missions.upload_mission(found.mission_items)
        lists["downloaded"] = missions.download_mission()
        shown = {what: [item(each) for each in items] for what, items in lists.items()}
        print("peer " + json.dumps(shown), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
