"""The words in which the project speaks: docstrings, messages, pages and names keep to the glossary."""

from __future__ import annotations

import ast
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

AVOIDED = (
    r"\b(?:no|some|every|any)body(?:'s)?\b",
    r"\bmend(?:s|ed|ing)?\b",
    r"\b(?:un)?heed(?:s|ed|ing)?\b",
    r"\b(?:is|are|was|were|be|been|not) told\b",
    r"\b(?:hears?|heard)\b",
    r"\btells? (?:of|what|who|where|how|whether)\b",
    r"\bsays? (?:what|which|who|where|how|whether|of)\b",
    r"\bways? (?:back|out|in|home|down|up|to|from)\b",
    r"\b(?:its|their|no|straight|planned) ways?\b",
    r"\bunder way\b",
    r"\bby (?:it|them)sel(?:f|ves)\b",
    r"\bmay be repeated\b",
    r"\b(?:for ever|anew|afresh)\b",
    r"\b(?:in vain|on purpose|stands? against)\b",
    r"(?<!\bthere )\b(?:is|are) no (?!longer|more|such|faster)\w+\b",
    r"\bgo(?:es)? on\b",
    r"\bwhoever\b",
    r"\b(?:bears?|borne)\b",
    r"\b(?:kinds?|types?) of robots?\b",
    r"\btake (?:it|them|the \w+) away\b",
    r"\bso many (?:seconds|metres|degrees)\b",
    r"\bfor people\b",
    r"\bthe place\b",
    r"\bmotors (?:run|are o(?:n|ff))\b",
    r"\A(?-i:Have|Be|Know|Hear|Bear|Tell|Say|Do nothing)\b",
    r"\A(?-i:Of|To|By|Such as|As)\s",
    r"; else\b",
)
"""What another word says better: who acts, the field's term, the thing itself."""
SPOKEN = re.compile("|".join(AVOIDED), re.IGNORECASE | re.MULTILINE)

METAPHORS = re.compile(
    r"(?:^|_)(?:errands?|withdraw\w*|agendas?|wishes|berths?|refuges?|salvage\w*|helms?|habits?|unready|leaps?"
    r"|blam\w+|heed\w*|told|heard)(?:_|$)"
)
"""Words of names, in snake case, for which the field has terms of its own."""


def tracked(*endings: str) -> list[str]:
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [name for name in names.splitlines() if name.endswith(endings) and (ROOT / name).exists()]


def shipped() -> list[str]:
    folders = ("mmrs_core/", "runtime/", "plugins/", "studio/")
    return [name for name in tracked(".py") if name.startswith(folders) and "/tests/" not in name]


def sentences(path: str) -> Iterator[tuple[int, str]]:
    """Yield the line and text of each docstring, and of each other string that holds a space, of a module."""
    tree = ast.parse((ROOT / path).read_text("utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value.strip():
            yield node.lineno, re.sub(r"`[^`\n]+`", "", re.sub(r"^ +", "", node.value, flags=re.MULTILINE))


def paragraphs(path: str) -> Iterator[tuple[int, str]]:
    """Yield the line and text of each line of a page that is neither code nor quoted output."""
    code = False
    for number, line in enumerate((ROOT / path).read_text("utf-8").splitlines(), 1):
        if line.lstrip().startswith(("```", "~~~")):
            code = not code
        elif not code:
            yield number, re.sub(r"`[^`]*`", "", line.lstrip(" |>*-"))


def prose() -> Iterator[str]:
    """Yield the place of each avoided word of the project."""
    pages = [page for page in tracked(".md") if "tests/" not in page]
    for names, texts in ((shipped(), sentences), (pages, paragraphs)):
        for name in names:
            for line, text in texts(name):
                for found in SPOKEN.finditer(text):
                    yield f"{name}:{line + text[: found.start()].count(chr(10))}: {found[0]}"


def names() -> Iterator[str]:
    """Yield the place of each metaphor in the name of a module, a class or a function."""
    for name in shipped():
        nodes = ast.walk(ast.parse((ROOT / name).read_text("utf-8")))
        defined = [(x.lineno, x.name) for x in nodes if isinstance(x, ast.ClassDef | ast.FunctionDef)]
        for line, word in [(1, Path(name).stem), *defined]:
            if METAPHORS.search(re.sub(r"(?<=[a-z])(?=[A-Z])", "_", word).lower()):
                yield f"{name}:{line}: {word}"


@pytest.mark.parametrize("found", [prose, names])
def test_words_keep_to_the_glossary(found):
    assert not (places := sorted(found())), "\n".join(places)


if __name__ == "__main__":
    print(*sorted((*prose(), *names())), sep="\n")
