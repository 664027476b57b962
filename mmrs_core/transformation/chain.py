"""A robot's moves while they are being put together: a graph that grows at its open ends."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.contributions.rules import MoveSpec


@dataclass(frozen=True, slots=True)
class UseDevice:
    """A device action to be made."""

    action: str
    device: str
    parameters: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class SendFeedback:
    """A feedback to the control station to be made."""

    payload: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class SendSignal:
    """A notification to be made: the slot named after the signal, in each of these robots."""

    signal: str
    receivers: tuple[str, ...]


Deed: TypeAlias = UseDevice | SendFeedback | SendSignal


@dataclass(slots=True)
class DraftMove:
    """A move to be made for a step of the plan, with what is done before and after it."""

    spec: MoveSpec
    task: str
    rule: str
    step: int | None = None
    before: list[Deed] = field(default_factory=list)
    after: list[Deed] = field(default_factory=list)


@dataclass(slots=True)
class DraftTransition:
    """A transition to be made; `condition` and `otherwise` make it a Choice."""

    source: int
    to: int | None = None
    waits: tuple[str, ...] = ()
    condition: str | None = None
    otherwise: int | None = None


@dataclass(frozen=True, slots=True)
class OpenEnd:
    """An open end of the chain: after a move, or one branch of a Choice."""

    source: int
    choice: DraftTransition | None = None
    holds: bool = True


class Chain:
    """A growing graph of moves, from Start.

    Attributes:
        nodes: the moves, in the order in which they were added.
        edges: the transitions between them.
        step: number of the step of the plan that moves are added for now; None: for none.
    """

    def __init__(self) -> None:
        self.step: int | None = None
        self.nodes = [DraftMove(MoveSpec((BEHAVIOUR, "Start")), "", "launch")]
        self.edges: list[DraftTransition] = []
        self._ends: tuple[OpenEnd, ...] = (OpenEnd(0),)
        self._waits: tuple[str, ...] = ()

    def add(self, spec: MoveSpec, task: str, rule: str) -> DraftMove:
        """Add a move after every open end; it is then the only open end."""
        node, index = DraftMove(spec, task, rule, self.step), len(self.nodes)
        self.nodes.append(node)
        for end in self._ends:
            self._connect(end, index)
        self._ends, self._waits = (OpenEnd(index),), ()
        return node

    def wait(self, signals: tuple[str, ...]) -> None:
        """Let the next move wait for these signals as well."""
        self._waits += tuple(signal for signal in signals if signal not in self._waits)

    @property
    def is_waiting(self) -> bool:
        """Return whether the next move has to wait, or follows several moves."""
        return bool(self._waits) or len(self._ends) > 1 or self._ends[0].choice is not None

    def last(self, task: str, rule: str) -> DraftMove:
        """Return the last move, after which something can be done at once.

        Where the next move has to wait, that is a stop on the spot, added here.
        """
        if self.is_waiting:
            return self.pause(task, rule)
        return self.nodes[self._ends[0].source]

    def pause(self, task: str, rule: str, seconds: float = 0.0) -> DraftMove:
        """Add a stop on the spot for `seconds`."""
        return self.add(MoveSpec((BEHAVIOUR, "HoldPosition"), {"duration": seconds}), task, rule)

    def branch(self, condition: str) -> tuple[OpenEnd, OpenEnd]:
        """End the chain with a Choice; return its two branches, to be given to `resume`."""
        if len(self._ends) > 1 or self._ends[0].choice is not None:
            self.pause("", "choice")
        edge = DraftTransition(self._ends[0].source, waits=self._waits, condition=condition)
        self.edges.append(edge)
        self._waits = ()
        return OpenEnd(edge.source, edge), OpenEnd(edge.source, edge, holds=False)

    def resume(self, *ends: OpenEnd) -> None:
        """Continue at these open ends."""
        self._ends = ends

    @property
    def ends(self) -> tuple[OpenEnd, ...]:
        """Return the open ends; a pending wait is made a stop on the spot first."""
        if self._waits:
            self.pause("", "wait")
        return self._ends

    def _connect(self, end: OpenEnd, index: int) -> None:
        if end.choice is None:
            self.edges.append(DraftTransition(end.source, index, self._waits))
        elif self._waits:
            raise ValueError("a branch of a choice cannot wait; add a stop on the spot first")
        elif end.holds:
            end.choice.to = index
        else:
            end.choice.otherwise = index
