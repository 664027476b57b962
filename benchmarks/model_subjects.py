"""Reads and writes one model again and again with one library, and prints what each took.

    python benchmarks/model_subjects.py ours|pyecore|lxml RUNS MODEL OUT [ECORE...]

Each run prints ``read WALL CPU`` and ``write WALL CPU``, in seconds; in the end comes ``memory BYTES``, what
the model of the first run took. With one run nothing is collected or weighed: then the process as a whole is
measured.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter, process_time

Subject = tuple[Callable[[Path], object], Callable[[object, Path], None]]


def main() -> None:
    """Run what the command line says."""
    name, runs, model, out, *ecores = sys.argv[1:]
    read, write = {"ours": ours, "pyecore": pyecore, "lxml": lxml}[name]([Path(file) for file in ecores])
    weighed = 0
    for run in range(int(runs)):
        before = resident() if run == 0 and int(runs) > 1 else 0
        found = timed("read", lambda: read(Path(model)))
        if before:
            gc.collect()
            weighed = resident() - before
        timed("write", lambda found=found: write(found, Path(out)))
        del found
        if int(runs) > 1:
            gc.collect()
    if weighed:
        print(f"memory {weighed}")


def timed(what: str, work: Callable[[], object]) -> object:
    """Do some work, print what it took, and return its result."""
    wall, cpu = perf_counter(), process_time()
    result = work()
    print(f"{what} {perf_counter() - wall:.6f} {process_time() - cpu:.6f}")
    return result


def resident() -> int:
    """Return the memory that the process occupies, in bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def ours(ecores: list[Path]) -> Subject:
    """Return how we read and write; the languages are our own."""
    from mmrs_core.languages.reading import read_model
    from mmrs_core.languages.registry import core_registry
    from mmrs_core.languages.writing import write_model

    core_registry()  # as the others have their metamodels before they read

    def read(path: Path) -> object:
        model = read_model(path, core_registry())
        assert not model.diagnostics
        return model

    return read, lambda model, out: write_model(model.roots, out, core_registry())


def pyecore(ecores: list[Path]) -> Subject:
    """Return how pyecore reads and writes, as its documentation says."""
    from pyecore.resources import URI, ResourceSet

    resources = ResourceSet()
    for file in ecores:
        package = resources.get_resource(URI(str(file))).contents[0]
        resources.metamodel_registry[package.nsURI] = package

    def write(model: object, out: Path) -> None:
        model.save(output=URI(str(out)))
        resources.remove_resource(model)

    return lambda path: resources.get_resource(URI(str(path))), write


def lxml(ecores: list[Path]) -> Subject:
    """Return how lxml reads and writes the bare XML."""
    from lxml import etree

    return lambda path: etree.parse(path), lambda tree, out: tree.write(out, encoding="UTF-8")


if __name__ == "__main__":
    main()
