"""What targets can express, as ``mmrs-gen --capabilities`` prints it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.tables import table
from mmrs_core.pipeline import capabilities

if TYPE_CHECKING:
    from mmrs_core.cli.session import Session
    from mmrs_core.generation.capabilities.judging import Capability

WIDEST = 96


def print_capabilities(session: Session, target: str | None, json: bool) -> int:
    """Print what a target can express, or every target where None is named; return the exit code.

    Raises:
        UsageError: there is no such target.
    """
    contributions = session.contributions
    tables = session.stage("capabilities", "trying", lambda: capabilities(target, contributions))
    if json:
        say_json({"targets": {name: [_row(each) for each in rows] for name, rows in tables.items()}})
        return 0
    for name, rows in tables.items():
        say(f"{name}: {contributions.targets[name].description}")
        for line in table(("what", "", "how, or why not"), list(_cells(rows)), widest=WIDEST):
            say(line)
    return 0


def policy_lines(rows: Iterable[Capability]) -> Iterator[tuple[str, str, str]]:
    """Yield policies in few lines: what, verdict, responses; those together that fare alike."""
    responses: dict[tuple[str, str, str], list[str]] = {}
    for row in rows:
        event, _, response = row.element.partition(": ")
        responses.setdefault((row.group, event, row.verdict), []).append(response)
    events: dict[tuple[str, str, str], list[str]] = {}
    for (group, event, verdict), some in responses.items():
        events.setdefault((group, verdict, ", ".join(some)), []).append(event)
    count = len({event for _, event, _ in responses})
    for (group, verdict, words), names in events.items():
        yield f"{group}: {'any fault' if len(names) == count else ', '.join(names)}", verdict, words


def _cells(rows: Sequence[Capability]) -> Iterator[tuple[str, str, str]]:
    policies = [row for row in rows if is_policy(row)]
    for row in rows:
        if not is_policy(row):
            yield row.element, row.verdict, row.how
    yield from policy_lines(policies)


def is_policy(row: Capability) -> bool:
    """Return whether a row is about a policy of a robot."""
    return row.group.startswith("policy")


def _row(row: Capability) -> dict[str, str]:
    return {"group": row.group, "element": row.element, "verdict": row.verdict, "how": row.how}
