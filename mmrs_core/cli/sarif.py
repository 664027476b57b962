"""Diagnostics in SARIF 2.1.0, which editors and continuous integration show at their lines."""

from __future__ import annotations

import json
import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.catalogue import CodeEntry, catalogue_of
from mmrs_core.cli.output import say_json
from mmrs_core.cli.sarif_places import ROOT, Places
from mmrs_core.cli.verdict_words import hint_of, verdict_line
from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.languages.codes import refusal
from mmrs_core.languages.writing import replace_file

if TYPE_CHECKING:
    from mmrs_core.analysis.fixes.repair import Proposal
    from mmrs_core.cli.session import Session
    from mmrs_core.contributions.checks import Check, Verdict
    from mmrs_core.contributions.registry import Contributions

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "note"}
_PROBLEMS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "recommendation"}
_HASH = "primaryLocationLineHash"


def sarif_of(
    faults: Sequence[Diagnostic],
    entries: Mapping[str, CodeEntry],
    proposals: Iterable[Proposal] = (),
    subject: str = "",
) -> dict[str, object]:
    """Return a SARIF log of one run.

    Files are relative to the folder that the command runs in, as far as they lie in it.

    Args:
        faults: all of them.
        entries: descriptions of codes, by code.
        proposals: quick fixes of some of the faults.
        subject: what was examined and how, such as ``validate/field``, so that runs on other subjects stand
            next to this one and do not replace it.
    """
    codes = list(dict.fromkeys(fault.code for fault in faults))
    fixes: dict[Diagnostic, Proposal] = {each.fault: each for each in proposals}
    places = Places(Path.cwd())
    driver = {
        "name": "mmrs",
        "semanticVersion": version("mmrs-core"),
        "rules": [_rule(code, entries.get(code)) for code in codes],
    }
    run = {
        "tool": {"driver": driver},
        **({"automationDetails": {"id": f"mmrs/{subject}/"}} if subject else {}),
        "columnKind": "utf16CodeUnits",
        "originalUriBaseIds": {ROOT: {"uri": f"{places.base.as_uri()}/"}},
        "results": [_result(fault, codes.index(fault.code), places, fixes.get(fault)) for fault in faults],
    }
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _rule(code: str, entry: CodeEntry | None) -> dict[str, object]:
    if entry is None:
        return {"id": code}
    reported = {"Expected": entry.expected, "Mend": entry.hint}
    if entry.fix:
        reported["Quick fix"] = f"mmrs validate --fix: {entry.fix}"
    return {
        "id": code,
        "shortDescription": {"text": entry.meaning},
        "fullDescription": {"text": f"{entry.meaning}; expected: {entry.expected}"},
        "help": {
            "text": "\n".join(f"{name}: {words}" for name, words in reported.items()),
            "markdown": "\n".join(f"- **{name}**: {_escaped(words)}" for name, words in reported.items()),
        },
        "defaultConfiguration": {"level": _LEVELS[entry.severity]},
        "properties": {
            "tags": [entry.plugin or "mmrs-core", *([entry.subject] if entry.subject else [])],
            "problem.severity": _PROBLEMS[entry.severity],
        },
    }


def _escaped(words: str) -> str:
    return re.sub(r"([\\`*_\[\]<>#|])", r"\\\1", words)


def _result(fault: Diagnostic, index: int, places: Places, proposal: Proposal | None) -> dict[str, object]:
    words = [fault.message, fault.expected and f"expected: {fault.expected}"]
    words.append(fault.hint and f"hint: {fault.hint}")
    result: dict[str, object] = {
        "ruleId": fault.code,
        "ruleIndex": index,
        "level": _LEVELS[fault.severity],
        "message": {"text": "\n".join(filter(None, words))},
    }
    if location := places.location(fault):
        result["locations"] = [location]
    if mark := places.fingerprint(fault):
        result["partialFingerprints"] = {_HASH: mark}
    if proposal is not None:
        result["fixes"] = [places.fix(proposal)]
    return result


def as_faults(
    verdicts: Iterable[Verdict], against: Container[Verdict], checks: Iterable[Check] = ()
) -> tuple[Diagnostic, ...]:
    """Return a behaviour's violations and unknowns as diagnostics.

    Args:
        verdicts: all of them.
        against: those that make the behaviour unsafe.
        checks: with the fix of each.
    """
    known = tuple(checks)
    reported = (each for each in verdicts if each in against or each.status.value == "unknown")
    return tuple(
        Diagnostic(
            each.property,
            Severity.ERROR if each in against else Severity.NOTE,
            verdict_line(each),
            each.place,
            hint_of(each, known),
        )
        for each in reported
    )


@contextmanager
def refusals_in(file: Path | None, session: Session, subject: str) -> Iterator[None]:
    """Write the faults of a model that is refused inside into a SARIF file, too."""
    try:
        yield
    except (InvalidModelError, UnreadableError) as error:
        if file is not None:
            faults = refusal(error) if isinstance(error, UnreadableError) else error.diagnostics
            write_sarif(file, faults, session.contributions, subject=subject)
        raise


def subject_of(command: str, file: Path) -> str:
    """Return a command's subject, which distinguishes runs: its path, if it lies below this folder.

    >>> subject_of("check", Path("field/behaviour.xmi"))
    'check/field/behaviour.xmi'
    """
    whole = file.absolute()
    relative = whole.relative_to(Path.cwd()) if whole.is_relative_to(Path.cwd()) else Path(whole.name)
    return "/".join((command, *relative.parts))


def write_sarif(
    file: Path,
    faults: Sequence[Diagnostic],
    contributions: Contributions,
    proposals: Iterable[Proposal] = (),
    *,
    subject: str,
) -> None:
    """Write a SARIF log to a file, or to standard output for ``-``; the rest as for `sarif_of`.

    Raises:
        OSError: if the file cannot be written.
    """
    log = sarif_of(faults, catalogue_of(contributions), proposals, subject)
    if file == STANDARD_OUTPUT:
        say_json(log)
    else:
        replace_file(file, (json.dumps(log, ensure_ascii=False, indent=2) + "\n").encode())


STANDARD_OUTPUT = Path("-")

Sarif = Annotated[
    Path | None,
    typer.Option("--sarif", metavar="FILE", help="Write diagnostics as SARIF 2.1.0 (- for stdout)."),
]


def refuse_two_outputs(sarif: Path | None, other: bool) -> None:
    """Refuse SARIF together with something else as the whole of standard output.

    Raises:
        typer.BadParameter: if they are.
    """
    if sarif == STANDARD_OUTPUT and other:
        raise typer.BadParameter("--sarif - is the whole of standard output; name a file instead")
