"""How a text refers to elements: by addresses, as Eclipse writes them, and by names.

An address holds a ``#`` or begins with ``/``. All else is an identifier of the file, or a name. A name that
looks like an address is quoted: ``'/gate'``, with each quote in it doubled. In a list, which is divided by
blanks, a name that holds blanks is quoted as well.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

_BLANK = " \t\n\r\f"
"""What stands between references; others may stand in an identifier."""
_BLANKS = re.compile(f"[{_BLANK}]+")
_QUOTED = re.compile(r"'[^']*(?:''[^']*)*'")
_QUOTED_WORD = re.compile(rf"{_QUOTED.pattern}(?=[{_BLANK}]|\Z)")
_WORD = re.compile(f"[^{_BLANK}]+")


class Name(str):
    """The name of an element, as opposed to an address.

    Attributes:
        said: how the text says it; it may be an identifier nevertheless.
    """

    said: str

    def __new__(cls, name: str, said: str) -> Name:
        """Take the name and how the text says it."""
        made = super().__new__(cls, name)
        made.said = said
        return made


def is_address(text: str) -> bool:
    """Return whether a text is read as a path, a file and a path, or an identifier behind a ``#``."""
    return text.startswith("/") or "#" in text


def as_address(text: str) -> str:
    """Return the text of a link, which is never a name, so that it is read as an address."""
    return text if is_address(text) else f"#{text}"


def references_in(text: str, many: bool) -> Iterator[str]:
    """Yield the references in a text, without the types that may stand before those to other files.

    >>> list(references_in("//@tasks.0 //@tasks.1", many=True))
    ['//@tasks.0', '//@tasks.1']
    >>> list(references_in("north meadow", many=False))
    ['north meadow']
    >>> list(references_in("port 'star board' 'it''s'", many=True))
    ['port', 'star board', "it's"]
    """
    yield from _several(text) if many else _one(text.strip(_BLANK))


def _one(text: str) -> Iterator[str]:
    """Yield what one reference is: an address, or else a name as it stands."""
    if text.startswith("'") and _QUOTED.fullmatch(text):
        yield _unquoted(text)
        return
    words = _BLANKS.split(text)
    found = list(_without_types(words))
    if len(words) > 2 or len(found) > 1:
        several = text.startswith(("/", "#"))  # as many as are refused
        yield from words if several else (Name(text, text),)
    elif text:
        yield found[0]


def _several(text: str) -> Iterator[str]:
    words = _words(text) if "'" in text else filter(None, _BLANKS.split(text))
    for word in _without_types(list(words)):
        yield _unquoted(word) if _QUOTED.fullmatch(word) else word


def _words(text: str) -> Iterator[str]:
    """Yield what blanks divide, but for those inside quotes."""
    found = _WORD.search(text)
    while found is not None:
        word = _QUOTED_WORD.match(text, found.start()) or found
        yield word.group()
        found = _WORD.search(text, word.end())


def _without_types(words: list[str]) -> Iterator[str]:
    for index, word in enumerate(words):
        if index + 1 == len(words) or not is_type(word, words[index + 1]):
            yield word


def is_type(word: str, following: str) -> bool:
    """Return whether a word states the class of the element that the address behind it leads to."""
    leads = "#" in following and not following.startswith("'")
    return leads and ":" in word and "#" not in word and not word.startswith(("/", "'"))


def one_of_many(text: str) -> str:
    """Return a reference that stands alone as it is written among others.

    >>> one_of_many("north meadow"), one_of_many("//@tasks.0")
    ("'north meadow'", '//@tasks.0')
    """
    if text.startswith("/"):
        return text
    found = references_in(text, many=False)
    return " ".join(quoted(each) if isinstance(each, Name) else each for each in found)


def spelt(name: str, many: bool) -> str:
    """Return a name as a reference, alone or in a list."""
    plain = name and not is_address(name) and not name.startswith("'") and name == name.strip(_BLANK)
    if many and (":" in name or _BLANKS.search(name)):
        plain = False
    return name if plain else quoted(name)


def quoted(name: str) -> str:
    """Return a name in quotes, which is never read as anything else."""
    return "'" + name.replace("'", "''") + "'"


def _unquoted(text: str) -> Name:
    return Name(text[1:-1].replace("''", "'"), text)
