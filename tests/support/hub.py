"""Several ends of a bus within one process, joined by calls instead of a network."""

from __future__ import annotations

from mmrs_runtime.bus.carriers.carrier import Answered, Station


class Hub:
    """Joins several ends of a bus within one process, by calls; `plug` gives each a carrier."""

    def __init__(self) -> None:
        """Join nothing yet."""
        self.stations: dict[str, Station] = {}

    def plug(self) -> HubCarrier:
        """Return a carrier for one more end."""
        return HubCarrier(self)

    def noticed(self, robot: str, here: bool, besides: Station) -> None:
        """Tell all other ends that a robot has come or gone."""
        for station in {id(each): each for each in self.stations.values() if each is not besides}.values():
            station.noticed(robot, here)


class HubCarrier:
    """The carrier of one end of a hub."""

    def __init__(self, hub: Hub) -> None:
        """Be plugged in, but serve nobody yet."""
        self._hub = hub
        self._station: Station | None = None

    def open(self, station: Station) -> None:
        """Notice who is there."""
        self._station = station
        for robot in tuple(self._hub.stations):
            station.noticed(robot, True)

    def ask(self, sender: str, owner: str, request: str, answered: Answered) -> None:
        """Have the robot's end answer at once, if there is one."""
        station = self._hub.stations.get(owner)
        if station is not None:
            answered(station.serve(owner, sender, request))

    def appear(self, robot: str) -> None:
        """Tell the other ends."""
        assert self._station is not None
        self._hub.stations[robot] = self._station
        self._hub.noticed(robot, True, self._station)

    def vanish(self, robot: str) -> None:
        """Tell the other ends."""
        if self._hub.stations.pop(robot, None) is not None and self._station is not None:
            self._hub.noticed(robot, False, self._station)

    def publish(self, robot: str) -> None:
        """Ignore a call: there are no observers."""

    def close(self) -> None:
        """Take all robots of this end away."""
        for robot in [r for r, station in self._hub.stations.items() if station is self._station]:
            self.vanish(robot)
