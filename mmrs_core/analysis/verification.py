"""Every check on one behaviour, and which findings refuse it."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict


def verify(input: CheckInput, checks: Iterable[Check]) -> tuple[Verdict, ...]:
    """Return what every check finds, in the order of the checks.

    A check that finds nothing to say leaves a verdict NOT_CHECKED, so that no property is missing.
    """
    found: list[Verdict] = []
    for check in checks:
        verdicts = tuple(check.run(input))
        found.extend(verdicts or (_silent(check),))
    return tuple(found)


def refuses(verdicts: Iterable[Verdict], accepted_unknowns: Collection[str] = ()) -> tuple[Verdict, ...]:
    """Return the verdicts that forbid to carry out the behaviour.

    These are all violations, and what is unknown of properties that the mission does not accept by
    name. A violation is never accepted.
    """
    return tuple(
        verdict
        for verdict in verdicts
        if verdict.status is Status.VIOLATED
        or (verdict.status is Status.UNKNOWN and verdict.property not in accepted_unknowns)
    )


def _silent(check: Check) -> Verdict:
    return Verdict(check.name, Status.NOT_CHECKED, message="nothing in the behaviour has this property")
