"""Writes stubs: those of the core's own languages, and those of any metamodel for its extenders.

``python -m mmrs_core.generation.stubs.write`` rewrites those of the core after a metamodel was changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import mmrs_core.languages
from mmrs_core.errors import MmrsError
from mmrs_core.generation.stubs.names import module_name
from mmrs_core.generation.stubs.view import referred
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.registry import CORE_LANGUAGES, Registry, core_registry
from mmrs_core.languages.writing import replace_file

MARK = 'made by "mmrs metamodel stubs"'
"""What the first line of every stub says."""

_CORE = {f"urn:mmrs:{name}:1.0": f"{mmrs_core.languages.__name__}.{name}" for name in CORE_LANGUAGES}


def write_core_stubs(registry: Registry, folder: Path) -> tuple[Path, ...]:
    """Write the stubs of the core's languages into a folder and return their paths."""
    return _written([registry.package(ns_uri) for ns_uri in _CORE], _CORE, folder)


def write_stubs(registry: Registry, ns_uris: Iterable[str], folder: Path) -> tuple[Path, ...]:
    """Write the stubs of some metamodels, and of all that they refer to beyond the core's.

    Where the folder is a Python package, the stubs import each other from it; otherwise as top-level modules.

    Args:
        registry: holds them.
        ns_uris: of the metamodels.
        folder: made where it is missing; stubs in it are replaced.

    Returns:
        The files, in the order of the names given, then what these refer to.

    Raises:
        MmrsError: if a file of other origin would be replaced, or pyecoregen is not installed; nothing is
            written.
    """
    packages = _with_referred(registry, ns_uris)
    home = _dotted(folder.resolve())
    modules = dict(_CORE)
    for package in packages:
        taken = [module.rpartition(".")[2] for module in modules.values()] if not home else modules.values()
        modules[package.ns_uri] = _free(home, module_name(package), taken)
    return _written(packages, modules, folder)


def _with_referred(registry: Registry, ns_uris: Iterable[str]) -> list[Package]:
    found = dict.fromkeys(ns_uris)
    pending = list(found)
    while pending:
        for ns_uri in referred(registry.package(pending.pop(0))):
            if ns_uri not in found and ns_uri not in _CORE:
                found[ns_uri] = None
                pending.append(ns_uri)
    return [registry.package(ns_uri) for ns_uri in found]


def _free(home: str, name: str, taken: Iterable[str]) -> str:
    known = set(taken)
    while (module := f"{home}.{name}" if home else name) in known:
        name += "_"
    return module


def _dotted(folder: Path) -> str:
    """Return the dotted name of the Python package that a folder is; empty if it is none."""
    names: list[str] = []
    while any((folder / f"__init__.{ending}").exists() for ending in ("py", "pyi")):
        names.insert(0, folder.name)
        folder = folder.parent
    return ".".join(names)


def _written(packages: Iterable[Package], modules: Mapping[str, str], folder: Path) -> tuple[Path, ...]:
    texts = _texts(packages, modules, folder)
    foreign = [str(path) for path in texts if path.exists() and not _is_ours(path)]
    if foreign:
        raise MmrsError(f"{', '.join(foreign)}: not made by this command; nothing was written")
    for path, text in texts.items():
        replace_file(path, text.encode())
    return tuple(texts)


def _texts(packages: Iterable[Package], modules: Mapping[str, str], folder: Path) -> Mapping[Path, str]:
    try:
        from mmrs_core.generation.stubs.generator import stub_texts  # only extenders have what it needs
    except ModuleNotFoundError as fault:
        missing = (fault.name or "").partition(".")[0]
        if missing not in ("pyecoregen", "multigen"):
            raise
        hint = 'pip install "mmrs-core[extend]"'
        raise MmrsError(f"{missing}: not installed, but stubs are made with it; {hint}") from fault
    return stub_texts(packages, modules, folder)


def _is_ours(path: Path) -> bool:
    with path.open(encoding="utf-8", errors="replace") as file:
        return MARK in file.readline()


if __name__ == "__main__":
    write_core_stubs(core_registry(), Path(mmrs_core.languages.__file__).parent)
