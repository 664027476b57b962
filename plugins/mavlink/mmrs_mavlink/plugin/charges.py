"""What a robot's sorties take of its batteries, by the bounds that its behaviour is checked with."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_core.behaviour.program import BEHAVIOUR, RobotProgram
from mmrs_core.behaviour.walk import reachable, successors
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Name
from mmrs_mavlink.program import Charge

RECHARGE: Name = (BEHAVIOUR, "Recharge")


def charge_of(robot: RobotProgram, input: TargetInput) -> Charge | None:
    """Return what the batteries of a robot hold, and what its sorties take; None where that is unknown.

    Found once for all robots of a behaviour.
    """
    if charges_of not in input.shared:
        input.shared[charges_of] = charges_of(input)
    found: Mapping[str, Charge] = input.shared[charges_of]  # type: ignore[assignment]
    return found.get(robot.id)


def charges_of(input: TargetInput) -> Mapping[str, Charge]:
    """Return the charges of all robots of a behaviour whose types state them, by robot."""
    program, types = input.program, input.types
    given = CheckInput(
        program, types, input.robot_kinds, input.move_kinds, input.areas, input.environment, input.elements
    )
    found = ((robot.id, _charge(robot, given)) for robot in program.robots if robot.type_name in types)
    return {robot: charge for robot, charge in found if charge is not None}


def _charge(robot: RobotProgram, input: CheckInput) -> Charge | None:
    batteries = input.types[robot.type_name].batteries
    if not batteries:
        return None
    from mmrs_core.analysis.sorties import sorties_of  # only programs with batteries need it

    sorties, voltages = sorties_of(input, robot), {battery.voltage for battery in batteries}
    first = _first_sortie(robot)
    least = [use.seconds for use in sorties.least if use.move in first and _ends(robot, use.move, first)]
    most = [use for use in sorties.uses if not sorties.gaps]
    return Charge(
        _rounded(sum(battery.energy for battery in batteries)),
        voltages.pop() if len(voltages) == 1 else None,
        _rounded(min(least, default=0.0)),
        _rounded(max(use.seconds for use in most if use.move in first)) if most else None,
        _rounded(max(use.seconds for use in most)) if most else None,
    )


def _rounded(number: float) -> float:
    return round(number, 1)


def _first_sortie(robot: RobotProgram) -> frozenset[int]:
    """Return the moves that a robot may make before it recharges."""
    ways = successors(robot)
    stays = [() if robot.moves[move].is_a(RECHARGE) else ways[move] for move in range(len(ways))]
    found = reachable(stays, (robot.start,))
    return frozenset(move for move in found if not robot.moves[move].is_a(RECHARGE))


def _ends(robot: RobotProgram, move: int, sortie: frozenset[int]) -> bool:
    """Return whether a sortie may end with a move."""
    after = successors(robot)[move]
    return not after or not sortie.issuperset(after)
