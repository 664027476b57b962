"""How names of a metamodel become names of Python, and which known name a misspelt one is nearest to."""

from __future__ import annotations

import keyword
import re
import unicodedata
from collections.abc import Collection, Iterable
from difflib import get_close_matches

_FOREIGN = re.compile(r"\W")
_TURNS = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""What changes the direction of the text around it (Unicode 15.1, annex 9), so that messages lie."""
_NEVER_IN_NAMES = frozenset(("Cc", "Cs", "Zl", "Zp"))
"""General categories: controls, which tabs and line breaks are, and what separates lines."""
_UNSEEN = frozenset(("Cc", "Cf", "Cs", "Zl", "Zp", "Zs"))


def python_name(name: str, taken: Collection[str] = ()) -> str:
    """Return the attribute under which a feature of that name is reached.

    Keywords get a trailing underscore, and so do names that Python or this package keeps for itself, and
    keywords with underscores behind them: two features of one class may be called ``from`` and ``from_``,
    declared where neither knows of the other.
    What no identifier may hold becomes an underscore; a name already taken gets underscores until it is free.

    >>> python_name("from"), python_name("from_"), python_name("__init__"), python_name("2nd-pass")
    ('from_', 'from__', '_init___', '_2nd_pass')
    """
    result = _FOREIGN.sub("_", name) or "_"
    if result[0].isdigit():
        result = f"_{result}"
    if result.startswith("__") or result.startswith("_mmrs_"):
        result = f"_{result.lstrip('_')}_"
    if keyword.iskeyword(result.rstrip("_")):
        result += "_"
    while result in taken:
        result += "_"
    return result


def nearest(name: str, known: Iterable[str]) -> str:
    """Return a hint that names the known word most like the given one, or an empty text."""
    choices = sorted(set(known))
    folded = {choice.casefold(): choice for choice in choices}
    found = get_close_matches(name.casefold(), folded, n=1, cutoff=0.6)
    return f"did you mean {folded[found[0]]}?" if found else ""


def typo_of(name: str, known: Iterable[str]) -> str:
    """Return a hint that names the known word at most two letters away, or an empty text."""
    return next((f"did you mean {each}?" for each in sorted(set(known)) if _within_two_edits(name, each)), "")


def _within_two_edits(one: str, other: str) -> bool:
    """Return whether two letters put in, left out or exchanged make one text the other."""
    if abs(len(one) - len(other)) > 2:
        return False
    row = list(range(len(other) + 1))
    for index, letter in enumerate(one, 1):
        above, row = row, [index]
        for place, wanted in enumerate(other):
            row.append(min(above[place] + (letter != wanted), above[place + 1] + 1, row[-1] + 1))
    return row[-1] <= 2


def unreadable(name: str) -> str:
    r"""Return what people could not read a name by, in words; empty for a good name.

    Letters and marks of any script are good, with the joiners that Persian, Indic scripts and emoji need.
    Names that are good make good names when they are put together.

    >>> unreadable("پایگاه\N{ZERO WIDTH NON-JOINER}ها"), unreadable("a\tb"), unreadable(" ")
    ('', 'holds the character U+0009', 'is blank')
    """
    bad = next((c for c in name if c in _TURNS or unicodedata.category(c) in _NEVER_IN_NAMES), None)
    if bad is not None:
        return f"holds the character U+{ord(bad):04X}"
    blank = all(unicodedata.category(each) in _UNSEEN for each in name)
    return "is blank" if blank else ""
