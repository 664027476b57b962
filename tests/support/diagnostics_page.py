"""The page of the documentation that lists every diagnostic."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

from mmrs_core.cli.catalogue import CodeEntry

_CHAPTERS = {
    "XMI": "Reading files",
    "ECO": "Metamodels",
    "MIG": "Versions of languages",
    "FIL": "Files",
    "PRJ": "Projects",
    "MML": "Missions",
    "CTX": "Contexts",
    "RL": "Robot types",
    "BL": "Behaviours",
    "GND": "Places on the ground",
    "LOG": "Logs",
}
_PREFACE = """\
# Diagnostics

All diagnostics of models, by code. `mmrs validate` checks missions, contexts and robot types,
`mmrs check` behaviours; both report every problem with its file, line and element, with the expectation, and
with a hint. Errors stop a mission, warnings do not. `--json` and `--sarif FILE` write the same for programs;
`mmrs validate --fix` fixes problems with one right answer, and shows each change first. Plug-ins add
constraints and fixes of their own.

This page is generated: each message is what the failing example gives. Examples show the parts in which a
model that fails differs from one that passes.
"""


@dataclass(frozen=True, slots=True)
class Example:
    """A model with a fault, and one like it without.

    Attributes:
        message: what is said of the one that fails.
        failing, passing: what each has that the other has not; empty where it has nothing.
        language: of the two, for highlighting.
    """

    message: str
    failing: str
    passing: str
    language: str = "xml"


def page_of(entries: Iterable[CodeEntry], examples: Mapping[str, Example]) -> str:
    """Return the page in Markdown: chapters in their order, then plug-ins', then properties of verdicts."""
    ordered = sorted(entries, key=_place)
    chapters = (
        f"## {title}\n\n" + "\n".join(_entry(each, examples.get(each.code)) for each in group)
        for title, group in groupby(ordered, key=_chapter)
    )
    return "\n".join((_PREFACE, *chapters))


def _place(entry: CodeEntry) -> tuple[int, str, int, str]:
    prefix = _prefix(entry)
    if not prefix:
        return 2, "", 0, entry.code
    known = list(_CHAPTERS)
    return (0, "", known.index(prefix), entry.code) if prefix in known else (1, entry.plugin, 0, entry.code)


def _prefix(entry: CodeEntry) -> str:
    """Return the capitals that a code begins with; none for a property of verdicts."""
    return entry.code.rstrip("0123456789") if entry.code[-1].isdigit() else ""


def _chapter(entry: CodeEntry) -> str:
    prefix = _prefix(entry)
    if not prefix:
        return "What is known of a behaviour"
    return _CHAPTERS.get(prefix) or f"Plug-in {entry.plugin}"


def _entry(entry: CodeEntry, example: Example | None) -> str:
    about = ", ".join(filter(None, (entry.subject, entry.severity.value)))
    lines = [f"### {entry.code}", "", f"{entry.meaning[:1].upper()}{entry.meaning[1:]}. ({about})", ""]
    if entry.expected != entry.meaning:
        lines += [f"- Expected: {entry.expected}"]
    lines += [f"- Fix: {entry.hint}"]
    lines += [f"- Quick fix: {entry.fix}"] if entry.fix else []
    return "\n".join((*lines, "", *(_shown(example) if example is not None else ())))


def _shown(example: Example) -> Iterator[str]:
    yield from (f"Fails, with *{_plain(example.message)}*:", "") if example.message else ("Fails:", "")
    yield from _block(example.failing, example.language)
    yield from ("Passes:", "")
    yield from _block(example.passing, example.language)


def _plain(words: str) -> str:
    return words.replace("*", "\\*").replace("_", "\\_").replace("<", "&lt;")


def _block(text: str, language: str) -> Iterator[str]:
    yield from (f"```{language}", text, "```", "")
