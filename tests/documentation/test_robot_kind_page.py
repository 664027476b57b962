"""The kinds of robot that the pages show satisfy the kit that they are judged by."""

import os
import subprocess
import sys
from pathlib import Path
from typing import get_args

from code_blocks import blocks_of

from mmrs_core.scene import PolicyEvent

DOCS = Path(__file__).parents[2] / "docs"


def code_of(page: str) -> list[tuple[str, str]]:
    """Return the title and text of each block of Python on a page that is no dialogue."""
    blocks = blocks_of((DOCS / page).read_text(encoding="utf-8"), page)
    return [(b.title, b.text) for b in blocks if b.language == "python" and not b.text.startswith(">>>")]


def test_a_kind_made_by_the_steps_of_its_page_passes_the_test_on_it(tmp_path):
    code = code_of("how-to/robot-kind.md")
    module = "\n\n".join(text for title, text in code if not title)
    (tmp_path / "rover_kind.py").write_text(module, encoding="utf-8")
    ((name, test),) = [(title, text) for title, text in code if title]
    (tmp_path / name).write_text(test, encoding="utf-8")
    (tmp_path / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
    paths = os.pathsep.join((str(tmp_path), *filter(None, sys.path)))
    command = [sys.executable, "-m", "pytest", "-q", "-p", "same_examples", "--rootdir", tmp_path, name]
    done = subprocess.run(
        command, cwd=tmp_path, env=os.environ | {"PYTHONPATH": paths}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert " passed" in done.stdout


def test_the_kind_on_the_page_about_hooks_answers_every_fault():
    (example,) = [text for _, text in code_of("hooks.md") if "def mmrs_robot_kinds(" in text]
    namespace: dict[str, object] = {}
    exec(compile(example, "docs/hooks.md", "exec"), namespace)  # noqa: S102  the page's own code
    (kind,) = namespace["mmrs_robot_kinds"]()
    assert set(kind.policies) == set(get_args(PolicyEvent))
