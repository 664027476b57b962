"""Every diagnostic: the meaning of its code, the expectation, and its fix."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mmrs_core.diagnostics import Severity
from mmrs_core.languages.codes import CODES

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions


_ANY_VERDICT = "change the mission and plan again, or the behaviour by hand"
_UNKNOWN = "what cannot be known may be named in acceptedUnknowns"


@dataclass(frozen=True, slots=True)
class CodeEntry:
    """What all faults of a code have in common.

    Attributes:
        meaning: what is wrong; for constraints and properties of behaviours, what must hold.
        subject: the class of elements it is about; empty where it is about files.
        fix: what its quick fix does; empty if it has none.
        plugin: the distribution of the plug-in that brings it; empty for the core.
    """

    code: str
    severity: Severity
    meaning: str
    expected: str
    hint: str
    subject: str = ""
    fix: str = ""
    plugin: str = ""


def catalogue_of(contributions: Contributions) -> Mapping[str, CodeEntry]:
    """Return what is known of every code, by code in order."""
    fixes = {code: fix.title for code, fix in contributions.fixes.items()}
    entries = [
        CodeEntry(code, about.severity, about.meaning, about.expected, about.hint, "", fixes.get(code, ""))
        for code, about in CODES.items()
    ]
    for each in contributions.constraints:
        brought = contributions.distribution_of("constraints", each)
        plugin = "" if brought == "mmrs-core" else brought
        fix, subject = fixes.get(each.code, ""), each.metaclass[1]
        entries.append(
            CodeEntry(each.code, each.severity, each.expected, each.expected, each.hint, subject, fix, plugin)
        )
    entries += [
        CodeEntry(
            each.name,
            Severity.ERROR,
            _plainly(each.title),
            _plainly(each.title),
            f"{each.hint or _ANY_VERDICT}; {_UNKNOWN}",
            "Behaviour",
        )
        for each in contributions.checks
    ]
    return {entry.code: entry for entry in sorted(entries, key=lambda entry: entry.code)}


def _plainly(title: str) -> str:
    return title[:1].lower() + title[1:].removesuffix(".")
