"""Workers that share out whole files run every test once, and report what keeps a file from being run."""

import os
import re
import subprocess
import sys
from pathlib import Path

SUPPORT = Path(__file__).parents[1] / "support"
CONFTEST = f"""
import os, sys
sys.path.insert(0, {str(SUPPORT)!r})
from whole_files import ByGroup, InWorkers

def pytest_configure(config):
    if "PYTEST_XDIST_WORKER" in os.environ:
        config.pluginmanager.register(InWorkers())

def pytest_xdist_make_scheduler(config, log):
    return ByGroup(config, log)
"""
FILES = {
    "test_cases.py": "import pytest\n@pytest.mark.parametrize('n', range(3))\ndef test_n(n): assert n != 1\n",
    "test_crash.py": "import os\ndef test_before(): pass\ndef test_crash(): os._exit(3)\n",
    "test_fixtures.py": "import pytest\n@pytest.fixture\ndef early(): assert False\n@pytest.fixture\n"
    "def late():\n yield\n assert False\ndef test_begins(early): pass\ndef test_ends(late): pass\n",
    "test_import.py": "import nothing_of_that_name\n",
    "test_skipped.py": "import pytest\npytest.skip('all of it', allow_module_level=True)\n",
    "test_unselected.py": "def test_other(): assert False\n",
    "test_after.py": "def test_one(): pass\ndef test_two(): pass\n",
}


def test_every_test_of_every_file_is_run_once(tmp_path):
    for name, text in {"conftest.py": CONFTEST, "pytest.ini": "[pytest]\n", **FILES}.items():
        (tmp_path / name).write_text(text, "utf-8")
    plugins = ["-p", "xdist.plugin", "-p", "pytest_timeout", "-p", "no:cacheprovider"]
    words = [*plugins, "-v", "-n", "2", "--dist", "loadgroup", "-k", "not other"]
    others = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    others["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *words], cwd=tmp_path, env=others, capture_output=True, text=True
    )
    ended = re.findall(r"^\[gw\d\] +\[ *\d+%\] (\w+) (\S+)", done.stdout, re.MULTILINE)
    assert sorted(ended) == [
        ("ERROR", "test_fixtures.py::test_begins"),
        ("ERROR", "test_fixtures.py::test_ends"),
        ("FAILED", "test_cases.py::test_n[1]"),
        ("FAILED", "test_crash.py::*"),
        ("PASSED", "test_after.py::test_one"),
        ("PASSED", "test_after.py::test_two"),
        ("PASSED", "test_cases.py::test_n[0]"),
        ("PASSED", "test_cases.py::test_n[2]"),
        ("PASSED", "test_crash.py::test_before"),
        ("PASSED", "test_fixtures.py::test_ends"),
    ], done.stdout
    assert "ERROR test_import.py" in done.stdout
    assert "2 failed, 6 passed, 1 skipped, 3 errors" in done.stdout
    assert done.returncode == 1
