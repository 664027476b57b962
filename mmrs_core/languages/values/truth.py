"""Truth values."""

from __future__ import annotations

from mmrs_core.languages.values.texts import collapsed, shown


def parse_boolean(text: str) -> bool:
    """Read a truth value, in any case of letters, as EMF does."""
    word = text.lower()
    if word not in ("true", "false"):
        raise ValueError(f"{shown(text)}: not true or false")
    return word == "true"


def parse_schema_boolean(text: str) -> bool:
    """Read a truth value as XML Schema part 2 has it, section 3.2.2."""
    word = collapsed(text)
    if word not in ("true", "false", "1", "0"):
        raise ValueError(f"{shown(text)}: not true, false, 1 or 0")
    return word in ("true", "1")


def render_boolean(value: object) -> str:
    """Write a truth value."""
    return "true" if value else "false"
