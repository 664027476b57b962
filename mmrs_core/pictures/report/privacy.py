"""Keeps out of a report what concerns the machine and not the flight."""

from __future__ import annotations

import re

_PATH = re.compile(r"(?<![\w./:])(?:~|\.{1,2})?/[^\s/'\":]+/[^\s'\":]*")
_DRIVE = re.compile(r"\b[A-Za-z]:\\[^\s'\":]*")
_SECRET = re.compile(r"(?<!\w)[0-9a-fA-F]{32,}+(?!\w)|(?<![\w+/-])[A-Za-z0-9+/_-]{40,}+={0,2}")


def without_secrets(words: str) -> str:
    """Return words without folders of the machine, and without what looks like a key or token.

    >>> without_secrets("/home/ann/logs/a.jsonl: cannot be written")
    'a.jsonl: cannot be written'
    >>> without_secrets("key " + "0f" * 32)
    'key …'
    """
    for path in (_PATH, _DRIVE):
        words = path.sub(lambda found: re.split(r"[/\\]", found[0])[-1] or "…", words)
    return _SECRET.sub("…", words)
