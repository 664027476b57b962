"""The layers of exported drawings by name."""

from enum import StrEnum


class Layer(StrEnum):
    """What can be drawn, as typed after ``--only``."""

    AREAS = "areas"
    ELEMENTS = "elements"
    TASKS = "tasks"
    HOMES = "homes"
    RALLY_POINTS = "rally-points"
    PATHS = "paths"
    TRACKS = "tracks"
    PHOTOS = "photos"
    ACTIONS = "actions"
    MEASUREMENTS = "measurements"
    WAITS = "waits"
    EVENTS = "events"
