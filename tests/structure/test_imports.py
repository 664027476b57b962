"""The house rules: who may import whom."""

import ast
import subprocess
import sys
from collections import defaultdict
from graphlib import TopologicalSorter
from pathlib import Path

import grimp

ROOT = Path(__file__).parents[2]


def test_the_runtime_needs_the_standard_library_and_its_bus_zenoh():
    package = ROOT / "runtime" / "mmrs_runtime"
    needed = defaultdict(set)
    for path in package.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [each.name for each in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level:
                names = [node.module]
            for top in {name.partition(".")[0] for name in names} - sys.stdlib_module_names:
                needed[top].add(path.relative_to(package).parts[0])
    assert needed == {"zenoh": {"bus"}}


def test_no_modules_import_each_other_in_a_circle_not_even_inside_functions():
    files = [ROOT / "pyproject.toml", *ROOT.glob("plugins/*/pyproject.toml"), *ROOT.glob("*/pyproject.toml")]
    packages = {each.parent.name for file in files for each in file.parent.glob("*/__init__.py")} - {"tests"}
    graph = grimp.build_graph(*sorted(packages), exclude_type_checking_imports=True, cache_dir=None)
    imported = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    assert len(imported) > 500
    TopologicalSorter(imported).prepare()


def test_imports_point_downwards():
    script = Path(sys.executable).with_name("lint-imports")
    run = subprocess.run(
        [script, "--config", ROOT / "pyproject.toml", "--no-cache"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout[-4000:] + run.stderr[-2000:]
