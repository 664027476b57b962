"""How elements of behaviours are expressed by the decision centre, for the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

CAPABILITIES: Mapping[str, str] = {}
