"""The names of the parts of a new plug-in, all derived from its own name."""

from __future__ import annotations

import re
import sys
from collections.abc import Collection
from dataclasses import dataclass

from mmrs_core.languages.codes import CODES
from mmrs_core.languages.naming import python_name
from mmrs_core.languages.registry import CORE_LANGUAGES

LONGEST = 30
RESERVED = frozenset((*CORE_LANGUAGES, "core", "mmrs", "ecore", "xmi", "xml", "xmlns", "xsi"))
"""Names of the core, and names with a meaning in files."""

_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")


@dataclass(frozen=True, slots=True)
class PluginNames:
    """The names of a plug-in.

    Attributes:
        name: of the entry point, kebab-case.
        distribution: as pip installs it.
        package: as Python imports it.
        language: name of its metamodel, and the prefix in files.
        ns_uri: of its metamodel.
        stub: the module with the type stubs of its metamodel.
        task: the metaclass of its task.
        robot: the metaclass of its robot type.
        rule: name of the task's rule.
        code: of its first constraint.
        words: the name in words.
        icon: of its map symbols.
    """

    name: str
    distribution: str
    package: str
    language: str
    ns_uri: str
    stub: str
    task: str
    robot: str
    rule: str
    code: str
    words: str
    icon: str

    @property
    def title(self) -> str:
        """Return the name in words, as it begins a sentence."""
        return self.words[0].upper() + self.words[1:]


def plugin_names(name: str, taken: Collection[str] = (), codes: Collection[str] = ()) -> PluginNames:
    """Return the names of a plug-in.

    Args:
        name: in lower-case ASCII letters, digits and hyphens.
        taken: names of installed plug-ins, metamodels and rules.
        codes: of installed constraints.

    Raises:
        ValueError: if the name is malformed, too long, has fewer than two letters, or is taken.

    >>> names = plugin_names("roof-wash")
    >>> names.distribution, names.package, names.task, names.code
    ('mmrs-roof-wash', 'mmrs_roof_wash', 'RoofWashTask', 'ROO001')
    """
    _refuse(name, taken)
    language = name.replace("-", "_")
    parts = name.split("-")
    pascal = "".join(part[0].upper() + part[1:] for part in parts)
    return PluginNames(
        name=name,
        distribution=f"mmrs-{name}",
        package=f"mmrs_{language}",
        language=language,
        ns_uri=f"urn:mmrs:{name}:1.0",
        stub=python_name(language, sys.stdlib_module_names),
        task=f"{pascal}Task",
        robot=f"{pascal}Robot",
        rule=language,
        code=f"{_code(name, codes)}001",
        words=" ".join(parts),
        icon=name[0].upper(),
    )


def _refuse(name: str, taken: Collection[str]) -> None:
    if not _NAME.fullmatch(name):
        hint = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-0123456789")[:LONGEST].strip("-")
        example = hint if _NAME.fullmatch(hint) else "roof-wash"
        raise ValueError(
            f"{name!r}: expected a name in lower-case letters, digits and hyphens, such as {example!r}"
        )
    if len(name) > LONGEST:
        raise ValueError(f"{name!r}: has {len(name)} characters, at most {LONGEST} are allowed")
    if name in RESERVED:
        raise ValueError(f"{name!r}: is reserved for the core")
    if name in taken or name.replace("-", "_") in taken:
        raise ValueError(f"{name!r}: a plug-in, metamodel or rule of that name is installed")
    if len(_letters(name)) < 2:
        raise ValueError(f"{name!r}: needs at least two letters, which begin the codes of its constraints")


def _letters(name: str) -> str:
    return re.sub(r"[^A-Z]", "", name.upper())


def _code(name: str, codes: Collection[str]) -> str:
    """Return the prefix of constraint codes: three letters, or more where others use these."""
    letters = _letters(name)
    used = {code[:-3] for code in (*codes, *CODES)}
    candidates = [letters[:count] for count in range(3, len(letters) + 1)] or [letters]
    candidates += [letters + "X" * count for count in range(1, len(used) + 2)]
    return next(each for each in candidates if each not in used)
