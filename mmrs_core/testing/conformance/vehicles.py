"""Laws for vehicles: what drives robots, whatever the robots are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import dist, inf, isfinite
from typing import ClassVar

import pytest

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.vehicles import VehicleFactory, VehicleInput
from mmrs_core.errors import UnsupportedError, UsageError
from mmrs_core.scene import RobotType
from mmrs_core.testing.conformance.declared import Conformance
from mmrs_core.testing.small_programs import go, hold, program, robot, robot_type
from mmrs_runtime.vehicle import Vehicle

MOST_EVENTS = 1000
"""Questions after which a movement is taken for one that never ends."""
STILL_SECONDS = 30.0
"""For so long a vehicle that waits, or has stopped, must stay where it is."""

NO_OPTION = "an option that no vehicle has"
TO_AND_FRO = program(
    robot("r", [go("there", (30.0, 0.0, 0.0)), hold("pause", 2.0), go("back", (0.0, 0.0, 0.0))])
)


class VehicleConformance(Conformance):
    """Every simulated vehicle moves one robot, one movement at a time, and stops it from any state.

    A vehicle that is a real robot's runs at the world's pace, and is tested with them; here, only what it
    refuses before it reaches out for one.

    Attributes:
        behaviour: whose first robot is driven, all its moves one after another.
        type: of that robot.
        options: that the vehicle needs, by its factory's name.
        still: seconds until a vehicle that has mass has come to rest, and m/s and metres by which it still
            moves then at most, by its factory's name; where nothing is said, it stands still at once.
    """

    behaviour: ClassVar[Program] = TO_AND_FRO
    type: ClassVar[RobotType] = robot_type()
    options: ClassVar[Mapping[str, Mapping[str, str]]] = {}
    still: ClassVar[Mapping[str, tuple[float, float]]] = {}

    def test_it_is_called_and_described_for_the_command_line(self, vehicle: VehicleFactory) -> None:
        """The name is typed, the description is one line."""
        assert vehicle.name == vehicle.name.lower()
        assert " " not in vehicle.name
        assert vehicle.description
        assert "\n" not in vehicle.description

    def test_an_option_that_it_does_not_know_is_refused(self, vehicle: VehicleFactory) -> None:
        """A misspelt option is never swallowed."""
        given = self._input(vehicle)
        with pytest.raises((UsageError, UnsupportedError), match=NO_OPTION):
            vehicle.connect(replace(given, options={**given.options, NO_OPTION: "1"}))

    def test_it_begins_at_home_without_moving(self, vehicle: VehicleFactory) -> None:
        """Its state is known before anything was begun."""
        driven = self._simulated(vehicle)
        state = driven.state(0.0)
        assert (state.time, state.position) == (0.0, self.behaviour.robots[0].home)
        assert state.speed == 0.0

    def test_every_movement_ends_where_it_leads_to(self, vehicle: VehicleFactory) -> None:
        """Movements that are begun one after another finish one after another."""
        driven, now = self._simulated(vehicle), 0.0
        for move in self.behaviour.robots[0].moves:
            driven.do(move, now)
            now = _end(driven, now)
            assert driven.trouble is None
            if move.target is not None and move.target.position is not None:
                assert driven.state(now).position == pytest.approx(move.target.position, abs=0.5)

    def test_waiting_ends_never_and_moves_nothing(self, vehicle: VehicleFactory) -> None:
        """The robot holds its pose until the next movement."""
        driven = self._simulated(vehicle)
        driven.wait(0.0)
        self._stands_still(driven, vehicle, 0.0)

    @pytest.mark.parametrize("response", ["HOLD", "RETURN", "LAND", "SURFACE", "STOP_THRUST"])
    @pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
    def test_it_stops_from_any_state_and_stays_there(
        self, vehicle: VehicleFactory, response: str, share: float
    ) -> None:
        """Stopping twice is stopping once."""
        driven = self._simulated(vehicle)
        driven.do(self.behaviour.robots[0].moves[1], 0.0)
        when = share * min(driven.look(0.0), 1e6)
        driven.respond(response, when)
        end = _end(driven, when)
        driven.respond(response, end)
        self._stands_still(driven, vehicle, end)

    def _stands_still(self, driven: Vehicle, vehicle: VehicleFactory, since: float) -> None:
        seconds, moves = self.still.get(vehicle.name, (1.0, 0.0))
        state = driven.state(since + seconds)
        later = driven.state(since + seconds + STILL_SECONDS)
        assert max(state.speed, later.speed) <= moves
        assert dist(later.position, state.position) <= moves

    def _input(self, vehicle: VehicleFactory) -> VehicleInput:
        known = self.with_core()
        return VehicleInput(
            program=self.behaviour,
            types={self.type.name: self.type},
            robot_kinds=known.robot_kinds,
            move_kinds=known.move_kinds,
            robot=self.behaviour.robots[0],
            type=self.type,
            options=self.options.get(vehicle.name, {}),
        )

    def _simulated(self, vehicle: VehicleFactory) -> Vehicle:
        if not vehicle.simulated:
            pytest.skip(f"{vehicle.name} drives real robots")
        return vehicle.connect(self._input(vehicle))


def _end(driven: Vehicle, now: float) -> float:
    """Return when what was begun last has finished."""
    for _ in range(MOST_EVENTS):
        after = driven.look(now)
        if driven.done:
            return now
        assert now < after < inf
        assert isfinite(after)
        now = after
    raise AssertionError(f"not finished after {MOST_EVENTS} events")
