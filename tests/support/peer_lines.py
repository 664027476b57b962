"""What peers say on an output to which their libraries log, too, before, after and in the same line."""

import json
from typing import Any


def said_in(line: str) -> dict[str, Any] | None:
    """Return the JSON object that a peer says in a line, marked with `peer`; None: it says nothing there."""
    _, mark, rest = line.partition("peer {")
    return json.JSONDecoder().raw_decode("{" + rest)[0] if mark else None
