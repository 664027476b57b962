"""What only the user can say: when conditions hold, and where objects are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .conditions import Condition
from .objects import Locator
from .program import Choose, GoTo, Movement, Object, Robot, Turn


@dataclass(frozen=True, slots=True)
class Judgement:
    """The user's functions: conditions by identifier, locators by description of the object."""

    conditions: Mapping[str, Condition]
    locators: Mapping[str, Locator]

    def faults(self, robots: Sequence[Robot]) -> list[str]:
        """Return what is missing for these robots."""
        choices = {s.then.condition for r in robots for s in r.steps if isinstance(s.then, Choose)}
        objects = {found for r in robots for s in r.steps for found in _objects(s.movement)}
        return [
            *(
                f"conditions.py decides nothing for {name!a}"
                for name in sorted(choices - set(self.conditions))
            ),
            *(f"objects.py finds nothing for {name!a}" for name in sorted(objects - set(self.locators))),
        ]


def _objects(movement: Movement) -> list[str]:
    look = movement.look if isinstance(movement, GoTo | Turn) else None
    targets = [look.at if look else None, movement.at if isinstance(movement, GoTo) else None]
    return [target.description for target in targets if isinstance(target, Object)]
