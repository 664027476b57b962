"""Hooks that plug-ins specify for other plug-ins."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

Extensions: TypeAlias = Mapping[str, Mapping[str, Any]]
"""What plug-ins contribute by hooks that plug-ins specify: by `Hook.sort`, then by key."""


@dataclass(frozen=True, slots=True)
class Hook:
    """A hook of a plug-in's own, which other plug-ins implement: without arguments, it returns descriptors.

    Attributes:
        name: ``mmrs_`` and a plural noun, such as ``mmrs_kite_lines``.
        description: one line.
        descriptor: class of the descriptors, as ``module:class``; imported when it is first needed.
        key: attribute of the descriptor whose value is unique over all plug-ins.
    """

    name: str
    description: str
    descriptor: str
    key: str = "name"

    @property
    def sort(self) -> str:
        """Return the noun in its name, such as ``kite_lines``."""
        return self.name.removeprefix("mmrs_")
