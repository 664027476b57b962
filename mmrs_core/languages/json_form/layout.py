"""How JSON is laid out: short objects on one line, long ones with a line for each member."""

from __future__ import annotations

from collections.abc import Sequence

from mmrs_core.languages.json_form.tree import Node, Number
from mmrs_core.languages.json_form.values import quoted

WIDEST = 110


def laid_out(members: Sequence[str], depth: int) -> str:
    """Return an object on one line, or where that is too long, with a line for each member."""
    line = f"{{{', '.join(members)}}}"
    if len(line) + 2 * depth <= WIDEST or not members:
        return line
    margin = "  " * (depth + 1)
    return "{\n" + ",\n".join(margin + member for member in members) + "\n" + "  " * depth + "}"


def formatted(value: object, depth: int) -> str:
    """Return what is kept of an element whose metamodel is not installed, in the same form as all else."""
    if isinstance(value, Node):
        members = [f"{quoted(key)}: {formatted(each, depth + 1)}" for key, each in value.members.items()]
        plain = not any(_holds_objects(each) for each in value.members.values())
        margin = "  " * (depth + 1)
        if plain:
            return laid_out(members, depth)
        return "{\n" + ",\n".join(margin + member for member in members) + "\n" + "  " * depth + "}"
    if isinstance(value, list):
        parts = [formatted(each, depth + 1) for each in value]
        if not _holds_objects(value):
            return f"[{', '.join(parts)}]"
        margin = "  " * (depth + 1)
        return "[\n" + ",\n".join(margin + part for part in parts) + "\n" + "  " * depth + "]"
    if isinstance(value, Number):
        return str(value)
    if isinstance(value, str):
        return quoted(value)
    return {None: "null", True: "true", False: "false"}[value]  # type: ignore[index]  # JSON has no other


def _holds_objects(value: object) -> bool:
    return isinstance(value, Node) or (isinstance(value, list) and any(map(_holds_objects, value)))
