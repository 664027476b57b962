"""Whether matching a regular expression can take more than linear time, decided from its structure.

A backtracking matcher takes more than linear time on some text exactly where the expression, seen as a finite
automaton, can read one text in arbitrarily many ways: where two states q and p exist, and a word that leads
from q to q, from q to p, and from p to p (Weber and Seidl, "On the degree of ambiguity of finite automata",
1991). Where an expression is searched for, the positions where a match may begin are one more loop.
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from re import _constants as codes  # type: ignore[attr-defined]
from re import _parser as parser  # type: ignore[attr-defined]
from typing import Any, TypeAlias

Characters: TypeAlias = frozenset[str]

_SAMPLES = "".join(map(chr, range(128))) + "\x85\xa0\xb2ßé\u0130\u0661\u2003\u2028\ud800\uffff\U0001f600"
"""Characters that represent all that the categories tell apart; each expression adds those that it names."""
_MOST_COPIES = 64
"""Copies of what is repeated a bounded number of times; a larger bound counts as none."""
_END = ""
"""What comes after the last character, and before the first."""


@dataclass(slots=True)
class _Automaton:
    """States, and what may be read between them.

    Attributes:
        silent: for each state, the states that follow without a character, each with what the character
            before and the one behind must be.
        read: for each state that reads one, the character that it reads.
    """

    alphabet: Characters
    silent: dict[int, list[tuple[int, Characters, Characters]]] = field(
        default_factory=lambda: defaultdict(list)
    )
    read: dict[int, Characters] = field(default_factory=dict)
    size: int = 0

    def state(self) -> int:
        self.size += 1
        return self.size - 1

    def join(
        self, one: int, other: int, before: Characters | None = None, behind: Characters | None = None
    ) -> None:
        anything = self.alphabet | {_END}
        self.silent[one].append(
            (other, anything if before is None else before, anything if behind is None else behind)
        )


def superlinear(pattern: re.Pattern[Any], *, searched: bool, whole: bool) -> str:
    """Return why matching can take more than linear time; nothing where it cannot.

    Args:
        pattern: of characters or bytes.
        searched: whether a match may begin anywhere, as for `search`, `sub`, `split`, and `findall`.
        whole: whether a match must reach the end, as for `fullmatch`.
    """
    tree = parser.parse(pattern.pattern, pattern.flags & ~re.DEBUG)
    samples = _SAMPLES if isinstance(pattern.pattern, str) else "".join(map(chr, range(256)))
    mode = pattern.flags & (re.ASCII | re.UNICODE) or re.ASCII  # patterns of bytes have neither
    build = _Build(tree, samples, bool(pattern.flags & re.IGNORECASE), mode)
    return build.judged(searched, whole)


class _Build:
    """An automaton of an expression."""

    def __init__(self, tree: Any, samples: str, ignore_case: bool, mode: int) -> None:
        self._tree, self._ignore_case, self._mode = tree, ignore_case, mode
        named = {chr(code) for code in _named(tree)}
        if ignore_case:
            named |= {other for each in named for other in (each.lower(), each.upper()) if len(other) == 1}
        self._all = frozenset(samples) | named
        self._words = self._category(codes.CATEGORY_WORD)
        self._automaton = _Automaton(self._all)

    def judged(self, searched: bool, whole: bool) -> str:
        made = self._automaton
        begin, final = made.state(), made.state()
        inner = begin
        if searched:
            anything = made.state()
            made.read[anything] = self._all
            made.join(begin, anything)
            made.join(anything, begin)
        made.join(self._sequence(self._tree, inner), final, behind=frozenset({_END}) if whole else None)
        return _Ambiguity(made, begin, final, whole).found()

    def _sequence(self, items: Iterable[Any], at: int) -> int:
        for name, argument in items:
            at = self._item(name, argument, at)
        return at

    def _item(self, name: Any, argument: Any, at: int) -> int:
        if name in (codes.LITERAL, codes.NOT_LITERAL, codes.IN, codes.ANY):
            return self._reading(self._set(name, argument), at)
        if name is codes.SUBPATTERN:
            return self._sequence(argument[3], at)
        if name is codes.ATOMIC_GROUP:
            return self._sequence(argument, at)
        if name is codes.BRANCH:
            end = self._automaton.state()
            for each in argument[1]:
                start = self._automaton.state()
                self._automaton.join(at, start)
                self._automaton.join(self._sequence(each, start), end)
            return end
        if name in (codes.MAX_REPEAT, codes.MIN_REPEAT, codes.POSSESSIVE_REPEAT):
            return self._repeat(*argument, at, possessive=name is codes.POSSESSIVE_REPEAT)
        if name in (codes.ASSERT, codes.ASSERT_NOT):
            return self._assertion(name, *argument, at)
        if name is codes.AT:
            return self._place(argument, at)
        raise NotImplementedError(f"{name}: not known to the analysis")

    def _reading(self, characters: Characters, at: int) -> int:
        reader = self._automaton.state()
        self._automaton.read[reader] = characters
        self._automaton.join(at, reader)
        return reader

    def _repeat(self, least: int, most: Any, body: Any, at: int, *, possessive: bool) -> int:
        made = self._automaton
        end = made.state()
        # what takes all that it can is left only before what it cannot take
        first = self._single(body) if possessive else None
        beyond = None if first is None else (self._all | {_END}) - first
        for _ in range(least):
            at = self._copy(body, at)
        if most is codes.MAXREPEAT or most > _MOST_COPIES:
            again = made.state()
            made.join(at, again)
            made.join(self._copy(body, again), again)
            made.join(again, end, behind=beyond)
            return end
        for _ in range(most - least):
            made.join(at, end, behind=beyond)
            at = self._copy(body, at)
        made.join(at, end)
        return end

    def _copy(self, body: Any, at: int) -> int:
        start = self._automaton.state()
        self._automaton.join(at, start)
        return self._sequence(body, start)

    def _assertion(self, name: Any, direction: int, body: Any, at: int) -> int:
        made, end = self._automaton, self._automaton.state()
        single = self._single(body)
        if single is None:  # the body is read, and then what follows from here
            if name is codes.ASSERT_NOT or direction > 0:
                self._sequence(body, at)
            made.join(at, end)
            return end
        allowed = single if name is codes.ASSERT else (self._all | {_END}) - single
        made.join(at, end, *((None, allowed) if direction > 0 else (allowed, None)))
        return end

    def _place(self, place: Any, at: int) -> int:
        made, end = self._automaton, self._automaton.state()
        edge = frozenset({_END})
        others = (self._all | {_END}) - self._words
        if place in (codes.AT_BEGINNING, codes.AT_BEGINNING_STRING):
            made.join(at, end, before=edge)
        elif place is codes.AT_END_STRING:
            made.join(at, end, behind=edge)
        elif place is codes.AT_END:
            made.join(at, end, behind=edge | {"\n"})
        elif place is codes.AT_BOUNDARY:
            made.join(at, end, self._words, others)
            made.join(at, end, others, self._words)
        else:
            raise NotImplementedError(f"{place}: not known to the analysis")
        return end

    def _single(self, body: Any) -> Characters | None:
        """Return the characters of which a body reads exactly one; None where it is anything else."""
        items = list(body)
        if len(items) != 1:
            return None
        name, argument = items[0]
        if name is codes.SUBPATTERN:
            return self._single(argument[3])
        if name is codes.BRANCH:
            arms = [self._single(each) for each in argument[1]]
            known = [arm for arm in arms if arm is not None]
            return frozenset[str]().union(*known) if len(known) == len(arms) else None
        if name in (codes.LITERAL, codes.NOT_LITERAL, codes.IN, codes.ANY):
            return self._set(name, argument)
        return None

    def _set(self, name: Any, argument: Any) -> Characters:
        if name is codes.ANY:
            return self._all
        if name is codes.LITERAL:
            return self._cased(frozenset({chr(argument)}))
        if name is codes.NOT_LITERAL:
            return self._all - self._cased(frozenset({chr(argument)}))
        found: set[str] = set()
        negated = argument[0][0] is codes.NEGATE
        for kind, value in argument[negated:]:
            if kind is codes.LITERAL:
                found.add(chr(value))
            elif kind is codes.RANGE:
                found |= {each for each in self._all if value[0] <= ord(each) <= value[1]}
            else:
                found |= self._category(value)
        return self._all - self._cased(frozenset(found)) if negated else self._cased(frozenset(found))

    def _cased(self, characters: Characters) -> Characters:
        if not self._ignore_case:
            return characters
        return frozenset(
            each for each in self._all if {each, each.lower(), each.upper(), each.swapcase()} & characters
        )

    def _category(self, category: Any) -> Characters:
        name = str(category).rpartition("CATEGORY_")[2]
        letter = {"DIGIT": "d", "SPACE": "s", "WORD": "w"}[name.removeprefix("NOT_")]
        known = re.compile(f"\\{letter.upper() if name.startswith('NOT_') else letter}", self._mode)
        return frozenset(each for each in self._all if known.fullmatch(each))


def _named(tree: Any) -> Iterator[int]:
    """Yield the characters that an expression names, and their neighbours."""
    for name, argument in tree:
        if name in (codes.LITERAL, codes.NOT_LITERAL):
            yield argument
        elif name is codes.RANGE:
            yield from (
                each for each in (argument[0] - 1, *argument, argument[1] + 1) if 0 <= each < 0x110000
            )
        elif name in (codes.IN, codes.ATOMIC_GROUP, codes.BRANCH):
            for each in argument[1] if name is codes.BRANCH else (argument,):
                yield from _named(each)
        elif name in (codes.ASSERT, codes.ASSERT_NOT):
            yield from _named(argument[1])
        elif isinstance(argument, tuple):  # a group or a repetition, which ends with what it is about
            yield from _named(argument[-1])


class _Ambiguity:
    """Search an automaton for a word that two loops read, the one leading to the other."""

    def __init__(self, made: _Automaton, begin: int, final: int, whole: bool) -> None:
        self._made, self._begin, self._final, self._whole = made, begin, final, whole
        self._letters = self._representatives()
        self._edges: dict[tuple[int, str], dict[str, list[tuple[int, str]]]] = {}
        self._accepting: set[tuple[int, str]] = set()
        self._predecessors: dict[tuple[int, str], set[tuple[int, str]]] = defaultdict(set)
        self._leading: dict[tuple[int, str], set[tuple[int, str]]] = {}
        self._explore()

    def found(self) -> str:
        """Return what is ambiguous; nothing where nothing is."""
        components = _components({state: self._successors(state) for state in self._edges})
        number = {state: index for index, each in enumerate(components) for state in each}
        looping = [
            state
            for state in self._edges
            if len(components[number[state]]) > 1 or state in self._successors(state)
        ]
        for state in looping:
            for letter, ends in self._edges[state].items():
                here = [end for end in ends if number[end] == number[state]]
                if len(here) > len(set(here)):
                    return f"reads {letter!r} in a loop in several ways"
        # where a loop passes what ends a match, the expression matches, and tries no more
        ends = [state for state in looping if self._whole or self._fails(components[number[state]])]
        return next(filter(None, (self._pair(q, p, number) for q in looping for p in ends if p != q)), "")

    def _fails(self, component: list[tuple[int, str]]) -> bool:
        """Return whether a loop may go round and round without passing an end of the expression."""
        rest = set(component) - self._accepting
        graph = {state: self._successors(state) & rest for state in rest}
        return any(len(each) > 1 or each[0] in graph[each[0]] for each in _components(graph))

    def _pair(self, q: tuple[int, str], p: tuple[int, str], number: dict[tuple[int, str], int]) -> str:
        start, goal = (q, q, p), (q, p, p)
        if q not in (towards := self._towards(p)):
            return ""
        seen = {start}
        stack = [start]
        while stack:
            first, second, third = stack.pop()
            for letter in self._edges[first].keys() & self._edges[second].keys() & self._edges[third].keys():
                firsts = {end for end in self._edges[first][letter] if number[end] == number[q]}
                thirds = {end for end in self._edges[third][letter] if number[end] == number[p]}
                for end in {
                    (one, two, three)
                    for one in firsts
                    for three in thirds
                    for two in self._edges[second][letter]
                    if two in towards
                }:
                    if end == goal:
                        return f"two loops read the same, such as {letter!r}"
                    if end not in seen:
                        seen.add(end)
                        stack.append(end)
        return ""

    def _towards(self, goal: tuple[int, str]) -> set[tuple[int, str]]:
        """Return the states that lead to another, and that one."""
        if goal not in self._leading:
            if not self._predecessors:
                for state in self._edges:
                    for end in self._successors(state):
                        self._predecessors[end].add(state)
            found, stack = {goal}, [goal]
            while stack:
                new = self._predecessors[stack.pop()] - found
                found |= new
                stack += new
            self._leading[goal] = found
        return self._leading[goal]

    def _successors(self, state: tuple[int, str]) -> set[tuple[int, str]]:
        return {end for ends in self._edges[state].values() for end in ends}

    def _representatives(self) -> dict[str, str]:
        """Return for each character the one that stands for all that the expression does not tell apart."""
        sets = [*self._made.read.values()]
        sets += [each for ends in self._made.silent.values() for end in ends for each in end[1:]]
        different = set(sets)
        first: dict[tuple[bool, ...], str] = {}
        return {
            each: first.setdefault(tuple(each in one for one in different), each)
            for each in sorted(self._made.alphabet)
        }

    def _explore(self) -> None:
        letters = sorted(set(self._letters.values()))
        looks_back = any(
            len(before) <= len(self._made.alphabet)
            for ends in self._made.silent.values()
            for _, before, _ in ends
        )
        stack = [(self._begin, _END)]
        while stack:
            state = stack.pop()
            if state in self._edges:
                continue
            ends: dict[str, list[tuple[int, str]]] = {}
            for reader, behind in self._readers(
                *state, frozenset(), self._made.alphabet | {_END}, looks_back
            ):
                if reader == self._final:
                    if not behind:
                        continue
                    if behind >= self._made.alphabet | {_END}:
                        self._accepting.add(state)
                    continue
                for letter in letters:
                    if letter in behind and letter in self._made.read[reader]:
                        ends.setdefault(letter, []).append((reader, letter if looks_back else _END))
            self._edges[state] = ends
            stack += [end for each in ends.values() for end in each]

    def _readers(
        self, node: int, last: str, on_path: frozenset[tuple[int, int]], behind: Characters, looks_back: bool
    ) -> Iterator[tuple[int, Characters]]:
        """Yield the states that read the next character, once for each path, with what it may be."""
        for end, before, next_ones in self._made.silent.get(node, ()):
            allowed = behind & next_ones
            if (looks_back and last not in before) or not allowed:
                continue
            if end in self._made.read or end == self._final:
                yield end, allowed
            elif (node, end) not in on_path:
                yield from self._readers(end, last, on_path | {(node, end)}, allowed, looks_back)


def _components(graph: dict[Any, set[Any]]) -> list[list[Any]]:
    """Return the strongly connected components of a graph (Tarjan, without recursion)."""
    index: dict[Any, int] = {}
    low: dict[Any, int] = {}
    open_: list[Any] = []
    waiting: set[Any] = set()
    found: list[list[Any]] = []
    for root in graph:
        if root in index:
            continue
        work = [(root, iter(graph[root]))]
        index[root] = low[root] = len(index)
        open_.append(root)
        waiting.add(root)
        while work:
            node, ends = work[-1]
            for end in ends:
                if end not in index:
                    index[end] = low[end] = len(index)
                    open_.append(end)
                    waiting.add(end)
                    work.append((end, iter(graph[end])))
                    break
                if end in waiting:
                    low[node] = min(low[node], index[end])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    component = []
                    while True:
                        component.append(open_.pop())
                        waiting.discard(component[-1])
                        if component[-1] == node:
                            break
                    found.append(component)
    return found
