"""The words in which the project speaks: docstrings, messages, pages and names keep to the glossary."""

import ast
import re
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

AVOIDED = re.compile(
    r"\b(?:(?:no|some|every|any)body(?:'s)?"
    r"|mend(?:s|ed|ing)?"
    r"|(?:un)?heed(?:s|ed|ing)?"
    r"|(?:is|are|was|were|be|been|not) told"
    r"|(?:hears?|heard)"
    r"|tells? (?:of|what|who|where|how|whether)"
    r"|says? (?:what|which|who|where|how|whether|of)"
    r"|ways? (?:back|out|in|home|down|up|to|from)"
    r"|(?:its|their|no|straight|planned) ways?"
    r"|under way"
    r"|by (?:it|them)sel(?:f|ves)"
    r"|may be repeated"
    r"|(?:for ever|anew|afresh)"
    r"|(?:in vain|on purpose|stands? against)"
    r"|(?<!\bthere )(?:is|are) no (?!longer|more|such|faster)\w+"
    r"|go(?:es)? on"
    r"|whoever"
    r"|(?:bears?|borne)"
    r"|(?:kinds?|types?) of robots?"
    r"|take (?:it|them|the \w+) away"
    r"|so many (?:seconds|metres|degrees)"
    r"|for people"
    r"|the place"
    r"|motors (?:run|are o(?:n|ff)))\b"
    r"|; else\b"
)
"""What another word says better, in lower case: who acts, the field's term, the thing itself."""
OPENINGS = re.compile(r"(?:Have|Be|Know|Hear|Bear|Tell|Say|Do nothing)\b|(?:Of|To|By|Such as|As)\s")
"""What no text begins with."""

METAPHORS = re.compile(
    r"(?:^|_)(?:errands?|withdraw\w*|agendas?|wishes|berths?|refuges?|salvage\w*|helms?|habits?|unready|leaps?"
    r"|blam\w+|heed\w*|told|heard)(?:_|$)"
)
"""Words of names, in snake case, for which the field has terms of its own."""


DEFINITIONS = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
SPOKEN = {
    ".ecore": r'key="documentation" value="([^"]*)"',
    ".jinja": r"^ *(?:#|//|--|\*) ([^\n]*)$",
    ".j2": r">([^<>{}]+)<",
}
"""Where files that are neither modules nor pages speak, by their endings."""


def tracked(*endings: str) -> list[str]:
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [name for name in names.splitlines() if name.endswith(endings) and (ROOT / name).exists()]


def shipped() -> list[str]:
    folders = ("mmrs_core/", "runtime/", "plugins/", "studio/")
    return [name for name in tracked(".py") if name.startswith(folders) and "/tests/" not in name]


@cache
def texts_and_names(path: str) -> tuple[list[tuple[int, str]], list[tuple[int, str]]]:
    """Return the line and text of each string that holds a space, and of each name that a module defines."""
    texts, defined = [], [(1, Path(path).stem)]
    for node in ast.walk(ast.parse((ROOT / path).read_text("utf-8"))):
        if isinstance(node, ast.Constant):
            if isinstance(node.value, str) and " " in node.value.strip():
                texts.append((node.lineno, node.value))
        elif isinstance(node, DEFINITIONS):
            defined.append((node.lineno, node.name))
        elif isinstance(node, ast.arg):
            defined.append((node.lineno, node.arg))
    return texts, defined


def sentences(path: str) -> Iterator[tuple[int, str]]:
    """Yield the line and text of each docstring, and of each other string that holds a space, of a module."""
    for line, text in texts_and_names(path)[0]:
        yield line, re.sub(r"`[^`\n]+`", "", re.sub(r"^ +", "", text, flags=re.MULTILINE))


def paragraphs(path: str) -> Iterator[tuple[int, str]]:
    """Yield the line and text of each line of a page that is neither code nor quoted output."""
    code = False
    for number, line in enumerate((ROOT / path).read_text("utf-8").splitlines(), 1):
        if line.lstrip().startswith(("```", "~~~")):
            code = not code
        elif not code:
            yield number, re.sub(r"`[^`]*`", "", line.lstrip(" |>*-"))


def said(path: str) -> Iterator[tuple[int, str]]:
    """Yield the line and text of each description of a metamodel, and of each comment of a template."""
    text = (ROOT / path).read_text("utf-8")
    for found in re.finditer(SPOKEN[Path(path).suffix], text, re.DOTALL | re.MULTILINE):
        yield text[: found.start()].count("\n") + 1, found[1]


def prose() -> Iterator[str]:
    """Yield the place of each avoided word of the project."""
    pages = [page for page in tracked(".md") if "tests/" not in page]
    others = [name for name in tracked(*SPOKEN) if "tests/" not in name]
    for names, texts in ((shipped(), sentences), (pages, paragraphs), (others, said)):
        for name in names:
            for line, text in texts(name):
                for found in (OPENINGS.match(text), *AVOIDED.finditer(text.lower())):
                    if found:
                        yield f"{name}:{line + text[: found.start()].count(chr(10))}: {found[0]}"


def names() -> Iterator[str]:
    """Yield the place of each metaphor in the name of a module, a class, a function or a parameter."""
    for name in shipped():
        for line, word in texts_and_names(name)[1]:
            if METAPHORS.search(re.sub(r"(?<=[a-z])(?=[A-Z])", "_", word).lower()):
                yield f"{name}:{line}: {word}"


@pytest.mark.parametrize("found", [prose, names])
def test_words_keep_to_the_glossary(found):
    assert not (places := sorted(found())), "\n".join(places)


if __name__ == "__main__":
    print(*sorted((*prose(), *names())), sep="\n")
