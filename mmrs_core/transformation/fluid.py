"""Where a robot may go from one move into the next without a stop."""

from __future__ import annotations

from mmrs_core.contributions.rules import MoveSpec
from mmrs_core.planning.corners import Corners
from mmrs_core.scene import Position, Robot, Scene
from mmrs_core.transformation.chain import Chain, DraftTransition


class FluidTransitions:
    """The ends of a robot's moves that it may pass without a stop.

    Where robots must keep apart they stop at every corner, so that it is certain when they are where.
    """

    def __init__(self, robot: Robot, scene: Scene, chain: Chain) -> None:
        self._robot, self._chain = robot, chain
        self._corners = Corners(robot, scene.kept_from(robot), scene.corridors_of(robot))
        self._timed = scene.timed
        self._before = {after: edge.source for edge in chain.edges for after in (edge.to, edge.otherwise)}

    def may_flow(self, edge: DraftTransition) -> bool:
        """Return whether the transition along that edge may be fluid."""
        if self._timed or edge.to is None or edge.waits or edge.condition is not None:
            return False
        nodes = self._chain.nodes
        first, second = nodes[edge.source], nodes[edge.to]
        settles = first.spec.settles or second.spec.settles
        if first.after or second.before or settles:
            return False
        if not (_travels(first.spec) and _travels(second.spec)):
            return False
        corner, end = first.spec.target, second.spec.target
        if corner is None or end is None:
            return False
        start = nodes[self._before[edge.source]].spec.target
        if self._robot.kinematics is not None and self._robot.kinematics.turning_radius > 0.0:
            start = self._place_before(edge.source)
        return self._corners.may_pass(start, corner, end, first.spec.speed)

    def _place_before(self, node: int) -> Position:
        """Return where the robot is when a move begins: its home, unless a move before has led elsewhere."""
        at = self._before.get(node)
        while at is not None:
            target = self._chain.nodes[at].spec.target
            if target is not None:
                return target
            at = self._before.get(at)
        return self._robot.home


def _travels(spec: MoveSpec) -> bool:
    return spec.metaclass[1] == "GoTo" and spec.object is None and spec.target is not None
