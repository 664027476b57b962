"""Tries out what a target does with each element of the Behaviour Language."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import chain
from typing import Literal, TypeAlias

from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.targets import Target, TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.capabilities import actions, behaviours, moves, policies
from mmrs_core.generation.capabilities.probes import Probe
from mmrs_core.generation.capabilities.water import under_water
from mmrs_core.generation.environment import environment_of
from mmrs_core.generation.render import Press
from mmrs_core.scene import Metaclasses

Verdict: TypeAlias = Literal["expressed", "no difference", "lossy", "refused"]
VERDICTS: dict[Verdict, str] = {
    "expressed": "it is in the generated files",
    "no difference": "the files are the same without it: it is for others than the robot's controller",
    "lossy": "refused; with --allow-lossy it is left out, or is done as the list says",
    "refused": "refused, also with --allow-lossy",
}
"""Meaning of each verdict, as printed."""


@dataclass(frozen=True, slots=True)
class TargetCapability:
    """What a target does with an element.

    Attributes:
        group, element: as in `Probe`.
        how: how it is expressed, in the target's words; or why it is refused.
    """

    group: str
    element: str
    verdict: Verdict
    how: str = ""


def probes(more_moves: Iterable[Metaclasses] = ()) -> tuple[Probe, ...]:
    """Return a minimal behaviour for each element of the Behaviour Language.

    Args:
        more_moves: metaclasses of moves that plug-ins have added, each most specific first.
    """
    return tuple(
        chain(
            behaviours.of_behaviours(),
            behaviours.of_robots(),
            behaviours.of_places(),
            moves.of_moves(),
            moves.of_plugins(more_moves),
            moves.of_headings(),
            moves.of_transitions(),
            actions.of_actions(),
            policies.of_policies(),
        )
    )


def capabilities_of(
    target: Target, contributions: Contributions, tried: Iterable[Probe] | None = None
) -> tuple[TargetCapability, ...]:
    """Return what a target does with each element; by default with each that `probes` gives."""
    trial = Trial(target)
    known = suited(probes() if tried is None else tried, target, contributions)
    return tuple(trial.judged(probe) for probe in known)


def suited(tried: Iterable[Probe], target: Target, contributions: Contributions) -> tuple[Probe, ...]:
    """Return the probes as they are tried with a target: with drones, or with underwater vehicles."""
    made = (under_water(probe) if target.tried_with == "water" else probe for probe in tried)
    moves = contributions.move_kinds
    kinds = {name: replace(kind, policies={}) for name, kind in contributions.robot_kinds.items()}

    def with_kinds(input: TargetInput) -> TargetInput:
        return replace(input, robot_kinds=kinds, move_kinds=moves)

    return tuple(
        replace(probe, given=with_kinds(probe.given), without=with_kinds(probe.without)) for probe in made
    )


class Trial:
    """A target that is tried out."""

    def __init__(self, target: Target) -> None:
        """Prepare the target's templates."""
        self._target = target
        self._press = Press(target, environment_of(target))

    def judged(self, probe: Probe) -> TargetCapability:
        """Return what the target does with the element of a probe."""
        refused = self._refusals(probe.given)
        if reasons := refused - self._refusals(probe.without) or refused:
            verdict: Verdict = "refused" if self._impossible(probe.given) else "lossy"
            words = "; ".join(sorted({_short(each) for each in reasons}))
            return TargetCapability(probe.group, probe.element, verdict, words)
        how = self._how(probe.element)
        same = self._written(probe.given) == self._written_at_all(probe.without)
        return TargetCapability(probe.group, probe.element, "no difference" if same else "expressed", how)

    def _how(self, element: str) -> str:
        words = self._target.capabilities
        fitting = [begin for begin in words if element.startswith(begin)]
        return words[max(fitting, key=len)] if fitting else ""

    def _refusals(self, input: TargetInput) -> set[str]:
        return set(self._target.refusals(input))

    def _impossible(self, input: TargetInput) -> bool:
        return self._written_at_all(input) is None

    def _written_at_all(self, input: TargetInput) -> dict[str, bytes] | None:
        """Return what is rendered; None where that is impossible."""
        try:
            return self._written(input)
        except UnsupportedError:
            return None

    def _written(self, input: TargetInput) -> dict[str, bytes]:
        """Return what is rendered for this behaviour.

        Not what is copied, which is the same for every behaviour, nor the fingerprint, which never is.
        """
        mark = input.program.fingerprint.encode()
        specs = self._target.files(input)
        return {
            spec.path: self._press.content(spec)[0].replace(mark, b"")
            for spec in specs
            if spec.source is None
        }


def _short(reason: str) -> str:
    """Return a refusal without the robot and the move that it is about."""
    head, _, rest = reason.partition(": ")
    return rest if rest and head.startswith("robot '") else reason
