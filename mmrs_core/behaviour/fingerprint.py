"""What tells one plain value from another, such as one plan of a mission from the next."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from hashlib import sha256

from mmrs_core.diagnostics import Place

_DIGITS = 16


def fingerprint(value: object) -> str:
    """Return sixteen hexadecimal digits that differ where values do.

    Where they were read from makes no difference.
    """
    text = json.dumps(_plain(value), sort_keys=True, separators=(",", ":"))
    return sha256(text.encode()).hexdigest()[:_DIGITS]


def _plain(value: object) -> object:
    """Return a value as JSON can hold it, without the places of its source."""
    if is_dataclass(value) and not isinstance(value, type):
        own = {each.name: getattr(value, each.name) for each in fields(value)}
        return {name: _plain(part) for name, part in own.items() if not isinstance(part, Place)}
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)
