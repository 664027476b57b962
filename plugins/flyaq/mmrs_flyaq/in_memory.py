"""Models of a dialect as elements of ours, with a short list of what is not just as it was."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.languages.element import Element, container_of, descendants, is_kind, label_of
from mmrs_core.languages.importers import Imported
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.building.robot_types import RobotTypes
from mmrs_flyaq.findings import Category, Finding, Group, Record, grouped
from mmrs_flyaq.migrate import build, settle
from mmrs_flyaq.recognition import Recognised
from mmrs_flyaq.rules.rules_file import ROBOT_TYPE
from mmrs_flyaq.sources.nodes import SourceNode

MIGRATED, BY_NAMES, CHANGED, DOUBTFUL, NOTHING = "MIG003", "MIG004", "MIG005", "MIG006", "MIG007"
_DOUBTFUL = (Category.LOST, Category.DOUBTFUL)
_LONGEST_LIST = 1000
"""Characters of what one note names; the rest of it is counted."""


def migrated(
    files: Sequence[Recognised], name: str, registry: Registry, known: Iterable[Element], *, notes: bool
) -> tuple[Imported, ...]:
    """Return what files of a dialect became, in their order.

    Args:
        name: of the dialect.
        known: elements of other files, among which may be robot types that these files name.
        notes: whether to list changes; otherwise lost and doubtful values are counted.
    """
    mapping = files[0].mapping
    settled = [settle(each.opened, mapping, (), stored=each.stored) for each in files]
    types = {label_of(each): each for each in known if is_kind(each, *ROBOT_TYPE)}
    record = Record()
    made = build(settled, mapping, registry, RobotTypes(types, mapping.types, beside=True), record)
    found = []
    for file, document in zip(files, settled, strict=True):
        became = {id(each.node): each.element for each in made}
        roots = tuple(became[id(node)] for node in document.document.roots if id(node) in became)
        _tell_lines(roots)
        own = [each for each in record.findings if each.place.file == file.opened.file]
        lost = _words_by_place(node for node in document.document.roots if id(node) not in became)
        place = Place(file.opened.file, document.document.roots[0].line)
        faults = [*_of_file(file, place, name), *(_of_root(each) for each in own if _is_among(each, lost))]
        rest = [each for each in own if not _is_among(each, lost)]
        faults += _of_values(rest) if notes else _counted(rest, place)
        reported = (each for each in faults if notes or each.severity is not Severity.NOTE)
        found.append(Imported(roots, tuple(reported)))
    return tuple(found)


def _tell_lines(roots: Iterable[Element]) -> None:
    """Give elements that were made beside others the line of what they stand in."""
    for root in roots:
        for element in descendants(root):
            outer = container_of(element)
            if not element._mmrs_line and outer is not None:
                element._mmrs_line = outer._mmrs_line


def _of_file(file: Recognised, place: Place, name: str) -> Iterator[Diagnostic]:
    message = (
        f"{file.opened.what} of {name}, migrated while it was read; 'mmrs migrate' makes a project of it"
    )
    yield Diagnostic(MIGRATED, Severity.NOTE, message, place)
    for ns_uri in file.strange:
        message = f"{ns_uri}: no nsURI of {name}; taken for it, since its classes are called the same"
        yield Diagnostic(BY_NAMES, Severity.WARNING, message, place)


def _words_by_place(nodes: Iterable[SourceNode]) -> Mapping[Place, tuple[str, ...]]:
    """Return what roots are called, by where they stand: several may stand on one line."""
    found: dict[Place, dict[str, None]] = {}
    for node in nodes:
        found.setdefault(node.place(), {})[node.called()] = None
    return {place: tuple(words) for place, words in found.items()}


def _is_among(finding: Finding, lost: Mapping[Place, tuple[str, ...]]) -> bool:
    """Return whether a finding tells that a root became nothing."""
    return finding.category is Category.LOST and finding.subject.startswith(lost.get(finding.place, ()))


def _of_root(finding: Finding) -> Diagnostic:
    message = f"{finding.subject}: not carried over: {finding.reason}"
    return Diagnostic(NOTHING, Severity.ERROR, message, finding.place)


def _of_values(findings: Iterable[Finding]) -> Iterator[Diagnostic]:
    """Yield a fault for each reason."""
    for group in grouped(findings):
        is_doubtful = group.category in _DOUBTFUL
        code, severity = (DOUBTFUL, Severity.WARNING) if is_doubtful else (CHANGED, Severity.NOTE)
        first = group.findings[0].place
        message = f"{group.category.value}: {group.reason} ({_listed(group)})"
        yield Diagnostic(code, severity, message, Place(first.file, first.line))


def _counted(findings: Iterable[Finding], place: Place) -> Iterator[Diagnostic]:
    """Yield how many values were lost or are doubtful, if any are."""
    counts = Counter(finding.category for finding in findings)
    words = ", ".join(f"{each.value}: {counts[each]}" for each in _DOUBTFUL if counts[each])
    if words:
        message = f"values {words}; --quiet-migration hides the list"
        yield Diagnostic(DOUBTFUL, Severity.WARNING, message, place)


def _listed(group: Group) -> str:
    """Return what it happened to, the same thing once with all its lines."""
    lines: dict[str, list[int]] = {}
    for each in group.findings:
        lines.setdefault(each.subject, []).append(each.place.line)
    first = group.findings[0].place.line
    words, length = list[str](), 0
    for subject, found in lines.items():
        numbers = ", ".join(map(str, dict.fromkeys(found)))
        where = f"line{'s' * (len(found) > 1)} {numbers}"
        words.append(subject if numbers == str(first) else f"{subject}, {where}")
        length += len(words[-1])
        if length > _LONGEST_LIST:
            break
    rest = len(lines) - len(words)
    return "; ".join(words) + (f"; and {rest} more" if rest else "")
