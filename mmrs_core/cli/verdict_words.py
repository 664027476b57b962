"""Verdicts as lines for operators."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from mmrs_core.cli.output import counted
from mmrs_core.contributions.checks import Check, Status, Verdict, is_at_limit, message_of
from mmrs_core.pictures.figures import quantity

_RANK = {Status.VIOLATED: 0, Status.UNKNOWN: 1, Status.NOT_CHECKED: 2, Status.SAFE: 3}

_MOST_ROBOTS = 3
_FOR_UNKNOWN = "give what is missing, or name the property in the mission's acceptedUnknowns"


def hint_of(verdict: Verdict, checks: Iterable[Check]) -> str:
    """Return how to fix a violation, or how to accept an unknown property."""
    if verdict.status is Status.UNKNOWN:
        return _FOR_UNKNOWN
    return next((check.hint for check in checks if check.name == verdict.property), "")


def verdict_line(verdict: Verdict) -> str:
    """Return a verdict as one line: property, status, message and margin.

    A message names move and area, and the line the robot; without one, the line names them all.
    """
    margin = _margin(verdict, "margin")
    reported = [message_of(verdict)] if verdict.message else [verdict.robot, verdict.move, verdict.area]
    found = ", ".join(filter(None, (verdict.status.value, *reported, margin)))
    return f"{verdict.property}: {found}{f'; {verdict.caveat}' if verdict.caveat else ''}"


def _margin(verdict: Verdict, name: str) -> str:
    """Return a margin in words; empty where there is none.

    A distance that is kept exactly is at its limit, and the part of the limit for position errors is named.
    """
    if verdict.margin is None:
        return ""
    if not is_at_limit(verdict):
        return f"{name} {quantity(verdict.margin, verdict.unit)}"
    errors = f"; {verdict.error:g} m of it is for position errors" if verdict.error else ""
    return f"at the limit{errors}"


def verdict_table(verdicts: Iterable[Verdict]) -> Iterator[str]:
    """Yield a line for each property, the least margin with it; in full what is not safe or has a caveat."""
    by_property = _by_property(verdicts)
    width = max((len(name) for name in by_property), default=0)
    for name, found in by_property.items():
        yield f"  {name:<{width}}  {_summary(found)}"
        yield from (
            f"    - {verdict_line(each)}" for each in found if each.status in _SPELT_OUT or each.caveat
        )


def verdict_rows(verdicts: Iterable[Verdict]) -> tuple[tuple[str, str], ...]:
    """Return what was found of each property: (property, words)."""
    return tuple((name, _summary(found)) for name, found in _by_property(verdicts).items())


def _by_property(verdicts: Iterable[Verdict]) -> dict[str, list[Verdict]]:
    by_property: dict[str, list[Verdict]] = {}
    for verdict in verdicts:
        by_property.setdefault(verdict.property, []).append(verdict)
    return by_property


def warnings(verdicts: Iterable[Verdict]) -> Iterator[str]:
    """Yield what was not checked and yet is known to fall short, robot by robot."""
    found = [each for each in verdicts if each.status is Status.NOT_CHECKED and each.caveat]
    yield from (f"  warning: {verdict_line(each)}" for each in found[:_MOST_ROBOTS])
    more = len(found) - _MOST_ROBOTS
    if more > 0:
        yield f"  and {counted(more, 'more warning')}: see mmrs check"


_SPELT_OUT = (Status.VIOLATED, Status.UNKNOWN)


def _reasons(found: Sequence[Verdict]) -> str:
    """Return the first reason with the robots that it holds for, and how many further reasons there are."""
    robots: dict[str, list[str]] = {}
    for each in found:
        robots.setdefault(each.message.removeprefix(f"{each.robot}: "), []).append(each.robot)
    reason, whose = next(iter(robots.items()))
    named = ", ".join(filter(None, whose[:_MOST_ROBOTS]))
    others = f" and {len(whose) - _MOST_ROBOTS} more" if len(whose) > _MOST_ROBOTS else ""
    more = f", and {len(robots) - 1} more" if len(robots) > 1 else ""
    return f"{reason or 'no reason given'}{f' ({named}{others})' if named else ''}{more}"


def _summary(found: Sequence[Verdict]) -> str:
    worst = min((each.status for each in found), key=_RANK.__getitem__)
    if worst is Status.NOT_CHECKED:
        reported = f"{worst.value}: {_reasons([each for each in found if each.status is worst])}"
        checked = [each for each in found if each.status is Status.SAFE]
        return f"{_summary(checked)}; {reported}" if checked else reported
    margins = [(each.margin, each) for each in found if each.margin is not None and each.status is worst]
    if not margins:
        return str(worst.value)
    _, least = min(margins, key=lambda pair: pair[0])
    who = f" ({least.robot}{f', near {least.area}' if least.area else ''})" if least.robot else ""
    return f"{worst.value}, {_margin(least, 'least margin')}{who}"
