"""How elements look on maps and pictures."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_core.scene import Name


@dataclass(frozen=True, slots=True)
class MapSymbol:
    """The look of elements of one metaclass.

    Attributes:
        metaclass: of the elements.
        label: what people call such an element.
        colour: as ``#rrggbb``.
        icon: up to two characters that stand for it on a map.
        fields: attributes that an editor offers first, by feature name.
    """

    metaclass: Name
    label: str
    colour: str
    icon: str
    fields: tuple[str, ...] = ()
