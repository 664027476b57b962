"""Constraints on models beyond their metamodels."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mmrs_core.diagnostics import Severity

if TYPE_CHECKING:
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.modelset import ModelSet
    from mmrs_core.scene import Name


@dataclass(frozen=True, slots=True)
class Finding:
    """One breach of a constraint.

    Attributes:
        element: the culprit, whose place the diagnostic gets.
        message: lower case, no full stop, the culprit first.
        hint: how to fix it; empty: the constraint's own hint.
    """

    element: Element
    message: str
    hint: str = ""


@dataclass(frozen=True, slots=True)
class Constraint:
    """A rule that valid models keep.

    Attributes:
        code: two or more capitals and three digits, unique.
        title: what must hold, as a sentence for the documentation.
        metaclass: whose instances (subclasses included) it is checked on.
        check: the breaches by one such element in its models.
        hint: how to fix a breach.
        severity: of the diagnostics.
    """

    code: str
    title: str
    metaclass: Name
    check: Callable[[Element, ModelSet], Iterable[Finding]]
    hint: str
    severity: Severity = Severity.ERROR

    @property
    def expected(self) -> str:
        """What must hold, in the form of messages: the title without its capital and full stop."""
        return self.title[:1].lower() + self.title[1:].removesuffix(".")

    def also(self, *others: tuple[str, Name]) -> tuple[Constraint, ...]:
        """Return this constraint, and the same on other metaclasses, each with a code of its own."""
        return (self, *(replace(self, code=code, metaclass=metaclass) for code, metaclass in others))
