"""Which supertypes of a class Python can have as bases: Ecore's order need not be one of Python's."""

from __future__ import annotations

from mmrs_core.languages.datatypes import BUILT_IN
from mmrs_core.languages.metaclass import Feature, Metaclass


class Lineage:
    """Finds bases, and remembers the shape of every class that it was asked about."""

    def __init__(self) -> None:
        self._shapes: dict[Metaclass, type] = {}

    def bases(self, metaclass: Metaclass) -> tuple[Metaclass, ...]:
        """Return the supertypes that can be bases together, in their order; the first always can.

        Those of Ecore itself have no stub, hence are none.
        """
        chosen: tuple[Metaclass, ...] = ()
        for above in dict.fromkeys(metaclass.supertypes):
            if above.ns_uri in BUILT_IN:
                continue
            if any(above.key in other.ancestry[1:] for other in metaclass.supertypes):
                continue
            if self._fit((*chosen, above)):
                chosen = (*chosen, above)
        return chosen

    def own_features(self, metaclass: Metaclass) -> tuple[Feature, ...]:
        """Return the features that none of the bases has."""
        inherited = {feature for base in self.bases(metaclass) for feature in base.features}
        return tuple(feature for feature in metaclass.features if feature not in inherited)

    def _fit(self, bases: tuple[Metaclass, ...]) -> bool:
        try:
            type("Shape", tuple(map(self._shape, bases)), {})
        except TypeError:
            return False
        return True

    def _shape(self, metaclass: Metaclass) -> type:
        if metaclass not in self._shapes:
            above = tuple(map(self._shape, self.bases(metaclass)))
            self._shapes[metaclass] = type(metaclass.name, above, {})
        return self._shapes[metaclass]
