"""Names in a stub: none hides another, whatever a metamodel calls its classes and features."""

from __future__ import annotations

import builtins
import keyword
import sys
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.naming import python_name

_SOURCES = {
    "Iterable": "collections.abc",
    "Final": "typing",
    "Literal": "typing",
    "Never": "typing",
    "TypeAlias": "typing",
    "datetime": "datetime",
    "Decimal": "decimal",
    "Element": "mmrs_core.languages.element",
}
"""Where a stub imports names from; all others are built into Python."""


def module_name(package: Package) -> str:
    """Return the name of the module that describes a package; none of the standard library's."""
    return python_name(package.name, sys.stdlib_module_names)


def member_names(package: Package) -> Mapping[str, str]:
    """Return the name in Python of each class and enumeration of a package, by its name there."""
    found: dict[str, str] = {}
    for name in package.members:
        found[name] = python_name(name, {*found.values(), "NS_URI"})
    return found


@dataclass(slots=True)
class Scope:
    """The names of one stub. Every name that it hands out is remembered, and imported at its head.

    Attributes:
        own: what the module itself calls its classes and enumerations.
        hidden: names that mean something else inside some class: its features.
    """

    own: Collection[str]
    hidden: Collection[str]
    _imported: dict[tuple[str, str], str] = field(default_factory=dict)
    _aliases: dict[str, str] = field(default_factory=dict)

    def known(self, name: str) -> str:
        """Return how the stub calls a name of Python or of this package, such as ``Iterable``."""
        if name in _SOURCES:
            return self.imported(_SOURCES[name], name)
        if name not in self.own and name not in self.hidden:
            assert hasattr(builtins, name)  # there is no other source
            return name
        return f"{self.imported('', 'builtins')}.{name}"

    def imported(self, module: str, name: str) -> str:
        """Return how the stub calls a name of a module; with an empty module, a module itself."""
        if (module, name) not in self._imported:
            self._imported[module, name] = self._free(name)
        return self._imported[module, name]

    def member(self, name: str) -> str:
        """Return how annotations call one of the module's own classes."""
        if name not in self.hidden:
            return name
        if name not in self._aliases:
            self._aliases[name] = self._free(name)
        return self._aliases[name]

    def import_lines(self) -> Iterable[str]:
        """Yield the statements that import all names handed out: Python's own first, each part sorted."""
        by_module: dict[str, list[str]] = {}
        for (module, name), called in self._imported.items():
            words = name if called == name else f"{name} as {called}"
            by_module.setdefault(module, []).append(words)
        lines = [f"import {words}" for words in sorted(by_module.pop("", ()))]
        for module in sorted(by_module):
            lines.append(f"from {module} import {', '.join(sorted(by_module[module]))}")
        standard = [line for line in lines if line.split()[1].split(".")[0] in sys.stdlib_module_names]
        others = [line for line in lines if line not in standard]
        yield from (*standard, "", *others) if standard and others else lines

    def aliases(self) -> Mapping[str, str]:
        """Return the second names of classes that a feature hides, by their first."""
        return self._aliases

    def _free(self, name: str) -> str:
        taken = {*self.own, *self.hidden, *self._imported.values(), *self._aliases.values()}
        while name in taken or keyword.iskeyword(name):
            name = f"_{name}"
        return name
