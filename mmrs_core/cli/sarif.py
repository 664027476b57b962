"""Diagnostics in SARIF 2.1.0, which editors and continuous integration show at their lines."""

from __future__ import annotations

import json
import os
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from mmrs_core.cli.output import say_json
from mmrs_core.cli.reports import STANDARD_OUTPUT
from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.errors import InvalidModelError
from mmrs_core.languages.writing import replace_file

if TYPE_CHECKING:
    from mmrs_core.analysis.fixes.repair import Proposal
    from mmrs_core.cli.catalogue import Entry
    from mmrs_core.cli.journey import Workshop
    from mmrs_core.contributions.checks import Verdict
    from mmrs_core.contributions.registry import Contributions

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "note"}
_ROOT = "PROJECTROOT"


def sarif_of(
    faults: Sequence[Diagnostic], entries: Mapping[str, Entry], proposals: Iterable[Proposal] = ()
) -> dict[str, object]:
    """Return a SARIF log of one run.

    Files are told relative to the folder that the command runs in, as far as they lie in it.

    Args:
        faults: all of them.
        entries: what is known of codes, by code.
        proposals: quick fixes of some of the faults.
    """
    codes = list(dict.fromkeys(fault.code for fault in faults))
    fixes: dict[Diagnostic, Proposal] = {each.fault: each for each in proposals}
    base = Path.cwd()
    driver = {
        "name": "mmrs",
        "semanticVersion": version("mmrs-core"),
        "rules": [_rule(code, entries.get(code)) for code in codes],
    }
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"uri": f"{base.as_uri()}/"}},
        "results": [_result(fault, codes.index(fault.code), base, fixes.get(fault)) for fault in faults],
    }
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _rule(code: str, entry: Entry | None) -> dict[str, object]:
    if entry is None:
        return {"id": code}
    return {
        "id": code,
        "shortDescription": {"text": entry.meaning},
        "help": {"text": f"expected: {entry.expected}\nhint: {entry.hint}"},
        "defaultConfiguration": {"level": _LEVELS[entry.severity]},
    }


def _result(fault: Diagnostic, index: int, base: Path, proposal: Proposal | None) -> dict[str, object]:
    words = [fault.message, fault.expected and f"expected: {fault.expected}"]
    words.append(fault.hint and f"hint: {fault.hint}")
    result: dict[str, object] = {
        "ruleId": fault.code,
        "ruleIndex": index,
        "level": _LEVELS[fault.severity],
        "message": {"text": "\n".join(filter(None, words))},
    }
    if location := _location(fault, base):
        result["locations"] = [location]
    if proposal is not None:
        result["fixes"] = [_fix(proposal, base)]
    return result


def _location(fault: Diagnostic, base: Path) -> dict[str, object]:
    place, location = fault.place, dict[str, object]()
    if place.file:
        physical: dict[str, object] = {"artifactLocation": _artifact(Path(place.file), base)}
        if place.line > 0:
            physical["region"] = {"startLine": place.line}
        location["physicalLocation"] = physical
    if place.path:
        location["logicalLocations"] = [{"fullyQualifiedName": place.path, "kind": "element"}]
    return location


def _artifact(file: Path, base: Path) -> dict[str, str]:
    """Return where a file lies: below the base, or anywhere."""
    relative = os.path.relpath(file.absolute(), base)
    if relative.startswith(os.pardir):
        return {"uri": file.absolute().as_uri()}
    return {"uri": quote(Path(relative).as_posix()), "uriBaseId": _ROOT}


def _fix(proposal: Proposal, base: Path) -> dict[str, object]:
    data = proposal.file.read_bytes()
    replacements = [
        {
            "deletedRegion": _region(data, edit.begin, edit.end),
            "insertedContent": {"text": edit.text},
        }
        for edit in sorted(proposal.edits)
    ]
    change = {
        "artifactLocation": _artifact(Path(proposal.fault.place.file), base),
        "replacements": replacements,
    }
    return {"description": {"text": proposal.title}, "artifactChanges": [change]}


def _region(data: bytes, begin: int, end: int) -> dict[str, int]:
    """Return lines and columns from 1; columns count characters, as ``columnKind`` says."""
    (first, left), (last, right) = _place(data, begin), _place(data, end)
    return {"startLine": first, "startColumn": left, "endLine": last, "endColumn": right}


def _place(data: bytes, offset: int) -> tuple[int, int]:
    start = data.rfind(b"\n", 0, offset) + 1
    return data.count(b"\n", 0, offset) + 1, len(data[start:offset].decode("utf-8", "replace")) + 1


def as_faults(verdicts: Iterable[Verdict], against: Container[Verdict]) -> tuple[Diagnostic, ...]:
    """Return what stands against a behaviour, and what is not known of it, as faults.

    Args:
        verdicts: all of them.
        against: those that make the behaviour unsafe.
    """
    from mmrs_core.cli.verdict_words import verdict_line

    told = (each for each in verdicts if each in against or each.status.value == "unknown")
    return tuple(
        Diagnostic(
            each.property,
            Severity.ERROR if each in against else Severity.NOTE,
            verdict_line(each),
            each.place,
        )
        for each in told
    )


@contextmanager
def refusals_in(file: Path | None, workshop: Workshop) -> Iterator[None]:
    """Write the faults of a model that is refused inside into a SARIF file, too."""
    try:
        yield
    except InvalidModelError as error:
        if file is not None:
            write_sarif(file, error.diagnostics, workshop.contributions)
        raise


def write_sarif(
    file: Path,
    faults: Sequence[Diagnostic],
    contributions: Contributions,
    proposals: Iterable[Proposal] = (),
) -> None:
    """Write a SARIF log to a file, or to standard output for ``-``.

    Raises:
        OSError: if the file cannot be written.
    """
    from mmrs_core.cli.catalogue import catalogue_of

    log = sarif_of(faults, catalogue_of(contributions), proposals)
    if file == STANDARD_OUTPUT:
        say_json(log)
    else:
        replace_file(file, (json.dumps(log, ensure_ascii=False, indent=2) + "\n").encode())
