"""Stub files (.pyi) that tell type checkers and editors what the classes of a language offer.

``python -m mmrs_core.languages.metamodels.stubs`` writes those of the core languages anew after a
metamodel was changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, Package
from mmrs_core.languages.registry import CORE_LANGUAGES, Registry, core_registry
from mmrs_core.languages.writing import replace_file


def stub_text(package: Package, modules: Mapping[str, str]) -> str:
    """Return the stub of the module that offers a package.

    Args:
        package: the metamodel.
        modules: the Python module of each nsURI that the metamodel refers to, its own included.
    """
    body = [text for enumeration in package.enumerations for text in _enumeration(enumeration)]
    for metaclass in package.metaclasses:
        body += _class(metaclass, package.ns_uri, modules)
    used = {ns_uri for metaclass in package.metaclasses for ns_uri in _referred(metaclass)} - {package.ns_uri}
    imports = sorted(modules[ns_uri] for ns_uri in used)
    head = [
        f'"""Made by mmrs_core.languages.metamodels.stubs from {package.ns_uri}; not to be edited."""',
        "",
        "from collections.abc import Iterable",
        "from typing import Final, Literal, TypeAlias",
        "",
        *(f"from {module.rpartition('.')[0]} import {module.rpartition('.')[2]}" for module in imports),
        "from mmrs_core.languages.element import Element",
        "",
        "NS_URI: Final[str]",
        "",
    ]
    return "\n".join([*head, *body])


def write_core_stubs(registry: Registry, folder: Path) -> list[Path]:
    """Write the stubs of the core languages into a folder and return their paths."""
    modules = {f"urn:mmrs:{name}:1.0": f"mmrs_core.languages.{name}" for name in CORE_LANGUAGES}
    paths = []
    for ns_uri, module in modules.items():
        path = folder / f"{module.rpartition('.')[2]}.pyi"
        replace_file(path, stub_text(registry.package(ns_uri), modules).encode())
        paths.append(path)
    return paths


def _referred(metaclass: Metaclass) -> Iterable[str]:
    yield from (above.ns_uri for above in metaclass.supertypes)
    for feature in metaclass.features:
        if isinstance(feature.type, (Metaclass, Enumeration)):
            yield feature.type.ns_uri


def _enumeration(enumeration: Enumeration) -> list[str]:
    names = ", ".join(f'"{name}"' for name in enumeration.names)
    return [f"{enumeration.name}: TypeAlias = Literal[{names}]", ""]


def _class(metaclass: Metaclass, home: str, modules: Mapping[str, str]) -> list[str]:
    bases = ", ".join(_name(above.ns_uri, above.name, home, modules) for above in metaclass.supertypes)
    lines = [f"class {metaclass.name}({bases or 'Element'}):", *_docstring(metaclass.documentation, "    ")]
    own = [feature for feature in metaclass.features if feature.owner is metaclass]
    for feature in own:
        lines.append(f"    {feature.attribute}: {_held(feature, home, modules)}")
        lines += _docstring(feature.documentation, "    ")
    lines.append("    def __init__(")
    lines.append("        self,")
    if metaclass.features:
        lines.append("        *,")
    for feature in metaclass.features:
        lines.append(f"        {feature.attribute}: {_given(feature, home, modules)} = ...,")
    return [*lines, "    ) -> None: ...", ""]


def _docstring(text: str, indent: str) -> list[str]:
    return [f'{indent}"""{text.strip()}"""'] if text else []


def _value(feature: Feature, home: str, modules: Mapping[str, str]) -> str:
    kind = feature.type
    if isinstance(kind, DataType):
        return kind.python.__name__
    return _name(kind.ns_uri, kind.name, home, modules)


def _held(feature: Feature, home: str, modules: Mapping[str, str]) -> str:
    value = _value(feature, home, modules)
    if feature.many:
        return f"list[{value}]"
    return value if feature.required or feature.default is not None else f"{value} | None"


def _given(feature: Feature, home: str, modules: Mapping[str, str]) -> str:
    value = _value(feature, home, modules)
    return f"Iterable[{value}] | None" if feature.many else f"{value} | None"


def _name(ns_uri: str, name: str, home: str, modules: Mapping[str, str]) -> str:
    return name if ns_uri == home else f"{modules[ns_uri].rpartition('.')[2]}.{name}"


if __name__ == "__main__":
    write_core_stubs(core_registry(), Path(__file__).parent)
