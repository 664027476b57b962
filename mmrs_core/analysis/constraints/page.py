"""The page of the documentation that lists constraints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import groupby

from mmrs_core.contributions.constraints import Constraint

_CHAPTERS = {
    "BL": "Behaviours",
    "CTX": "Contexts",
    "MML": "Missions",
    "RL": "Robot types",
}
_PREFACE = """\
# Constraints

What valid models keep beyond their metamodels. `mmrs validate` checks missions, contexts and robot types,
`mmrs check` behaviours; both report every breach with its file, line and element. Errors stop a mission,
warnings do not. Plug-ins add constraints of their own.

This page is generated from the constraints.
"""


def page_of(constraints: Iterable[Constraint], examples: Mapping[str, str]) -> str:
    """Return the page in Markdown, constraints by code.

    Args:
        constraints: to be listed.
        examples: by code, what is said of a model that breaks the constraint.
    """
    ordered = sorted(constraints, key=lambda each: each.code)
    chapters = (
        f"## {_CHAPTERS.get(prefix, prefix)}\n\n" + "\n".join(_entry(each, examples) for each in group)
        for prefix, group in groupby(ordered, key=lambda each: each.code.rstrip("0123456789"))
    )
    return "\n".join((_PREFACE, *chapters))


def _entry(constraint: Constraint, examples: Mapping[str, str]) -> str:
    lines = [
        f"### {constraint.code}",
        "",
        f"{constraint.title} ({constraint.metaclass[1]}, {constraint.severity.value})",
        "",
    ]
    if constraint.code in examples:
        lines += [f"- Breach: {examples[constraint.code]}"]
    lines += [f"- Mend: {constraint.hint}", ""]
    return "\n".join(lines)
