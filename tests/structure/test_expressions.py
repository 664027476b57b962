"""No regular expression of ours takes more than linear time, whatever it is given."""

import ast
import importlib
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.structure.backtracking import superlinear

ROOT = Path(__file__).parents[2]
_METHODS = {"match", "fullmatch", "search", "sub", "subn", "split", "findall", "finditer", "scanner"}

_BOUNDED = {"mmrs_mavlink.commands.rehearsal._PATTERN", "mmrs_core.projects.positions._PAIRS"}
"""Expressions whose text is refused beforehand where it is long."""


def _sources() -> Iterator[tuple[str, Path]]:
    for folder in (ROOT, ROOT / "runtime", *sorted((ROOT / "plugins").iterdir())):
        for package in sorted(folder.glob("mmrs_*")):
            for path in sorted(package.rglob("*.py")):
                if re.search(r"^(import re$|from re )", path.read_text("utf-8"), re.MULTILINE):
                    yield ".".join(path.relative_to(folder).with_suffix("").parts), path


def _uses() -> dict[str, set[str]]:
    """Return by which methods the names of compiled expressions are used, wherever that is."""
    found: dict[str, set[str]] = defaultdict(set)
    for folder in (ROOT / "mmrs_core", ROOT / "runtime", ROOT / "plugins"):
        for path in folder.rglob("*.py"):
            text = path.read_text("utf-8")
            for name, method in re.findall(r"\b(_?[A-Z][A-Z_]*)(?:\[[^\]]*\])?\.([a-z]+)\b", text):
                if method in _METHODS:
                    found[f"{path}:{name}"].add(method)
                    found[name].add(method)
            for _, name, method in re.findall(r"\bfor (\w+) in (_[A-Z_]+).*\b\1\.([a-z]+)\(", text):
                found[name].add(method)
                found[f"{path}:{name}"].add(method)
    return found


def _literal(node: ast.expr) -> str | None:
    """Return an expression's text, with a letter for what is put into it as it runs."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(each.value if isinstance(each, ast.Constant) else "x" for each in node.values)  # type: ignore[misc]
    return None


def _calls(tree: ast.Module) -> Iterator[tuple[ast.Call, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            owner = node.func.value
            if isinstance(owner, ast.Name) and owner.id == "re" and node.func.attr in _METHODS:
                yield node, node.func.attr


def _expressions() -> Iterator[tuple[str, re.Pattern[Any], set[str]]]:
    uses = _uses()
    for module, path in _sources():
        for name, value in vars(importlib.import_module(module)).items():
            if name.startswith("__"):
                continue
            local = uses.get(f"{path}:{name}")
            found = (
                value.values()
                if isinstance(value, dict)
                else value
                if isinstance(value, list | tuple)
                else [value]
            )
            for each in found:
                if isinstance(each, re.Pattern):
                    yield f"{module}.{name}", each, local or uses.get(name) or {"search"}
        for call, method in _calls(ast.parse(path.read_text("utf-8"))):
            text = _literal(call.args[0])
            if text is not None:
                yield f"{module}:{call.lineno}", re.compile(text), {method}


def test_expressions_take_linear_time():
    judged = 0
    slow = []
    for name, pattern, methods in _expressions():
        judged += 1
        searched = not methods <= {"match", "fullmatch"}
        found = superlinear(pattern, searched=searched, whole=methods == {"fullmatch"})
        if found and name not in _BOUNDED:
            slow.append(f"{name}: {pattern.pattern!r} ({', '.join(sorted(methods))}): {found}")
    assert judged > 100
    assert not slow, "\n".join(slow)


@pytest.mark.parametrize(
    ("expression", "searched", "whole"),
    [
        (r"\d+\.?\d*", False, True),
        (r"(a*)*b", False, False),
        (r"(a|a)*b", False, False),
        (r"a*a*b", False, False),
        (r"(?:a?b?)*c", False, False),
        (r"a++b", True, False),
        (r"\s+$", True, False),
        (r"(ab)*(a|b)*c", False, True),
        (r"(?:a(?=a*b))*c", False, False),
        (r"(?i)Aa*a*b", False, True),
    ],
)
def test_ambiguous_loops_are_found(expression, searched, whole):
    assert superlinear(re.compile(expression), searched=searched, whole=whole)


@pytest.mark.parametrize(
    ("expression", "searched", "whole"),
    [
        (r"\d+(?:\.\d*)?", False, True),
        (r"a+", True, False),
        (r"(?<!a)a++b", True, False),
        (r"(?:[^\"\\]++|\\.)*+\"", False, False),
        (r"(?:[A-Z]+\.)*[A-Z]+", False, True),
        (r"(?:ab?)*c", False, False),
    ],
)
def test_loops_with_one_reading_are_not_accused(expression, searched, whole):
    assert not superlinear(re.compile(expression), searched=searched, whole=whole)
