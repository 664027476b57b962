"""The eyes of a simulated vehicle, in one process with it."""

from __future__ import annotations

from collections.abc import Sequence

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.eyes import Detection
from auv_vessel.sheet import Sheet
from auv_vision.cameras import Pose, cameras_of
from auv_vision.detecting import Sought, detect, detections_of, sought_in
from auv_vision.renderer import Renderer
from auv_vision.water import POOL, hazier


class Eyes:
    """Takes pictures of the simulated water and looks at them; the same seed and poses see the same.

    Attributes:
        sought: what it looks out for.
    """

    def __init__(
        self,
        sheet: Sheet,
        surroundings: Surroundings,
        seed: int = 0,
        *,
        sought: Sequence[Sought] | None = None,
    ) -> None:
        """Look out for what is sought; None: for all that is there."""
        self._cameras, self._robot = cameras_of(sheet), sheet.robot
        self._renderer = Renderer(surroundings, seed)
        self.sought = sought_in(surroundings) if sought is None else tuple(sought)
        self._water = hazier(POOL, surroundings.haze)

    def look(self, time: float, pose: Pose, believed: Pose | None = None) -> list[Detection]:
        """Return what both cameras see, by the clock of the vehicle, seconds.

        Args:
            pose: where the vehicle is. believed: where it believes to be, from which places of things
                are computed; None: the same.
        """
        found: list[Detection] = []
        for camera in self._cameras:
            left, right = self._renderer.pair(camera, pose, time)
            sightings = detect(left, right, camera, self.sought, self._water)
            found += detections_of(sightings, camera, believed or pose, time, self._robot)
        return found
